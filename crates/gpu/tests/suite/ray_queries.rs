//! Pictures by the ray queries of a GPU's hardware, where it has any.

use alhazen_gpu::Algorithm;
use description::{PathDesc, Schedule};

use crate::motion::TURNING;
use crate::pictures::{Case, DRAWN};
use crate::texts::{HAIR, HOLES, LAMPS, MEDLEY};

/// What is wrong with the picture by ray queries, if anything, beside the CPU's.
fn compare(name: &str, case: &Case, algorithm: &Algorithm, schedule: Schedule) -> Option<String> {
    let flat = case.flattened(algorithm, true);
    assert!(flat.as_ref().is_ok_and(|flat| flat.parts().ray_queries), "{name}");
    let renderer = case.rendering(&flat, algorithm, schedule)?;
    case.differs(name, algorithm, &case.drawn(&renderer))
}

#[test]
fn ray_queries_have_the_picture_of_the_cpu() {
    let compare = |name: &&str| {
        let case = Case::named(name);
        compare(name, &case, &Algorithm::Path(case.path()), Schedule::Megakernel)
    };
    let wrong: Vec<String> = DRAWN.iter().filter_map(compare).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Shapes of all kinds, holes, curves, and lights with surfaces in instances.
#[test]
fn ray_queries_meet_what_is_not_a_triangle() {
    let path = |max_depth| Algorithm::Path(PathDesc { max_depth, ..PathDesc::default() });
    let texts = [("medley", MEDLEY, 4), ("holes", HOLES, 3), ("lamps", LAMPS, 3), ("hair", HAIR, 2)];
    for (name, text, max_depth) in texts {
        let wrong = compare(name, &Case::of_text(text), &path(max_depth), Schedule::Megakernel);
        assert_eq!(wrong, None);
    }
}

#[test]
fn ray_queries_of_a_wavefront_have_the_picture_of_the_cpu() {
    let case = Case::named("cornell-box");
    assert_eq!(compare("wavefront", &case, &Algorithm::Path(case.path()), Schedule::Wavefront), None);
}

#[test]
fn ray_queries_do_not_trace_what_moves() {
    let case = Case::of_text(TURNING);
    let flat = case.flattened(&Algorithm::RayCasting, true);
    assert!(flat.is_ok_and(|flat| !flat.parts().ray_queries && flat.parts().motion));
}
