//! Reflections that are traced, looked up, or both.

use alhazen_integrators::{Control, RayIntegrator, Tracer, Whitted};
use description::{ReflectionsDesc, SceneDesc, ShapeDesc, ShapeKind, SpheresDesc, WhittedDesc};
use geometry::RayStats;
use math::{Point3, Ray};
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::Scene;
use spectrum::{CIE_Y_INTEGRAL, SampledSpectrum, SampledWavelengths, y_from};

use crate::support::{at, compile, diffuse, emission, mirror, sphere, v, viewed, white_sky};

fn whitted(reflections: ReflectionsDesc, distance: f32) -> Whitted {
    let reflection_distance = Some(distance);
    Whitted::new(WhittedDesc { reflections, reflection_distance, ..WhittedDesc::default() })
}

/// The luminance along a ray downwards, relative to that of a lamp of scale 1: pictures have
/// colours, whose spectra are others.
fn along(reflections: ReflectionsDesc, distance: f32, scene: &Scene, o: Point3) -> f64 {
    along_with_rays(reflections, distance, scene, o).0
}

/// The same, and the number of rays that it took.
fn along_with_rays(reflections: ReflectionsDesc, distance: f32, scene: &Scene, o: Point3) -> (f64, u64) {
    const SAMPLES: u32 = 64;
    let mut rays = whitted(reflections, distance);
    let ((_, view), control) = (viewed(&SceneDesc::default()), Control::default());
    rays.prepare(scene, &view, &control).expect("nobody cancels it");
    let mut stats = RayStats::default();
    let mut sampler = Sampler::Independent(Independent::new(1, 7));
    let samples = (0..SAMPLES).map(|i| {
        sampler.start_pixel_sample([i as i32, 0], 0, 0);
        let mut lambda = SampledWavelengths::sample_visible((i as f32 + 0.5) / SAMPLES as f32);
        let mut tracer = Tracer::new(scene, &view, &control, &mut sampler, &mut stats);
        let l = rays.li(&mut tracer, Ray::new(o, v(0.0, 0.0, -1.0), 0.0).into(), &mut lambda);
        [l * CIE_Y_INTEGRAL, SampledSpectrum::ONE].map(|l| f64::from(y_from(&l, &lambda)))
    });
    let [found, white] = samples.fold([0.0; 2], |sum, [l, one]| [sum[0] + l, sum[1] + one]);
    (found / white, stats.rays)
}

/// A mirror ball at the origin, and lamps with these places, radii and emissions.
fn ball_among(lamps: &[(Point3, f32, f32)]) -> Scene {
    let mut desc = SceneDesc::default();
    let (silver, black) = (mirror(&mut desc, 0.0), diffuse(&mut desc, 0.0));
    desc.shapes.push(ShapeDesc { material: silver, ..at(sphere(1.0), v(0.0, 0.0, 0.0)) });
    for &(place, radius, scale) in lamps {
        let area_light = emission(&mut desc, scale);
        desc.shapes.push(ShapeDesc { material: black, area_light, ..at(sphere(radius), place) });
    }
    compile(&desc)
}

/// Origins of rays that the ball reflects upwards, nearly along the axis, and to the right.
const UP: Point3 = Point3::new(0.1, 0.0, 8.0);
const RIGHT: Point3 = Point3::new(0.707, 0.0, 8.0);

#[test]
fn a_sky_is_the_same_from_everywhere() {
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    let material = mirror(&mut desc, 0.0);
    desc.shapes.push(ShapeDesc { material, ..sphere(1.0).into() });
    let scene = compile(&desc);
    for reflections in [ReflectionsDesc::Environment, ReflectionsDesc::Hybrid] {
        let found = along(reflections, 0.5, &scene, RIGHT);
        assert!((found - 1.0).abs() < 0.005, "{reflections:?}: {found}");
    }
}

#[test]
fn distant_lamps_are_where_traced_rays_find_them() {
    let scene = ball_among(&[(v(1000.0, 0.0, 0.0), 200.0, 3.0), (v(0.0, 0.0, 2000.0), 900.0, 0.5)]);
    for (ray, expected) in [(RIGHT, 3.0), (UP, 0.5)] {
        let traced = along(ReflectionsDesc::Traced, 1.0, &scene, ray);
        assert!((traced - expected).abs() < 0.001 * expected, "{traced}, not {expected}");
        let found = along(ReflectionsDesc::Environment, 1.0, &scene, ray);
        assert!((found - traced).abs() < 0.01 * traced, "{found}, not {traced}");
    }
}

