//! What kernels do not draw.

use alhazen_gpu::Algorithm;
use description::{BdptDesc, IntegratorDesc, MltDesc, MltTechnique, PathDesc, ReflectionsDesc, WhittedDesc};
use spectrum::RgbColorSpace;

use crate::pictures::Case;

/// Algorithms without kernels, and settings that kernels do not have.
#[test]
fn what_algorithms_have_no_kernel_for_is_refused() {
    let new = |desc: IntegratorDesc| Algorithm::new(&desc, RgbColorSpace::srgb(), 1).map(|_| ());
    let bdpt = |desc: BdptDesc| new(IntegratorDesc::Bdpt(desc));
    assert_eq!(bdpt(BdptDesc { max_depth: 16, ..Default::default() }), Ok(()));
    let refused = bdpt(BdptDesc { max_depth: 17, ..Default::default() });
    assert_eq!(refused, Err("integrator `bdpt` with a `maxdepth` above 16".into()));
    let refused = bdpt(BdptDesc { visualize_weights: true, ..Default::default() });
    assert_eq!(refused, Err("pictures of the strategies of integrator `bdpt`".into()));
    let hybrid = WhittedDesc { reflections: ReflectionsDesc::Hybrid, ..Default::default() };
    let refused = new(IntegratorDesc::Whitted(hybrid));
    assert_eq!(refused, Err("integrator `whitted` with reflections that are not traced".into()));
    assert_eq!(new(IntegratorDesc::Vcm(Default::default())), Err("integrator `vcm`".into()));
    let mlt = |desc: MltDesc| new(IntegratorDesc::Mlt(desc));
    assert_eq!(mlt(MltDesc { max_depth: 16, ..Default::default() }), Ok(()));
    let refused = mlt(MltDesc { max_depth: 17, ..Default::default() });
    assert_eq!(refused, Err("integrator `mlt` with a `maxdepth` above 16".into()));
    let refused = mlt(MltDesc { technique: MltTechnique::Path, ..Default::default() });
    assert_eq!(refused, Err("integrator `mlt` by any technique but `bdpt`".into()));
}

/// What kernels do not draw is named, and found in the text.
#[test]
fn what_kernels_do_not_draw_is_refused_with_its_place() {
    let begin = "Camera \"perspective\"\nFilm \"rgb\"\nWorldBegin\n";
    let cases = [
        ("Shape \"cone\"", "shape `cone`", "Shape \"cone\""),
        (
            "Scale 1 2 3\nShape \"curve\" \"point3 P\" [ 0 0 0 0 1 0 0 1 1 1 1 1 ]",
            "curves whose widths are stretched",
            "Shape \"curve\"",
        ),
    ];
    for (rest, what, place) in cases {
        let text = format!("{begin}{rest}\n");
        let case = Case::of_text(&text);
        let refusals = case.flatten(&Algorithm::Path(PathDesc::default())).err().unwrap_or_default();
        let refusal = refusals.iter().find(|refusal| refusal.what == what);
        let refusal = refusal.unwrap_or_else(|| panic!("{what}: {refusals:?}"));
        let at = refusal.span.start as usize;
        assert!(text[at..].starts_with(place), "{what}: {}", &text[at..]);
    }
}

/// Worlds that kernels have no room for: too many instances within instances, too deep a tree, and
/// instances without bounds.
#[test]
fn worlds_without_room_are_refused_with_their_place() {
    let object = |name: &str, rest: &str| format!("ObjectBegin \"{name}\"\n{rest}\nObjectEnd\n");
    let row = |name: &str, count| format!("ObjectInstance \"{name}\"\n").repeat(count);
    let begin = "Camera \"perspective\"\nFilm \"rgb\"\nWorldBegin\n";
    let nested = object("ball", "Shape \"sphere\"") + &object("row", &row("ball", 1024)) + &row("row", 1025);
    let open = object("floor", "Shape \"plane\"") + &row("floor", 1);
    // Each sphere is as far away as all before it together are large.
    let sphere = |i: i32| {
        let size = 1.3f64.powi(i);
        format!(
            "AttributeBegin\nTranslate {} 0 0\nShape \"sphere\" \"float radius\" {size}\nAttributeEnd\n",
            10.0 * size
        )
    };
    let deep: String = (0..400).map(|i| sphere(i - 150)).collect();
    let cases = [
        (nested, "as many instances within instances", Some("ObjectInstance")),
        (open, "instances of infinite planes", Some("Shape \"plane\"")),
        (deep, "as many primitives", None),
    ];
    for (rest, what, place) in cases {
        let text = begin.to_owned() + &rest;
        let refusals = Case::of_text(&text).flatten(&Algorithm::RayCasting).err().unwrap_or_default();
        let [refusal] = &refusals[..] else { panic!("{what}: {refusals:?}") };
        assert_eq!(refusal.what, what);
        let at = refusal.span.start as usize;
        assert!(place.is_none_or(|place| text[at..].starts_with(place)), "{what}: {}", &text[at..]);
    }
}
