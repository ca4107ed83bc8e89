//! Scattering under surfaces against closed forms, and between algorithms.

use alhazen_integrators::{Path, RayIntegrator, SimplePath, build};
use description::{
    BdptDesc, CoefficientsDesc, IntegratorDesc, LightKind, MaterialKind, MediumDesc, MediumInterface,
    MediumKind, PathDesc, RadiosityDesc, RoughnessDesc, SceneDesc, ShapeDesc, ShapeKind, SimplePathDesc,
    SubsurfaceScattering,
};
use math::{Point3, Vec2};
use scattering::SubsurfaceMethod::{Diffusion, RandomWalk};
use scattering::{
    BssrdfTable, Dielectric, Directions, Scatter, TransportMode, TrowbridgeReitz, fr_dielectric,
};
use scene::{Interfaces, Scene};
use testkit::{Moments, welch_test};

use crate::support::{assert_mean, compile, quad, radiance, sphere, v, white_sky};

const ETA: f32 = 1.33;

fn body(reflectance: f32, mfp: f32, roughness: f32) -> MaterialKind {
    let scattering = SubsurfaceScattering::Reflectance { reflectance: reflectance.into(), mfp: mfp.into() };
    let roughness = RoughnessDesc::isotropic(roughness);
    MaterialKind::Subsurface { scattering, scale: 1.0, eta: ETA, g: 0.0, roughness, method: Diffusion }
}

fn scene(light: impl Fn(&mut SceneDesc), shape: ShapeKind, material: MaterialKind) -> Scene {
    let mut desc = SceneDesc::default();
    light(&mut desc);
    let material = Some(desc.materials.push(material.into()));
    desc.shapes.push(ShapeDesc { material, ..shape.into() });
    compile(&desc)
}

/// A homogeneous medium.
fn medium([sigma_a, sigma_s]: [f32; 2], g: f32) -> MediumDesc {
    let coefficients =
        CoefficientsDesc::Given { sigma_a: sigma_a.into(), sigma_s: sigma_s.into(), scale: 1.0 };
    let kind = MediumKind::Homogeneous { coefficients, le: None, le_scale: 1.0 };
    MediumDesc { name: "m".into(), kind, world_from_medium: Default::default(), g }
}

/// The same scene with a medium, which no ray meets, so that paths have heroes from their start.
fn with_heroes(light: impl Fn(&mut SceneDesc), shape: ShapeKind, material: MaterialKind) -> Scene {
    let with_medium = |desc: &mut SceneDesc| {
        light(desc);
        desc.media.push(medium([1.0; 2], 0.0));
    };
    scene(with_medium, shape, material)
}

fn sun(desc: &mut SceneDesc) {
    let (from, to) = (v(1.0, -2.0, 3.0), Point3::ZERO);
    desc.lights.push(LightKind::Distant { radiance: 1.0.into(), illuminance: None, from, to }.into());
}

fn path(max_depth: u32) -> Path {
    Path::new(PathDesc { max_depth, ..PathDesc::default() }, Interfaces::Pass)
}

/// The boundary reflects its Fresnel reflectance, and the effective albedo of the rest leaves
/// again, but for the thousandth that probes do not reach.
#[test]
fn a_plane_under_a_white_sky_shows_its_effective_albedo() {
    let plane = || quad(v(-1e3, -1e3, 0.0), v(2e3, 0.0, 0.0), v(0.0, 2e3, 0.0));
    let with_heroes = with_heroes(white_sky, plane(), body(0.6, 0.1, 0.0));
    let scene = scene(white_sky, plane(), body(0.6, 0.1, 0.0));
    let (o, d) = (v(3.0, 0.0, 2.0), v(-1.5, 0.5, -2.0));
    let reflected = f64::from(fr_dielectric(-d.normalize().z, ETA));
    let expected = reflected + (1.0 - reflected) * 0.6 * 0.999;
    for depth in [1, 5] {
        assert_mean(&radiance(&mut path(depth), &scene, o, d, 20_000), expected, 6, "path");
        assert_mean(&radiance(&mut path(depth), &with_heroes, o, d, 20_000), expected, 6, "vol-path");
        let mut simple = Path::without_light_sampling(depth);
        assert_mean(&radiance(&mut simple, &scene, o, d, 20_000), expected, 6, "simple-vol-path");
    }
}

/// The radiance along a ray to a ball.
fn of_ball(rays: &mut impl RayIntegrator, scene: &Scene, count: usize) -> Moments {
    radiance(rays, scene, v(0.3, -3.0, 0.4), v(0.0, 1.0, 0.0), count)
}

