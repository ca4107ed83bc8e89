//! Methods that merge photons, against closed forms of their results and of their bias.

use std::f64::consts::PI;
use std::sync::atomic::Ordering;

use alhazen_integrators::{Control, PassError, Vcm, build};
use description::{
    BdptDesc, CameraKind, IntegratorDesc, LensDesc, LightKind, SamplerDesc, SamplerKind, SceneDesc,
    ScreenDesc, ShapeDesc, SpectrumDesc, SppmDesc, TextureDesc, TextureKind, TransformDesc, VcmDesc,
};
use film::Film;
use math::{DMat4, DVec3};
use sampling::Sampler;
use sampling::sampler::Independent;
use testkit::{Moments, t_test, z_test};

use crate::support::{at, diffuse, emission, finished, mirror, quad, sphere, v, viewed};

/// A scene whose film is small, with one choice of wavelengths.
fn on_film(resolution: [i32; 2]) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.resolution = resolution;
    desc.film.save_fp16 = false;
    desc.options.disable_wavelength_jitter = true;
    desc
}

/// The mean of all values of the picture after each of the numbers of passes.
fn means<const N: usize>(
    desc: &SceneDesc,
    integrator: IntegratorDesc,
    seed: i32,
    after: [u32; N],
) -> [f64; N] {
    let sampler = SamplerDesc { kind: SamplerKind::Independent { pixel_samples: 1 }, seed: Some(seed) };
    let desc = SceneDesc { integrator: integrator.into(), sampler: sampler.into(), ..desc.clone() };
    let ((scene, view), mut film) = (viewed(&desc), film::compile(&desc).unwrap().film);
    let mut integrator = build(&desc).ok().unwrap().integrator;
    integrator.prepare(&scene, &view, &Control::default()).unwrap();
    let mut pass = 0;
    after.map(|passes| {
        while pass < passes {
            integrator.pass(pass, &scene, &view, &mut film, &Control::default()).unwrap();
            pass += 1;
        }
        mean(&film)
    })
}

/// The mean of all values of the picture.
fn mean(film: &Film) -> f64 {
    let picture = film.develop().unwrap();
    picture.values().map(f64::from).sum::<f64>() / picture.values().count() as f64
}

/// The value of radiance 1 in a picture.
fn one() -> f64 {
    let [one] = means(&furnace(0.0), IntegratorDesc::RayCasting, 0, [1]);
    one
}

fn sppm(max_depth: u32, radius: f32, photons: u32) -> IntegratorDesc {
    let (photons_per_iteration, radius) = (Some(photons), Some(radius));
    IntegratorDesc::Sppm(SppmDesc { max_depth, photons_per_iteration, radius, seed: None })
}

fn vcm(max_depth: u32, radius: f32, alpha: f32) -> IntegratorDesc {
    IntegratorDesc::Vcm(VcmDesc { max_depth, radius: Some(radius), alpha })
}

/// A camera in a sphere that emits 1 and reflects ρ.
fn furnace(rho: f32) -> SceneDesc {
    let mut desc = on_film([6, 6]);
    let (material, area_light) = (diffuse(&mut desc, rho), emission(&mut desc, 1.0));
    let shape = at(sphere(1.0), v(0.2, 0.1, 0.3));
    desc.shapes.push(ShapeDesc { material, area_light, reverse_orientation: true, ..shape });
    desc
}

