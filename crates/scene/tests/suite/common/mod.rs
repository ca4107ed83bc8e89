//! Small scenes, built by hand, for the tests of this crate.

pub mod lights;

use alhazen_scene::light::{LightLiSample, LightRef, LightSampleContext};
use alhazen_scene::{Interfaces, RayStats, Scene, SurfaceInteraction, View, world_from_render};
use description::{ImageDesc, MeshDesc, PatchMeshDesc, SceneDesc, ShapeKind};
use image::Image;
use math::{Normal3, Point3, Point3Error, Ray, Vec2, Vec3, Vector3};
use spectrum::SampledWavelengths;
use std::f32::consts::PI;
use std::sync::Arc;
use testkit::{Chi2, Random};

/// Compiles a valid scene. World space is render space, as the camera is at the origin.
pub fn scene(desc: &SceneDesc) -> Scene {
    let compiled =
        alhazen_scene::compile(desc.clone()).unwrap_or_else(|diagnostics| panic!("{diagnostics:?}"));
    // Many test scenes have no light.
    let is_dark = |code: &str| matches!(code, "empty-scene" | "no-light" | "black-light");
    assert!(compiled.warnings.iter().all(|warning| is_dark(warning.code)), "{:?}", compiled.warnings);
    compiled.scene
}

/// The view of a valid description.
pub fn view(desc: &SceneDesc) -> View {
    View::compile(desc, world_from_render(desc)).unwrap_or_else(|errors| panic!("{errors:?}")).view
}

pub fn lambda() -> SampledWavelengths {
    SampledWavelengths::sample_visible(0.3)
}

/// The shutter time of rays and points, in the middle of motion.
pub const TIME: f32 = 0.25;

pub fn ray(o: Point3, d: Vector3) -> Ray {
    Ray::new(o, d, TIME)
}

/// The nearest surface along a ray.
pub fn hit(scene: &Scene, ray: &Ray) -> Option<SurfaceInteraction> {
    scene.intersect(ray, f32::INFINITY, &mut RayStats::default()).map(|(surface, _)| surface)
}

/// A reference point for light sampling; not on a surface if `n` is zero.
pub fn context(p: Point3, n: Normal3) -> LightSampleContext {
    LightSampleContext { p: Point3Error::exact(p), n, ns: n, time: TIME }
}

/// The incident radiance from `w`, of all lights, at the first wavelength.
pub fn arriving(scene: &Scene, from: &LightSampleContext, w: Vector3) -> f64 {
    let (ray, lambda) = (from.spawn_ray(w), lambda());
    let radiance = match hit(scene, &ray) {
        Some(surface) => scene.emitted(&surface, -w, &lambda),
        None => scene.escaped(&ray, &lambda),
    };
    radiance[0] as f64
}

/// An unoccluded sample of a light.
pub fn seen_sample(
    scene: &Scene,
    light: LightRef,
    from: &LightSampleContext,
    u: [f32; 2],
    allow_incomplete: bool,
) -> Option<LightLiSample> {
    let sample = scene.sample_light(light.id(), from, u.into(), &lambda(), allow_incomplete)?;
    let hidden = sample.p.is_some_and(|p| {
        let ray = Ray::between(from.p, from.n, p, sample.n, from.time);
        scene.occluded(&ray, Ray::SHADOW_END, Interfaces::Stop, &mut RayStats::default())
    });
    (!hidden).then_some(sample)
}

pub fn sphere(radius: f32) -> ShapeKind {
    ShapeKind::Sphere { radius, z_min: -radius, z_max: radius, phi_max: 360.0 }
}

/// In the plane z = `height`; its normal is +z.
pub fn disk(height: f32, radius: f32) -> ShapeKind {
    ShapeKind::Disk { height, radius, inner_radius: 0.0, phi_max: 360.0 }
}

pub fn cylinder(radius: f32, z_min: f32, z_max: f32) -> ShapeKind {
    ShapeKind::Cylinder { radius, z_min, z_max, phi_max: 360.0 }
}