#[test]
fn algorithms_agree_on_a_ball_in_the_sun() {
    let with_heroes = with_heroes(sun, sphere(1.0), body(0.8, 0.3, 0.3));
    let scene = scene(sun, sphere(1.0), body(0.8, 0.3, 0.3));
    let of_path = of_ball(&mut path(6), &scene, 60_000);
    welch_test(&of_path, &of_ball(&mut path(6), &with_heroes, 60_000), 1).unwrap();
    assert!(of_path.mean > 0.0);
}

/// Where light hardly moves under the surface, it is a diffuse base under the boundary.
#[test]
fn a_short_mean_free_path_gives_the_local_surface() {
    let scene = scene(sun, sphere(1.0), body(0.7, 2e-4, 0.0));
    let local = SimplePath(SimplePathDesc { max_depth: 1, sample_lights: true, sample_bsdf: true });
    let expected = of_ball(&mut { local }, &scene, 20_000);
    let found = of_ball(&mut path(1), &scene, 60_000);
    let error = (found.variance_of_mean() + expected.variance_of_mean()).sqrt();
    assert!(
        (found.mean - expected.mean).abs() < 4.0 * error + 0.01 * expected.mean,
        "{found:?} {expected:?}"
    );
}

/// A body with given coefficients in which light walks.
fn walk([sigma_a, sigma_s]: [f32; 2], g: f32, roughness: f32) -> MaterialKind {
    let scattering = SubsurfaceScattering::Coefficients { sigma_a: sigma_a.into(), sigma_s: sigma_s.into() };
    let roughness = RoughnessDesc::isotropic(roughness);
    MaterialKind::Subsurface { scattering, scale: 1.0, eta: ETA, g, roughness, method: RandomWalk }
}

/// Under a uniform sky the direction in which light leaves does not matter, so that a walk is a
/// path through a medium within a dielectric boundary.
#[test]
fn a_walk_in_a_ball_is_a_path_through_its_medium() {
    let ([sigma_a, sigma_s], g) = ([0.1, 2.0], 0.4);
    let walked = scene(white_sky, sphere(1.0), walk([sigma_a, sigma_s], g, 0.0));
    let with_heroes = with_heroes(white_sky, sphere(1.0), walk([sigma_a, sigma_s], g, 0.0));
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    let inside = Some(desc.media.push(medium([sigma_a, sigma_s], g)));
    let boundary = MaterialKind::Dielectric { eta: ETA.into(), roughness: RoughnessDesc::default() };
    let material = Some(desc.materials.push(boundary.into()));
    let medium_interface = Some(MediumInterface { inside, outside: None });
    desc.shapes.push(ShapeDesc { material, medium_interface, ..sphere(1.0).into() });
    let exact = of_ball(&mut path(400), &compile(&desc), 40_000);
    for scene in [walked, with_heroes] {
        welch_test(&of_ball(&mut path(3), &scene, 40_000), &exact, 2).unwrap();
    }
}

#[test]
fn algorithms_agree_on_a_walk_in_the_sun() {
    let with_heroes = with_heroes(sun, sphere(1.0), walk([0.5, 3.0], 0.0, 0.3));
    let scene = scene(sun, sphere(1.0), walk([0.5, 3.0], 0.0, 0.3));
    let of_path = of_ball(&mut path(6), &scene, 60_000);
    welch_test(&of_path, &of_ball(&mut path(6), &with_heroes, 60_000), 1).unwrap();
    assert!(of_path.mean > 0.0);
}

/// Diffusion is an approximation, which gains light; the less, the less is absorbed.
#[test]
fn diffusion_is_near_to_a_walk_in_a_half_space() {
    let table = BssrdfTable::new(0.0, ETA);
    for (albedo, excess) in [(0.5, 0.105), (0.8, 0.065), (0.95, 0.055), (0.99, 0.04)] {
        let plane = quad(v(-1e3, -1e3, 0.0), v(2e3, 0.0, 0.0), v(0.0, 2e3, 0.0));
        let scene = scene(white_sky, plane, walk([1.0 - albedo, albedo], 0.0, 0.0));
        let found = radiance(&mut path(1), &scene, v(0.0, 0.0, 1.0), v(0.0, 0.0, -1.0), 50_000);
        let reflected = f64::from(fr_dielectric(1.0, ETA));
        let walked = (found.mean - reflected) / (1.0 - reflected);
        let error = found.variance_of_mean().sqrt() / walked;
        let diffused = f64::from(table.effective_albedo(albedo)) / walked;
        assert!((diffused - 1.0 - excess).abs() < 4.0 * error + 0.01, "{albedo}: {diffused}");
    }
}