/// A mirror above a lamp reflects its light to the floor, as from a point at the height `HEIGHT`.
/// The camera sees the floor below that point, the foot, in a second mirror: by paths that only
/// merging can find. The floor is a checkerboard of these alphas, the first of them at the foot.
fn between_mirrors(alphas: [f32; 2]) -> SceneDesc {
    let mut desc = on_film([8, 8]);
    let (from, to) = (v(0.0, 0.0, 0.2), v(0.0, 0.0, 1.0));
    let intensity = SpectrumDesc::Constant(1.0);
    let spot = LightKind::Spot { intensity, power: None, from, to, cone_angle: 60.0, cone_delta_angle: 0.0 };
    desc.lights.push(spot.into());
    let material = diffuse(&mut desc, 0.5);
    let floor = quad(v(-3.0, -3.0, 0.0), v(6.0, 0.0, 0.0), v(0.0, 6.0, 0.0));
    let kind = TextureKind::Checkerboard { textures: alphas.map(f32::into), mapping: None };
    // Cubes of side 0.1, one of them around the foot.
    let world_from_texture =
        DMat4::from_scale_rotation_translation(DVec3::splat(0.1), Default::default(), DVec3::splat(-0.05));
    let texture = desc.float_textures.push(TextureDesc { world_from_texture, ..TextureDesc::new(kind) });
    desc.shapes.push(ShapeDesc { material, alpha: Some(texture.into()), ..floor.into() });
    let material = mirror(&mut desc, 0.0);
    let above = quad(v(-1.0, -1.0, 0.5), v(2.0, 0.0, 0.0), v(0.0, 2.0, 0.0));
    desc.shapes.push(ShapeDesc { material, ..above.into() });
    let beside = quad(v(-3.0, 2.0, 0.0), v(6.0, 0.0, 0.0), v(0.0, 0.0, 3.0));
    desc.shapes.push(ShapeDesc { material, ..beside.into() });
    // In the mirror the foot is at y = 4.
    desc.camera.kind =
        CameraKind::Perspective { fov: 0.01, screen: ScreenDesc::default(), lens: LensDesc::default() };
    let (eye, foot) = (DVec3::new(0.0, 1.5, 0.3), DVec3::new(0.0, 4.0, 0.0));
    let (right, forward) = (DVec3::X, (foot - eye).normalize());
    let [x, y, z] = [right, right.cross(forward), forward].map(|axis| axis.extend(0.0));
    desc.camera.camera_from_world =
        TransformDesc::fixed(DMat4::from_cols(x, y, z, eye.extend(1.0)).inverse());
    desc
}

const HEIGHT: f64 = 0.8;

/// The radiance there, blurred over the radius r: ρ/π times the mean of h/(h² + x²)^{3/2} over
/// |x| < r.
fn blurred(r: f64) -> f64 {
    0.5 / PI * 2.0 / (r * r) * (1.0 - HEIGHT / (HEIGHT * HEIGHT + r * r).sqrt())
}

/// The same as the mean of all passes, with a radius that shrinks by α.
fn progressively_blurred(radius: f64, alpha: f64, passes: u32) -> f64 {
    let mut square = radius * radius;
    let blurred_passes = (1..=passes).map(|i| {
        let seen = blurred(square.sqrt());
        square *= (f64::from(i) + alpha) / (f64::from(i) + 1.0);
        seen
    });
    blurred_passes.sum::<f64>() / f64::from(passes)
}

#[test]
fn bias_and_its_rate_equal_the_closed_form() {
    let (desc, one) = (between_mirrors([1.0; 2]), one());
    let sharp = 0.5 / PI / (HEIGHT * HEIGHT);
    let after = [1, 16, 128];
    for (integrator, alpha) in [(sppm(3, 0.6, 200), 2.0 / 3.0), (vcm(3, 0.6, 0.5), 0.5)] {
        let mut found = [Moments::default(); 3];
        for seed in 0..12 {
            let means = means(&desc, integrator.clone(), seed, after);
            found.iter_mut().zip(means).for_each(|(moments, mean)| moments.push(mean / one));
        }
        for (found, passes) in found.iter().zip(after) {
            let expected = progressively_blurred(0.6f32.into(), alpha, passes);
            t_test(found, expected, 6)
                .unwrap_or_else(|error| panic!("{integrator:?}, {passes} passes: {error}"));
        }
        // The slope between the last two on a log–log scale.
        let [_, early, late] = found;
        let way = (128f64 / 16.0).ln();
        let slope = ((sharp - late.mean) / (sharp - early.mean)).ln() / way;
        let relative = |m: &Moments| m.variance_of_mean() / (sharp - m.mean).powi(2);
        let error = (relative(&early) + relative(&late)).sqrt() / way;
        let bias = |passes| sharp - progressively_blurred(0.6f32.into(), alpha, passes);
        z_test(slope, error, (bias(128) / bias(16)).ln() / way, 2).unwrap();
        // The slope of the closed form converges to α − 1.
        let in_the_end = (bias(1 << 20) / bias(1 << 18)).ln() / 4f64.ln();
        assert!((in_the_end - (alpha - 1.0)).abs() < 0.01, "{in_the_end}");
    }
}