pub fn triangles(positions: &[[f32; 3]], indices: &[[u32; 3]]) -> ShapeKind {
    let positions: Arc<[Point3]> = positions.iter().map(|&p| p.into()).collect();
    ShapeKind::Triangles(MeshDesc { indices: indices.into(), positions, ..MeshDesc::default() })
}

/// Corners at (u, v) = (0, 0), (1, 0), (0, 1), (1, 1).
pub fn patch(corners: [[f32; 3]; 4]) -> ShapeKind {
    let positions: Arc<[Point3]> = corners.iter().map(|&p| p.into()).collect();
    ShapeKind::Patches(PatchMeshDesc {
        indices: [[0, 1, 2, 3]].into(),
        positions,
        ..PatchMeshDesc::default()
    })
}

/// The rectangle [x0, x1] × [y0, y1] at z = 0, normal +z, as a patch.
pub fn rectangle([x0, y0]: [f32; 2], [x1, y1]: [f32; 2]) -> ShapeKind {
    patch([[x0, y0, 0.0], [x1, y0, 0.0], [x0, y1, 0.0], [x1, y1, 0.0]])
}

/// An image from one colour per pixel.
pub fn rgb_image(width: u32, height: u32, pixel: impl FnMut(u32, u32) -> [f32; 3]) -> ImageDesc {
    ImageDesc { name: "image".into(), image: Arc::new(Image::from_fn(width, height, ["R", "G", "B"], pixel)) }
}

pub fn uniform_direction(random: &mut Random) -> Vector3 {
    sampling::warp::sample_uniform_sphere(Vec2::from(random.get_2d()))
}

/// A point of the cube [−size, size]³.
pub fn point_in_cube(random: &mut Random, size: f32) -> Point3 {
    Vec3::from_array([(); 3].map(|()| (2.0 * random.get_1d() - 1.0) * size))
}

/// Tests samples against a discontinuous density, integrated by the midpoint rule on cells of equal
/// solid angle. Cells that are mostly dark are pooled with failed samples, as their integral is
/// inaccurate.
pub fn check_directions(
    sample: impl Fn([f32; 2]) -> Option<[f32; 3]>,
    density: impl Fn([f32; 3]) -> f64,
    seed: u64,
    tests: usize,
) -> Result<(), String> {
    let (rows, columns, fine, count) = (8, 16, 48, 5_000);
    let mut cells = vec![(0.0, 0); rows * columns];
    for i in 0..rows * fine {
        for j in 0..columns * fine {
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / (rows * fine) as f32;
            let phi = 2.0 * PI * (j as f32 + 0.5) / (columns * fine) as f32;
            let pdf = density(math::spherical_direction((1.0 - z * z).sqrt(), z, phi).to_array());
            let (sum, lit) = &mut cells[i / fine * columns + j / fine];
            *sum += pdf;
            *lit += usize::from(pdf > 0.0);
        }
    }
    let weight = 4.0 * PI as f64 / (cells.len() * fine * fine) as f64;
    let total: f64 = cells.iter().map(|(sum, _)| sum * weight).sum();
    if total > 1.005 {
        return Err(format!("the density integrates to {total}"));
    }
    let is_dark = |cell: usize| cells[cell].1 * 8 < fine * fine;
    let cell_count = |(sum, _): &(f64, usize)| sum * weight * count as f64;
    let mut expected: Vec<f64> = cells.iter().map(cell_count).collect();
    (0..expected.len()).filter(|&cell| is_dark(cell)).for_each(|cell| expected[cell] = 0.0);
    expected.push((count as f64 - expected.iter().sum::<f64>()).max(1e-3));
    let mut observed = vec![0; expected.len()];
    let mut random = Random::new(seed);
    for _ in 0..count {
        let cell = sample(random.get_2d()).map(|w| {
            let row = ((1.0 - w[2]) / 2.0 * rows as f32) as usize;
            let phi = w[1].atan2(w[0]).rem_euclid(2.0 * PI);
            let column = (phi / (2.0 * PI) * columns as f32) as usize;
            row.min(rows - 1) * columns + column.min(columns - 1)
        });
        observed[cell.filter(|&cell| !is_dark(cell)).unwrap_or(cells.len())] += 1;
    }
    Chi2 { tests, ..Chi2::default() }.counts(&observed, &expected)
}
