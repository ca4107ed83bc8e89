//! Properties of a solution: form factors, conservation of energy, and continuity of the picture.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::collections::HashMap;
use std::sync::Arc;

use description::{
    AreaLightDesc, FormFactorsDesc, InfiniteRadiance, LightKind, LightSamplerDesc, MaterialKind, MeshDesc,
    PatchMeshDesc, RadiosityDesc, SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc,
};
use geometry::RayStats;
use math::{Point3, Vec2};
use sampling::Rng;
use scene::{Scene, View};

use super::bands::Bands;
use super::element::Patch;
use super::form_factor::Emitter;
use super::hemicube::Hemicube;
use super::mesh::Corner;
use super::ply;
use super::shooting::Solution;
use super::show::Interpolation;
use crate::Control;

/// The faces of a box with its normals inwards, as patches, of these reflectances.
fn room(size: Point3, reflectances: [f32; 6]) -> SceneDesc {
    let mut desc = SceneDesc::default();
    let corner = |i: usize| Point3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * size;
    let faces = [[0, 1, 2, 3], [4, 6, 5, 7], [0, 4, 1, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 5, 3, 7]];
    for (face, reflectance) in faces.into_iter().zip(reflectances) {
        let material = desc.materials.push(MaterialKind::Diffuse { reflectance: reflectance.into() }.into());
        let patch = PatchMeshDesc {
            positions: face.map(corner).into(),
            indices: Arc::new([[0, 1, 2, 3]]),
            ..PatchMeshDesc::default()
        };
        desc.shapes.push(ShapeDesc { material: Some(material), ..ShapeKind::Patches(patch).into() });
    }
    desc
}

/// A lamp that looks down and a ball below it.
fn furnished(mut desc: SceneDesc) -> Scene {
    let light = AreaLightDesc::new(SpectrumDesc::Constant(1.0));
    let area_light = Some(desc.area_lights.push(light));
    let lamp = MeshDesc {
        indices: Arc::new([[0, 2, 1], [0, 3, 2]]),
        positions: [[0.3, 0.3], [0.7, 0.3], [0.7, 0.6], [0.3, 0.6]]
            .map(|[x, y]| Point3::new(x, y, 0.95))
            .into(),
        ..MeshDesc::default()
    };
    desc.shapes.push(ShapeDesc { area_light, ..ShapeKind::Triangles(lamp).into() });
    let ball = ShapeKind::Sphere { radius: 0.2, z_min: -0.2, z_max: 0.2, phi_max: 360.0 };
    let world_from_object = description::TransformDesc::translation(0.6, 0.5, 0.3);
    desc.shapes.push(ShapeDesc { world_from_object, ..ball.into() });
    compile(&desc)
}

fn compile(desc: &SceneDesc) -> Scene {
    scene::compile(desc.clone()).unwrap().scene
}

fn view() -> View {
    View::compile(&SceneDesc::default(), math::DMat4::IDENTITY).unwrap().view
}

fn settings(patch_size: f32) -> RadiosityDesc {
    RadiosityDesc { patch_size: Some(patch_size), ..RadiosityDesc::default() }
}

fn unsolved(scene: &Scene, settings: &RadiosityDesc) -> Solution {
    Solution::new(scene, &view(), settings, &Control::default()).unwrap()
}

fn solved(scene: &Scene, settings: &RadiosityDesc) -> Solution {
    let mut solution = unsolved(scene, settings);
    solution.shoot(scene, &view(), settings.tolerance, &Control::default()).unwrap();
    solution
}

fn interpolation(scene: &Scene, solution: &Solution) -> Interpolation {
    let lights = scene.light_sampler(LightSamplerDesc::Bvh, &Control::default().cancel).unwrap();
    Interpolation::new(scene, solution, &lights, 0)
}

/// F_ie for all elements e and one patch.
fn column(scene: &Scene, solution: &Solution, patch: &Patch) -> Vec<f32> {
    let (emitter, mut stats) = (Emitter::new(scene, &solution.cut.mesh, patch, 0), RayStats::default());
    let elements = solution.cut.elements.iter();
    elements.map(|element| emitter.irradiate(scene, element, 0.0, &mut stats).sides(element)[0]).collect()
}

#[test]
fn the_rows_of_a_closed_room_sum_to_one() {
    let scene = compile(&room(Point3::new(1.0, 1.5, 0.8), [0.5; 6]));
    let settings = settings(0.2);
    let solution = unsolved(&scene, &settings);
    let mut rows = vec![0.0; solution.cut.elements.len()];
    for patch in &solution.cut.patches {
        let column = column(&scene, &solution, patch);
        rows.iter_mut().zip(column).for_each(|(row, factor)| *row += factor);
    }
    assert!(rows.len() > 100);
    for row in rows {
        assert!((row - 1.0).abs() < 1e-3, "{row}");
    }
}

