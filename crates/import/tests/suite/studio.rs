//! The camera of a scene that comes without one.

use alhazen_import::{import, refit_camera};
use assets::MemoryAssets;
use description::{CameraKind, SceneDesc, ShapeKind};
use math::DVec3;

/// The corners of a box of these sides around a place, and the faces between them.
fn cuboid([x, y, z]: [f64; 3], [a, b, c]: [f64; 3]) -> String {
    let corner = |i: u32| {
        let side = |bit: u32, at: f64, half: f64| if i >> bit & 1 == 0 { at - half } else { at + half };
        format!("v {} {} {}\n", side(0, a, x / 2.0), side(1, b, y / 2.0), side(2, c, z / 2.0))
    };
    let corners: String = (0..8).map(corner).collect();
    corners + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

fn sphere() -> String {
    let mut text = String::new();
    for i in 0..=24 {
        let (sin, cos) = (f64::from(i) * std::f64::consts::PI / 24.0).sin_cos();
        for j in 0..48 {
            let (y, x) = (f64::from(j) * std::f64::consts::TAU / 48.0).sin_cos();
            text += &format!("v {} {cos} {}\n", sin * x, sin * y);
        }
    }
    for (i, j) in (0..24).flat_map(|i| (0..48).map(move |j| (i, j))) {
        let (next, at) = ((j + 1) % 48, |i: u32, j: u32| 1 + 48 * i + j);
        text += &format!("f {} {} {} {}\n", at(i, j), at(i + 1, j), at(i + 1, next), at(i, next));
    }
    text
}

/// The bounds of all vertices in the frame, of which each side goes from −1 to 1.
fn projected(desc: &SceneDesc) -> [[f64; 2]; 2] {
    let CameraKind::Perspective { fov, .. } = desc.camera.kind else { panic!("no perspective") };
    let [width, height] = desc.film.resolution.map(f64::from);
    let unit = (f64::from(fov) / 2.0).to_radians().tan() / width.min(height);
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for (_, shape) in desc.shapes.iter() {
        let positions = match &shape.kind {
            ShapeKind::PlyMesh { triangles, .. } | ShapeKind::Triangles(triangles) => &triangles.positions,
            _ => continue,
        };
        for position in positions.iter() {
            let world = shape.world_from_object.start.transform_point3(position.as_dvec3());
            let seen = desc.camera.camera_from_world.start.transform_point3(world);
            assert!(seen.z > 0.0, "{seen} is behind the camera");
            let place = [seen.x / (seen.z * unit * width), seen.y / (seen.z * unit * height)];
            for ([low, high], place) in bounds.iter_mut().zip(place) {
                (*low, *high) = (low.min(place), high.max(place));
            }
        }
    }
    bounds
}

/// Checks that surfaces fill 80 % of a frame in one direction, no more in the other, and are in
/// its middle.
fn fills(desc: &SceneDesc, what: &str) {
    let [x, y] = projected(desc);
    let most = [x, y].as_flattened().iter().fold(0.0_f64, |most, side| most.max(side.abs()));
    assert!((most - 0.8).abs() < 1e-4, "{what}: {x:?} {y:?}");
    for [low, high] in [x, y] {
        assert!((low + high).abs() < 5e-3, "{what}: {x:?} {y:?}");
    }
}

#[test]
fn objects_of_all_shapes_fill_the_frame_whatever_its_aspect_ratio() {
    let shapes = [
        ("a cube", cuboid([1.0; 3], [0.0; 3])),
        ("a tower", cuboid([0.1, 5.0, 0.1], [7.0, 2.5, -3.0])),
        ("a beam", cuboid([9.0, 0.2, 0.2], [0.0, 0.1, 0.0])),
        ("a rod towards the viewer", cuboid([0.1, 0.1, 8.0], [0.0; 3])),
        ("a plate that lies", cuboid([4.0, 0.01, 3.0], [0.0; 3])),
        ("a plate that stands", cuboid([4.0, 3.0, 0.0], [0.0; 3])),
        ("a sphere", sphere()),
        ("something far away", cuboid([1e-3; 3], [100.0, 50.0, 0.0])),
        ("something large", cuboid([1e6, 2e6, 1e6], [0.0; 3])),
    ];
    for (what, obj) in shapes {
        let imported = import("a.obj", &MemoryAssets::default().with("a.obj", obj));
        assert!(imported.diagnostics.is_empty(), "{:#?}", imported.diagnostics);
        let mut desc = imported.desc;
        fills(&desc, what);
        for resolution in [[480, 480], [1600, 400], [300, 900], [640, 480]] {
            let before = std::mem::replace(&mut desc.film.resolution, resolution);
            refit_camera(&mut desc, before);
            let [x, y] = projected(&desc);
            let most = [x, y].as_flattened().iter().fold(0.0_f64, |most, side| most.max(side.abs()));
            assert!((most - 0.8).abs() < 1e-4, "{what} in {resolution:?}: {x:?} {y:?}");
        }
    }
}

#[test]
fn a_field_of_view_of_the_caller_stays() {
    let assets = MemoryAssets::default().with("a.obj", cuboid([1.0; 3], [0.0; 3]));
    let mut desc = import("a.obj", &assets).desc;
    let CameraKind::Perspective { fov, .. } = &mut desc.camera.kind else { panic!("no perspective") };
    *fov = 20.0;
    let before = std::mem::replace(&mut desc.film.resolution, [100, 1000]);
    refit_camera(&mut desc, before);
    let CameraKind::Perspective { fov, .. } = desc.camera.kind else { panic!("no perspective") };
    assert_eq!(fov, 20.0);
}

#[test]
fn the_front_is_towards_the_viewer_and_seen_from_a_little_above() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let stl =
        "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid";
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let assets = MemoryAssets::default().with("a.ply", ply).with("a.stl", stl).with("a.obj", obj);
    for file in ["a.ply", "a.stl", "a.obj"] {
        let desc = import(file, &assets).desc;
        fills(&desc, file);
        let world_from_camera = desc.camera.camera_from_world.start.inverse();
        let back = -world_from_camera.transform_vector3(DVec3::Z);
        let (front, up) = (DVec3::Z, DVec3::Y);
        assert!(back.dot(front) > 0.85, "{file}: {back}");
        assert!((0.1..0.4).contains(&back.dot(up)), "{file}: {back}");
        // The triangle of each file stands upright, its outside in front.
        let (_, shape) = desc.shapes.iter().next().unwrap();
        let ShapeKind::PlyMesh { triangles, .. } = &shape.kind else { panic!("{:?}", shape.kind) };
        let place =
            |i: usize| shape.world_from_object.start.transform_point3(triangles.positions[i].as_dvec3());
        let normal = (place(1) - place(0)).cross(place(2) - place(0));
        assert!((normal - front).length() < 1e-9 && (place(2) - up).length() < 1e-9, "{file}: {normal}");
    }
}