/// What a boundary reflects of the light from a direction of this cosine, once by its facets.
fn reflected(cosine: f32, roughness: f32) -> f64 {
    const SIDE: usize = 64;
    let alpha = TrowbridgeReitz::roughness_to_alpha(roughness);
    let boundary = Dielectric { eta: ETA, distribution: TrowbridgeReitz::new(alpha, alpha) };
    let wo = v((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let middle = |i: usize| (i as f32 + 0.5) / SIDE as f32;
    let samples = (0..SIDE * SIDE).map(|i| {
        let u = Vec2::new(middle(i % SIDE), middle(i / SIDE));
        let sample = boundary.sample_f(wo, 0.0, u, TransportMode::Radiance, Directions::Reflection);
        if sample.valid { f64::from(sample.f[0] * sample.wi.z / sample.pdf) } else { 0.0 }
    });
    samples.sum::<f64>() / (SIDE * SIDE) as f64
}

/// Of the light of a uniform sky that a boundary does not reflect, a walk returns the reflectance
/// that was asked for: the mean over directions by their cosine, whose squares are uniform.
#[test]
fn walks_return_the_reflectance_that_is_asked_for() {
    const DIRECTIONS: usize = 8;
    let plane = || quad(v(-1e4, -1e4, 0.0), v(2e4, 0.0, 0.0), v(0.0, 2e4, 0.0));
    let cases = [(0.3, 0.0, 0.0), (0.8, 0.0, 0.0), (0.6, 0.7, 0.0), (0.6, 0.0, 0.3), (0.6, 0.7, 1.0)];
    for (reflectance, g, roughness) in cases {
        let mut material = body(reflectance, 0.1, roughness);
        if let MaterialKind::Subsurface { g: asymmetry, method, .. } = &mut material {
            (*asymmetry, *method) = (g, RandomWalk);
        }
        let scene = scene(white_sky, plane(), material);
        let (mut returned, mut entered, mut variance) = (0.0, 0.0, 0.0);
        for i in 0..DIRECTIONS {
            let cosine = ((i as f32 + 0.5) / DIRECTIONS as f32).sqrt();
            let d = v((1.0 - cosine * cosine).sqrt(), 0.0, -cosine);
            let found = radiance(&mut path(1), &scene, v(0.0, 0.0, 1.0), d, 10_000);
            let reflected = reflected(cosine, roughness);
            returned += found.mean - reflected;
            entered += 1.0 - reflected;
            variance += found.variance_of_mean();
        }
        let (share, error) = (returned / entered, variance.sqrt() / entered);
        // Half a percent for the errors of the table.
        let bound = 4.0 * error + 0.005;
        let message = format!("{reflectance} {g} {roughness}: {share} ± {error}");
        assert!((share - f64::from(reflectance)).abs() < bound, "{message}");
    }
}

#[test]
fn a_body_that_hardly_absorbs_gains_no_light() {
    let scene = scene(white_sky, sphere(1.0), body(0.95, 0.05, 0.2));
    let found = of_ball(&mut path(20), &scene, 20_000);
    assert!((0.85..1.0).contains(&found.mean), "{found:?}");
}

#[test]
fn algorithms_without_a_bssrdf_warn() {
    let warnings = |integrator: IntegratorDesc| {
        let mut desc = SceneDesc { integrator: integrator.into(), ..SceneDesc::default() };
        desc.materials.push(body(0.5, 1.0, 0.0).into());
        build(&desc).ok().unwrap().warnings
    };
    let path = PathDesc::default();
    let bdpt = IntegratorDesc::Bdpt(BdptDesc::default());
    for knows in [IntegratorDesc::Path(path), IntegratorDesc::VolPath(path), bdpt] {
        assert_eq!(warnings(knows), []);
    }
    for (name, lacks) in [
        ("radiosity", IntegratorDesc::Radiosity(RadiosityDesc::default())),
        ("ray-casting", IntegratorDesc::RayCasting),
    ] {
        let [warning] = &warnings(lacks)[..] else { panic!("one warning for `{name}`") };
        let start = format!("integrator `{name}` does not know scattering under surfaces");
        assert!(warning.message.starts_with(&start), "{}", warning.message);
    }
}