#[test]
fn hemicube_form_factors_agree_within_the_resolution() {
    let scene = compile(&room(Point3::new(1.0, 1.5, 0.8), [0.5; 6]));
    let solution = unsolved(&scene, &settings(0.4));
    let ids: Vec<u32> = (0..solution.cut.elements.len() as u32).collect();
    let patch = &solution.cut.patches[7];
    let exact = column(&scene, &solution, patch);
    for resolution in [32, 256] {
        let mut stats = RayStats::default();
        let cube = Hemicube::new(resolution, 0);
        let seen =
            cube.cast(&scene, &solution.cut.mesh, patch.cell, 0, &Control::default(), &mut stats).unwrap();
        let received = seen.received(&solution.cut, patch.area, &ids);
        let mut sum = 0.0;
        for ((received, element), exact) in received.iter().zip(&solution.cut.elements).zip(&exact) {
            let found = received.sides(element)[0];
            sum += found * element.area / patch.area;
            // The error is about that of the pixels at the elements' edges; near elements see more
            // than the patch's centre.
            let pixels = exact * element.area / patch.area * (resolution * resolution) as f32;
            let far = (element.points[0].p.p - solution.cut.elements[7].points[0].p.p).length() > 0.9;
            let bound = (1.5 / pixels.sqrt() + 0.03) * exact;
            assert!(
                !far || *exact == 0.0 || (found - exact).abs() < bound,
                "{resolution}: {found}, not {exact}"
            );
        }
        assert!((sum - 1.0).abs() < 2e-3, "{resolution}: {sum}");
    }
}

/// The initial power is unshot, or was absorbed.
#[test]
fn energy_is_conserved_while_shooting() {
    let reflectances = [0.7, 0.4, 0.6, 0.3, 0.5, 0.8];
    let scene = furnished(room(Point3::new(1.0, 1.0, 1.0), reflectances));
    for form_factors in [FormFactorsDesc::Analytic, FormFactorsDesc::Hemicube] {
        let settings = RadiosityDesc {
            max_depth: 12,
            form_factors,
            hemicube_resolution: 64,
            subdivision: 1,
            ..settings(0.5)
        };
        let mut solution = unsolved(&scene, &settings);
        let power = |solution: &Solution| {
            let unshot =
                solution.cut.patches.iter().flat_map(|patch| &patch.unshot).map(|sides| sides[0] + sides[1]);
            f64::from(unshot.sum::<Bands>().mean())
        };
        let all = power(&solution);
        assert!(all > 0.0);
        for share in [0.8, 0.3, 0.1, 0.01] {
            solution.shoot(&scene, &view(), share, &Control::default()).unwrap();
            let absorbed = solution.cut.elements.iter().map(|element| {
                let [outer, inner] = element.irradiance();
                let kept = element.albedo.reflectance * -1.0 + Bands::splat(1.0);
                f64::from(((outer + inner) * kept).mean() * element.area)
            });
            let left = (absorbed.sum::<f64>() + power(&solution)) / all;
            assert!((left - 1.0).abs() < 0.01, "{form_factors:?}, {share}: {left}");
        }
    }
}

#[test]
fn irradiance_in_a_furnace_is_uniform() {
    let mut desc = room(Point3::new(1.0, 1.0, 1.0), [0.5; 6]);
    let light = desc.area_lights.push(AreaLightDesc::new(SpectrumDesc::Constant(1.0)));
    let kinds: Vec<_> = desc.shapes.iter().map(|(_, shape)| shape.value.clone()).collect();
    desc.shapes = Default::default();
    for kind in kinds {
        desc.shapes.push(ShapeDesc { area_light: Some(light), ..kind });
    }
    let scene = compile(&desc);
    let settings = RadiosityDesc { max_depth: 20, tolerance: 1e-4, subdivision: 0, ..settings(0.25) };
    let solution = solved(&scene, &settings);
    let emitted = solution.cut.patches[0].emitted[0].mean();
    for element in &solution.cut.elements {
        // E = L_e / (1 − ρ), less the unshot light.
        let found = element.irradiance()[0].mean() / emitted;
        assert!((found - 2.0).abs() < 2e-3, "{found}");
        assert!(element.irradiance()[1].is_black(), "no light on the outer side");
    }
}

