//! Meshes, rays and hits against recorded numbers, so that measurements stay comparable.

use alhazen_bench::building;
use alhazen_bench::embree::Embree;
use alhazen_bench::mesh::BenchMesh;
use alhazen_bench::rays::{Answer, ray_sets};
use alhazen_bench::table::{Table, ratios};
use alhazen_bench::timing::in_turn;
use alhazen_bench::tracing::{closest, trace};
use geometry::BuildQuality;
use math::{DVec3, Vec3};
use std::cell::RefCell;

fn mesh(name: &str) -> BenchMesh {
    BenchMesh::named(name).expect("a mesh")
}

fn near(a: Vec3, b: [f32; 3]) -> bool {
    a.distance(Vec3::from(b)) < 2e-6
}

#[test]
fn meshes_are_those_of_their_formulas() {
    let blob_sum = DVec3::new(-2637.270926, 322.586482, -166.627850);
    let room_sum = DVec3::new(-1414.148392, 688.680637, 1990.001085);
    for (name, vertices, triangles, vertex, sum, weighted) in [
        ("blob", 523_266, 1_046_528, [0.073_509_08, 0.976_685_2, 0.026_301_97], blob_sum, 1_643_903_969_280),
        ("room", 514_520, 1_028_172, [0.930_515_9, -0.771_768_3, -0.806_054], room_sum, 1_587_118_095_654),
    ] {
        let mesh = mesh(name);
        assert_eq!((mesh.positions.len(), mesh.indices.len()), (vertices, triangles));
        assert!(near(mesh.positions[12_345], vertex), "{}", mesh.positions[12_345]);
        let all: DVec3 = mesh.positions.iter().map(|p| p.as_dvec3()).sum();
        assert!((all - sum).length() < 1e-2, "{all}");
        let indices: u64 = mesh.indices.iter().map(|i| i[0] as u64 + 2 * i[1] as u64 + 3 * i[2] as u64).sum();
        assert_eq!(indices, weighted);
    }
}

/// Embree's results for rays from its own hits, whose origins differ from ours in their last bits.
#[test]
fn hits_are_those_of_embree() {
    let mesh = mesh("blob");
    let world = building::world(mesh.triangles().expect("a mesh"), BuildQuality::Balanced);
    let sets = ray_sets(&mesh, 1024, |ray| closest(&world, ray).map(|hit| (hit.t, hit.primitive as usize)));
    let answers = [0, 1, 2, 3, 4].map(|i| trace(&world, &sets[i]));
    let close = |a: f64, b: f64, tolerance: f64| assert!((a / b - 1.0).abs() < tolerance, "{a}, {b}");
    assert!(near(sets[0].rays[5000].ray.d, [-0.144_722_2, 0.081_522_7, -0.986_108_3]));
    close(answers[0].hits as f64, 633_389.0, 1e-5);
    close(answers[0].sum_t, 1_430_103.4, 1e-4);
    let bounce = Vec3::new(-0.312_869, 0.221_974, 0.923_494);
    assert!(sets[1].rays[5000].ray.d.distance(bounce) < 1e-4);
    assert_eq!(sets[1].rays.len() as u64, answers[0].hits);
    close(answers[1].hits as f64, 48_003.0, 1e-3);
    close(answers[1].sum_t, 4178.8, 1e-2);
    assert!(answers[2].agrees(&answers[1]) && sets[2].rays[..9] != sets[1].rays[..9], "in another order");
    close(answers[3].hits as f64, 441_170.0, 1e-4);
    assert_eq!(answers[4].hits, answers[1].hits, "the same rays");
}

#[test]
fn the_room_is_seen_from_its_corner() {
    let [primary, diffuse, ..] = ray_sets(&mesh("room"), 1024, |_| None);
    assert!(near(primary.rays[5000].ray.o, [0.97, 0.93, 0.99]));
    assert!(near(primary.rays[5000].ray.d, [-0.286_432_2, 0.009_153_2, -0.958_056_8]));
    assert!(diffuse.rays.is_empty());
}

#[test]
fn results_agree_up_to_rounding() {
    let answer = Answer { hits: 100_000, sum_t: 5e5 };
    assert!(answer.agrees(&Answer { hits: 100_001, sum_t: 5e5 + 3.0 }));
    assert!(!answer.agrees(&Answer { hits: 100_020, ..answer }));
    assert!(!answer.agrees(&Answer { sum_t: 5.1e5, ..answer }));
    assert!(!answer.agrees(&Answer { sum_t: f64::NAN, ..answer }));
    assert!(Answer::default().agrees(&Answer::default()));
}

#[test]
fn candidates_are_measured_in_alternation() {
    let calls = RefCell::new(String::new());
    let ways = ["a", "b"].map(|way| {
        let calls = &calls;
        move || calls.borrow_mut().push_str(way)
    });
    let measured = in_turn(&ways, 3);
    assert!(measured.len() == 2 && measured.iter().all(|(seconds, ())| *seconds >= 0.0));
    assert_eq!(calls.borrow().as_str(), "ababab");
}

#[test]
fn tables_are_markdown() {
    let mut table = Table::new(["speed", "a", "b"]);
    table.row("ratio", ratios(&[1.0, 3.0], &[2.0, 2.0]));
    assert_eq!(table.to_string(), "| speed | a | b |\n| --- | --- | --- |\n| ratio | 0.50 | 1.50 |\n");
}

#[test]
fn a_missing_library_is_an_error() {
    assert!(Embree::load("no such library".as_ref()).is_err());
}