/// From the centre of the ball the lamp covers its direction to the right; from its surface it does
/// not.
#[test]
fn what_is_near_is_shifted_in_the_picture_alone() {
    let scene = ball_among(&[(v(4.0, 0.0, -1.0), 1.5, 2.0)]);
    assert_eq!(along(ReflectionsDesc::Traced, 1.0, &scene, RIGHT), 0.0);
    assert!((along(ReflectionsDesc::Environment, 1.0, &scene, RIGHT) - 2.0).abs() < 0.02);
}

#[test]
fn hybrids_end_in_rays_and_in_the_picture_and_blend_between() {
    // A ray at the height of 0.707 finds the lamp, one from the centre of the ball does not.
    let scene = ball_among(&[(v(4.0, 0.0, 1.5), 1.3, 2.0)]);
    let hybrid = |distance| along(ReflectionsDesc::Hybrid, distance, &scene, RIGHT);
    let traced = along(ReflectionsDesc::Traced, 1.0, &scene, RIGHT);
    let picture = along(ReflectionsDesc::Environment, 1.0, &scene, RIGHT);
    assert!(traced > 1.9 && picture == 0.0);
    assert_eq!(hybrid(1000.0), traced);
    assert_eq!(hybrid(0.1), picture);
    let t = 4.0 - 0.707 - (1.3 * 1.3 - 0.793_f64 * 0.793).sqrt();
    let expected = traced * (2.0 - 2.0 * t / 3.0);
    assert!((hybrid(3.0) - expected).abs() < 0.01 * expected, "{}, not {expected}", hybrid(3.0));
}

/// A ray that passes a near lamp must not find it in the picture, from whose place it is elsewhere.
#[test]
fn hybrids_show_near_things_once() {
    let scene = ball_among(&[(v(4.0, 0.0, -1.0), 1.5, 2.0)]);
    assert_eq!(along(ReflectionsDesc::Hybrid, 40.0, &scene, RIGHT), 0.0);
}

/// From the centre of the ball its inside is all around.
#[test]
fn the_object_is_missing_in_its_own_picture() {
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    let material = mirror(&mut desc, 0.0);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(1.0), v(0.0, 0.0, 0.0)) });
    let found = along(ReflectionsDesc::Environment, 1.0, &compile(&desc), UP);
    assert!((found - 1.0).abs() < 0.005, "{found}");
}

/// Pictures are of the scene and not of a view, so that others take their pixels on; but not with
/// other settings, and not when something has moved. The ray looks up four pixels of sixteen
/// samples.
#[test]
fn pixels_of_pictures_are_computed_once_until_something_changes() {
    use ReflectionsDesc::{Environment, Hybrid};
    const PIXELS: u64 = 4 * 16;
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    let (silver, black) = (mirror(&mut desc, 0.0), diffuse(&mut desc, 0.0));
    desc.shapes.push(ShapeDesc { material: silver, ..at(sphere(1.0), v(0.0, 0.0, 0.0)) });
    let ball = SpheresDesc { centers: [v(100.0, 0.0, 0.0)].into(), radii: [20.0].into() };
    desc.shapes.push(ShapeDesc { material: black, ..ShapeKind::Spheres(ball).into() });
    let mut scene = compile(&desc);
    let (dark, all) = along_with_rays(Environment, 1.0, &scene, RIGHT);
    let (again, few) = along_with_rays(Environment, 1.0, &scene.clone(), RIGHT);
    assert!(dark == 0.0 && again == 0.0, "{dark}, {again}");
    assert!(all >= few + PIXELS, "{all} rays, then {few}");
    let [first, second] = [0, 1].map(|_| along_with_rays(Hybrid, 1.0, &scene, RIGHT).1);
    assert!(first >= second + PIXELS, "{first} rays, then {second}");

    let before = scene.clone();
    let id = scene.sphere_sets().next().expect("a set").0;
    scene.move_points([(id, [v(0.0, 100.0, 0.0)].into())]).expect("the set has one sphere");
    let (light, new) = along_with_rays(Environment, 1.0, &scene, RIGHT);
    assert!((light - 1.0).abs() < 0.005 && new >= few + PIXELS, "{light}, {new} rays");
    assert_eq!(along_with_rays(Environment, 1.0, &before, RIGHT).1, few);
}