#[test]
fn the_sky_is_an_emitter() {
    let mut desc = SceneDesc::default();
    let radiance = InfiniteRadiance::Constant(SpectrumDesc::Constant(1.0));
    desc.lights.push(LightKind::Infinite { radiance, illuminance: None, portal: None }.into());
    let ball = ShapeKind::Sphere { radius: 1.0, z_min: -1.0, z_max: 1.0, phi_max: 360.0 };
    desc.shapes.push(ball.into());
    let scene = compile(&desc);
    let solution = solved(&scene, &RadiosityDesc { subdivision: 0, ..settings(0.2) });
    let sky = solution.wavelengths.sample(|lambda| {
        scene.light(scene::light::LightId(0)).le(&math::Ray::new(Point3::ZERO, Point3::Z, 0.0), lambda)
    });
    let area: f32 = solution.cut.elements.iter().map(|element| element.area).sum();
    let mean: f32 = solution.cut.elements.iter().map(|e| e.irradiance()[0].mean() * e.area / area).sum();
    let expected = sky.mean() * std::f32::consts::PI;
    assert!((mean / expected - 1.0).abs() < 3e-3, "{mean}, not {expected}");
    assert!((area / (4.0 * std::f32::consts::PI) - 1.0).abs() < 3e-3, "{area}");
}

/// At common corners and T-vertices of elements, their irradiances agree.
#[test]
fn interpolation_is_continuous() {
    let scene = furnished(room(Point3::new(1.0, 1.0, 1.0), [0.7, 0.4, 0.6, 0.3, 0.5, 0.8]));
    let settings = RadiosityDesc { tolerance: 0.02, ..settings(0.5) };
    let solution = solved(&scene, &settings);
    let interpolation = interpolation(&scene, &solution);
    let mut sides: HashMap<[u32; 2], Vec<Vec<f32>>> = HashMap::new();
    let mut anchored = 0;
    for (id, element) in (0..).zip(&solution.cut.elements) {
        let leaf = solution.cut.mesh.cell(element.cell);
        let outline = interpolation.outline(id);
        anchored += outline.len() - leaf.corners().len();
        for (i, a) in outline.iter().enumerate() {
            let b = outline[(i + 1) % outline.len()];
            let [a, b]: [Corner; 2] = if a.vertex < b.vertex { [*a, b] } else { [b, *a] };
            let light = |t: f32| interpolation.irradiance(&solution, leaf, a.uv.lerp(b.uv, t))[0].mean();
            if a.vertex != b.vertex {
                sides.entry([a.vertex, b.vertex]).or_default().push([0.0, 0.3, 0.8, 1.0].map(light).into());
            }
        }
    }
    assert!(anchored > 20, "{anchored} T-vertices");
    let most = sides.values().flatten().flatten().copied().fold(0.0, f32::max);
    let shared: Vec<_> = sides.values().filter(|lights| lights.len() == 2).collect();
    assert!(shared.len() > 500 && sides.values().all(|lights| lights.len() <= 2));
    for lights in shared {
        for (a, b) in lights[0].iter().zip(&lights[1]) {
            assert!((a - b).abs() < 1e-5 * most, "{a} and {b}");
        }
    }
}

/// Neighbours of subdivided elements are subdivided until levels differ by one at most.
#[test]
fn subdivision_is_balanced() {
    let scene = compile(&room(Point3::new(1.0, 1.0, 1.0), [0.5; 6]));
    let settings = settings(0.5);
    let Solution { wavelengths, mut cut, .. } = unsolved(&scene, &settings);
    let mut divide = |ids: &[u32]| {
        let parts = cut.split(&scene, &view(), &settings, &wavelengths, ids);
        let unbalanced = cut.unbalanced(&scene, &settings, |_| true);
        assert_eq!(
            cut.unbalanced(&scene, &settings, |patch| patch == 0),
            [0; 0],
            "it has no finer neighbour"
        );
        (parts, unbalanced)
    };
    let (parts, unbalanced) = divide(&[0]);
    assert_eq!(parts.len(), 4);
    assert!(unbalanced.is_empty(), "levels differ by one");
    let (_, mut unbalanced) = divide(&parts);
    // The two neighbours on the same wall, which has four patches.
    assert_eq!(unbalanced.len(), 2);
    while !unbalanced.is_empty() {
        unbalanced = divide(&unbalanced).1;
    }
    assert_eq!(cut.elements.len(), 24 + 15 + 2 * 3);
}