#[test]
fn reflected_light_is_proportional_to_alpha() {
    let one = one();
    for alphas in [[0.5, 0.5], [0.25, 0.25], [0.25, 0.75]] {
        let desc = between_mirrors(alphas);
        for (integrator, alpha) in [(sppm(3, 0.6, 2000), 2.0 / 3.0), (vcm(3, 0.6, 0.5), 0.5)] {
            let found = |seed| means(&desc, integrator.clone(), seed, [16])[0] / one;
            let found: Moments = (0..12).map(found).collect();
            let expected = f64::from(alphas[0]) * progressively_blurred(0.6f32.into(), alpha, 16);
            t_test(&found, expected, 6).unwrap_or_else(|error| panic!("{alphas:?}, {integrator:?}: {error}"));
        }
    }
}

#[test]
fn a_tiny_radius_gives_the_result_of_connections_only() {
    let mut desc = on_film([6, 6]);
    let (material, area_light) = (diffuse(&mut desc, 0.7), emission(&mut desc, 3.0));
    for wall in crate::support::walls(1.0) {
        desc.shapes.push(ShapeDesc { material, ..wall.into() });
    }
    let lamp = quad(v(-0.5, 0.9, -0.5), v(1.0, 0.0, 0.0), v(0.0, 0.0, 1.0));
    desc.shapes.push(ShapeDesc { area_light, ..lamp.into() });
    let bdpt = IntegratorDesc::Bdpt(BdptDesc {
        max_depth: 4,
        regularize: false,
        visualize_strategies: false,
        visualize_weights: false,
    });
    let [connected] = means(&desc, bdpt, 3, [8]);
    let [merged] = means(&desc, vcm(4, 1e-6, 0.75), 3, [8]);
    assert!((merged - connected).abs() < 1e-5 * connected, "{merged} {connected}");
    let [merged] = means(&desc, vcm(4, 0.2, 0.75), 3, [8]);
    assert!((merged - connected).abs() > 1e-4 * connected, "{merged} {connected}");
}

#[test]
fn the_mean_does_not_depend_on_the_number_of_photon_paths() {
    let (one, rho, desc) = (one(), 0.6, furnace(0.6));
    let mut means = Moments::default();
    for seed in 0..16 {
        let sampler = Sampler::Independent(Independent::new(8, seed));
        let light_sampler = Sampler::Independent(Independent::new(8, seed + 100));
        let settings = VcmDesc { max_depth: 3, radius: Some(0.4), ..VcmDesc::default() };
        let vcm = finished(&desc, Box::new(Vcm::new(settings, sampler, light_sampler, seed, 7)));
        assert!(vcm.integrator().summary()[0].1.contains("from 7 paths"));
        means.push(mean(&vcm.state().film));
    }
    t_test(&means, one * (1.0 + rho + rho * rho + rho * rho * rho), 1).unwrap();
}

#[test]
fn a_pass_can_be_cancelled_before_photons_are_emitted() {
    for integrator in [sppm(5, 0.4, 500), vcm(5, 0.4, 0.75)] {
        let desc = SceneDesc { integrator: integrator.into(), ..furnace(0.5) };
        let ((scene, view), mut film) = (viewed(&desc), film::compile(&desc).unwrap().film);
        let mut integrator = build(&desc).ok().unwrap().integrator;
        integrator.prepare(&scene, &view, &Control::default()).unwrap();
        let control = Control::default();
        integrator.pass(0, &scene, &view, &mut film, &control).unwrap();
        let taken = film.sample_count();
        control.cancel.store(true, Ordering::Relaxed);
        assert_eq!(integrator.pass(1, &scene, &view, &mut film, &control), Err(PassError::Cancelled));
        assert_eq!(film.sample_count(), taken);
        let summary = integrator.summary();
        assert_eq!(summary.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["photons", "radius"]);
        assert_eq!(summary[1].1, "0.4 in pass 1, 0.4 in pass 1");
    }
}