#[test]
fn leaves_cover_all_points() {
    let scene = furnished(room(Point3::new(1.0, 1.0, 1.0), [0.5; 6]));
    let solution = solved(&scene, &RadiosityDesc { tolerance: 0.1, ..settings(0.5) });
    let rng = &mut Rng::new(1, 0);
    let area: f32 = solution.cut.patches.iter().map(|patch| patch.area).sum();
    let expected = 6.0 + 0.12 + 4.0 * std::f32::consts::PI * 0.04;
    assert!((area / expected - 1.0).abs() < 3e-3, "{area}, not {expected}");
    for element in &solution.cut.elements {
        let cell = solution.cut.mesh.cell(element.cell);
        let mut domain = cell.domain();
        for _ in 0..3 {
            domain = domain.quarters()[(rng.uniform_f32() * 4.0) as usize];
        }
        let uv: Vec2 = domain.center();
        let surface = solution.cut.mesh.surface(scene.world(), cell.primitive, uv).unwrap();
        let hit = geometry::Hit { uv, ..*solution.cut.mesh.primitive(cell) };
        let (leaf, _) = solution.cut.mesh.leaf(scene.world(), &hit, &surface).unwrap();
        assert_eq!(leaf.element, cell.element);
    }
}

#[test]
fn the_mesh_file_is_complete() {
    let scene = furnished(room(Point3::new(1.0, 1.0, 1.0), [0.5; 6]));
    let solution = solved(&scene, &settings(0.5));
    let bytes =
        ply::encode(&scene, &solution, &interpolation(&scene, &solution), spectrum::RgbColorSpace::srgb());
    let header_end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let header = String::from_utf8(bytes[..header_end].to_vec()).unwrap();
    let count = |name: &str| -> usize {
        header.lines().find_map(|line| line.strip_prefix(name)).unwrap().trim().parse().unwrap()
    };
    let (vertices, faces) = (count("element vertex"), count("element face"));
    assert_eq!(bytes.len(), header_end + vertices * (24 + 3 + 12) + faces * 13);
    assert!(vertices > 100 && faces > vertices / 2);
    let vertex = |i: usize| &bytes[header_end + i * 39..][..39];
    let brightest = (0..vertices).map(|i| vertex(i)[24..27].iter().copied().max().unwrap()).max();
    assert_eq!(brightest, Some(255));
}

#[test]
fn light_is_unshot_before_the_sky_is_received() {
    let mut desc = SceneDesc::default();
    let radiance = InfiniteRadiance::Constant(SpectrumDesc::Constant(1.0));
    desc.lights.push(LightKind::Infinite { radiance, illuminance: None, portal: None }.into());
    desc.shapes.push(ShapeKind::Sphere { radius: 1.0, z_min: -1.0, z_max: 1.0, phi_max: 360.0 }.into());
    assert_eq!(unsolved(&compile(&desc), &settings(0.5)).unshot_share(), 1.0);
}

/// If there are more primitives than patches allowed, the lights and the largest are subdivided.
#[test]
fn patches_are_limited_for_many_primitives() {
    let dust = |i: u32| {
        let p = Point3::new(i as f32 / 400.0, 0.5, 0.2);
        [p, p + Point3::new(1e-3, 0.0, 0.0), p + Point3::new(0.0, 0.0, 1e-3)]
    };
    let mesh = MeshDesc {
        positions: (0..400).flat_map(dust).collect::<Vec<_>>().into(),
        indices: (0..400).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect::<Vec<_>>().into(),
        ..MeshDesc::default()
    };
    let mut desc = room(Point3::new(1.0, 1.0, 1.0), [0.5; 6]);
    desc.shapes.push(ShapeKind::Triangles(mesh).into());
    let scene = furnished(desc);
    let solution = solved(&scene, &RadiosityDesc { max_patches: 200, tolerance: 0.1, ..settings(1e-6) });
    // The room, the lamp and the ball.
    assert_eq!(solution.cut.mesh.left_out(), 400 + 6 + 2 + 1 - 100);
    assert!(solution.cut.patches.len() > 100 && solution.cut.elements.len() <= 200);
    let area: f32 = solution.cut.patches.iter().map(|patch| patch.area).sum();
    assert!(area > 6.5, "{area}");
    assert!(solution.cut.elements.iter().any(|element| !element.irradiance()[0].is_black()));
}

#[test]
fn subdivision_can_be_cancelled() {
    let scene = compile(&room(Point3::new(1.0, 1.0, 1.0), [0.5; 6]));
    let control = Control::default();
    control.cancel.store(true, std::sync::atomic::Ordering::Relaxed);
    assert!(Solution::new(&scene, &view(), &settings(0.1), &control).is_err());
}
