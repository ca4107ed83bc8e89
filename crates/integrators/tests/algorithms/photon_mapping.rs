//! Photon mapping against closed forms and unbiased algorithms, and pictures of photons.

use alhazen_integrators::{Control, build};
use description::{
    CameraKind, IntegratorDesc, LensDesc, LightKind, LightSamplerDesc, LightTracingDesc, PathDesc,
    PhotonKernel, PhotonMappingDesc, PhotonMappingShow, SamplerDesc, SamplerKind, SceneDesc, ScreenDesc,
    ShapeDesc, SpectrumDesc, TransformDesc,
};
use math::{DMat4, DVec3};
use testkit::{Moments, t_test, welch_test};

use crate::agreement::room;
use crate::session::picture;
use crate::support::{at, diffuse, emission, glass, quad, sphere, v, walls};

/// The luminances of a picture, row by row, rendered by one thread.
fn luminances(desc: &SceneDesc, integrator: &IntegratorDesc, seed: i32, passes: u32) -> Vec<f64> {
    let mut desc = SceneDesc { integrator: integrator.clone().into(), ..desc.clone() };
    desc.film.save_fp16 = false;
    desc.film.max_component_value = f32::INFINITY;
    desc.sampler.value =
        SamplerDesc { kind: SamplerKind::Independent { pixel_samples: passes }, seed: Some(seed) };
    let (film, _) = picture(&desc, 1);
    let image = film.develop().unwrap();
    let luminance = |[r, g, b]: [f32; 3]| f64::from(0.2126 * r + 0.7152 * g + 0.0722 * b);
    let pixels = (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| (x, y)));
    pixels.map(|(x, y)| luminance(image.rgb(x, y))).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn small(desc: &PhotonMappingDesc) -> PhotonMappingDesc {
    PhotonMappingDesc { photons: 1500, caustic_photons: 500, ..*desc }
}

/// The mean of a grey picture relative to that of its emission, for successive seeds.
fn brightness(desc: &SceneDesc, integrator: &PhotonMappingDesc, seeds: i32) -> Moments {
    let lamps = PhotonMappingDesc { max_depth: 0, photons: 0, caustic_photons: 0, ..*integrator };
    let ratio = |seed| {
        // The same seed has the same wavelengths.
        let all = luminances(desc, &IntegratorDesc::PhotonMapping(*integrator), seed, 1);
        mean(&all) / mean(&luminances(desc, &IntegratorDesc::PhotonMapping(lamps), seed, 1))
    };
    (0..seeds).map(ratio).collect()
}

/// Shapes of emission 1 and albedo ½ that enclose the camera, seen in `resolution`² pixels.
fn furnace(shapes: impl IntoIterator<Item = ShapeDesc>, resolution: i32) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.resolution = [resolution; 2];
    let (material, area_light) = (diffuse(&mut desc, 0.5), emission(&mut desc, 1.0));
    for shape in shapes {
        desc.shapes.push(ShapeDesc { material, area_light, ..shape });
    }
    desc
}

#[test]
fn photon_mapping_is_unbiased_in_an_emissive_sphere() {
    let ball = ShapeDesc { reverse_orientation: true, ..at(sphere(1.0), v(0.2, 0.1, 0.3)) };
    let desc = furnace([ball], 6);
    // With a larger radius, the curvature of the sphere loses light below the horizon.
    let radius = Some(0.1);
    let cases = [(1, 0, 5), (2, 0, 1000), (3, 0, 5), (24, 0, 5), (2, 3, 5), (24, 3, 5)];
    for (max_depth, gather, nearest) in cases {
        for kernel in [PhotonKernel::Cone, PhotonKernel::Epanechnikov] {
            let default = PhotonMappingDesc { photons: 6000, ..small(&PhotonMappingDesc::default()) };
            let integrator = PhotonMappingDesc { max_depth, gather, nearest, radius, kernel, ..default };
            let found = brightness(&desc, &integrator, 12);
            let expected = (0..=max_depth).map(|k| 0.5f64.powi(k as i32)).sum();
            t_test(&found, expected, 2 * cases.len())
                .unwrap_or_else(|difference| panic!("{integrator:?}: {difference}"));
        }
    }
}

#[test]
fn the_bias_of_a_wall_is_the_part_of_the_disk_beyond_its_edges() {
    let mut desc = furnace(walls(1.0).map(ShapeDesc::from), 24);
    desc.camera.kind = CameraKind::Orthographic { screen: ScreenDesc::default(), lens: LensDesc::default() };
    let radii = [0.48, 0.24, 0.12];
    let bias = radii.map(|radius| {
        let integrator = PhotonMappingDesc {
            max_depth: 24,
            nearest: i32::MAX as u32 - 1,
            radius: Some(radius),
            ..small(&PhotonMappingDesc::default())
        };
        let found = brightness(&desc, &integrator, 24);
        // Of a square of side 2, the share (1 − |x|/2)(1 − |y|/2) overlaps with itself shifted by
        // (x, y); and the kernel has the means E|x| = 16r/15π and E|xy| = r²/3π.
        let (r, pi) = (f64::from(radius), std::f64::consts::PI);
        let inside = 1.0 - 16.0 * r / (15.0 * pi) + r * r / (12.0 * pi);
        t_test(&found, 1.5 + 0.5 * inside, radii.len())
            .unwrap_or_else(|difference| panic!("within {radius}: {difference}"));
        2.0 - found.mean
    });
    // Of the order r: an edge is a line.
    let slope = (bias[0] / bias[2]).log2() / 2.0;
    assert!((slope - 1.0).abs() < 0.15, "the bias is of order {slope} in the radius: {bias:?}");
}

/// Looks down on the square [-s, s]².
fn from_above(desc: &mut SceneDesc, s: f32, resolution: i32) {
    desc.film.resolution = [resolution; 2];
    let screen = ScreenDesc { window: Some([-s, s, -s, s]), ..ScreenDesc::default() };
    desc.camera.kind = CameraKind::Orthographic { screen, lens: LensDesc::default() };
    desc.camera.camera_from_world = TransformDesc::fixed(DMat4::from_scale(DVec3::new(1.0, -1.0, -1.0)));
}

fn path(max_depth: u32) -> IntegratorDesc {
    IntegratorDesc::Path(PathDesc { max_depth, regularize: false, light_sampler: LightSamplerDesc::Bvh })
}

/// The share of a room's indirect light that photon mapping finds, seen from above.
fn indirect(integrator: &PhotonMappingDesc) -> f64 {
    let mut desc = room();
    // As everything is grey, fixed wavelengths avoid colour noise.
    desc.options.disable_wavelength_jitter = true;
    from_above(&mut desc, 1.0, 16);
    let [direct, all] = [1, 4].map(|max_depth| mean(&luminances(&desc, &path(max_depth), 1, 1024)));
    let find = |photons| {
        let default = PhotonMappingDesc { max_depth: 4, radius: Some(1.0), ..*integrator };
        let integrator = PhotonMappingDesc { photons, caustic_photons: 0, ..default };
        mean(&luminances(&desc, &IntegratorDesc::PhotonMapping(integrator), 2, 16))
    };
    // Direct light is the same without photons.
    (find(integrator.photons) - find(0)) / (all - direct)
}

#[test]
fn photon_mapping_converges_to_path_tracing() {
    let errors = [1000, 4000, 16_000].map(|photons| {
        1.0 - indirect(&PhotonMappingDesc { photons, nearest: 40, ..PhotonMappingDesc::default() })
    });
    // Four times the photons halve the radius, and with it the dark edges.
    let slope = (errors[0] / errors[1]).log2();
    assert!((slope - 1.0).abs() < 0.3, "the error is of order {slope} in the radius: {errors:?}");
    assert!(errors[2].abs() < 0.6 * errors[1], "{errors:?}");
}

#[test]
fn a_final_gather_reduces_the_bias_at_edges() {
    let integrator = PhotonMappingDesc { photons: 4000, nearest: 40, ..PhotonMappingDesc::default() };
    let found = [0, 4].map(|gather| indirect(&PhotonMappingDesc { gather, ..integrator }));
    assert!(1.0 - found[1] < 0.6 * (1.0 - found[0]), "{found:?}");
}

/// A ball of glass over a floor with the given alpha, in the beam of a spot light.
fn ball_in_a_beam(alpha: f32) -> SceneDesc {
    let mut desc = SceneDesc::default();
    from_above(&mut desc, 2.0, 32);
    let (material, alpha) = (diffuse(&mut desc, 0.8), Some(alpha.into()));
    let floor = quad(v(-3.0, -3.0, -1.0), v(6.0, 0.0, 0.0), v(0.0, 6.0, 0.0));
    desc.shapes.push(ShapeDesc { material, alpha, ..floor.into() });
    let material = glass(&mut desc);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.25), v(0.0, 0.0, -0.6)) });
    let beam = LightKind::Spot {
        intensity: SpectrumDesc::Constant(1.0),
        power: None,
        from: v(-3.0, 0.0, 1.0),
        to: v(0.0, 0.0, -0.6),
        cone_angle: 8.0,
        cone_delta_angle: 1.0,
    };
    desc.lights.push(beam.into());
    desc
}

/// The mean over the caustic, beside the ball, for each seed.
fn caustic(desc: &SceneDesc, integrator: &IntegratorDesc, passes: u32) -> Moments {
    let of_region = |seed| {
        let picture = luminances(desc, integrator, seed, passes);
        let region = (0..32 * 32).filter(|i| i % 32 > 20 && (8..24).contains(&(i / 32)));
        mean(&region.map(|i| picture[i]).collect::<Vec<_>>())
    };
    (0..16).map(of_region).collect()
}

#[test]
fn caustics_agree_with_light_tracing() {
    let photons = PhotonMappingDesc {
        max_depth: 4,
        photons: 0,
        caustic_photons: 4000,
        radius: Some(0.1),
        ..PhotonMappingDesc::default()
    };
    for alpha in [1.0, 0.25] {
        let desc = ball_in_a_beam(alpha);
        let found = caustic(&desc, &IntegratorDesc::PhotonMapping(photons), 4);
        let expected = caustic(&desc, &IntegratorDesc::LightTracing(LightTracingDesc { max_depth: 4 }), 16);
        welch_test(&found, &expected, 2).unwrap_or_else(|error| panic!("alpha {alpha}: {error}"));
        let without = caustic(&desc, &path(4), 4).mean;
        assert!(found.mean > 1.2 * without, "{} with the caustic, {without} without", found.mean);
    }
}

/// A view up to a ceiling, lit by a floor with the given alpha in the beam of a lamp.
fn ceiling_over_a_beam(alpha: f32) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.resolution = [8, 8];
    let screen = ScreenDesc { window: Some([-0.3, 0.3, -0.3, 0.3]), ..ScreenDesc::default() };
    desc.camera.kind = CameraKind::Orthographic { screen, lens: LensDesc::default() };
    let material = diffuse(&mut desc, 0.8);
    let ceiling = quad(v(-1.0, -1.0, 0.5), v(0.0, 2.0, 0.0), v(2.0, 0.0, 0.0));
    desc.shapes.push(ShapeDesc { material, ..ceiling.into() });
    let floor = quad(v(-2.0, -2.0, -0.5), v(4.0, 0.0, 0.0), v(0.0, 4.0, 0.0));
    desc.shapes.push(ShapeDesc { material, alpha: Some(alpha.into()), ..floor.into() });
    let beam = LightKind::Spot {
        intensity: SpectrumDesc::Constant(1.0),
        power: None,
        from: v(0.0, 0.0, 0.4),
        to: v(0.0, 0.0, -0.5),
        cone_angle: 30.0,
        cone_delta_angle: 10.0,
    };
    desc.lights.push(beam.into());
    desc
}

#[test]
fn a_final_gather_accounts_for_alpha() {
    let integrator = PhotonMappingDesc {
        max_depth: 2,
        photons: 1000,
        caustic_photons: 0,
        radius: Some(0.06),
        gather: 4,
        ..PhotonMappingDesc::default()
    };
    let integrator = IntegratorDesc::PhotonMapping(integrator);
    for alpha in [1.0, 0.5, 0.25] {
        let desc = ceiling_over_a_beam(alpha);
        let means = |integrator, passes| -> Moments {
            (0..16).map(|seed| mean(&luminances(&desc, integrator, seed, passes))).collect()
        };
        let (found, expected) = (means(&integrator, 16), means(&path(2), 64));
        welch_test(&found, &expected, 3).unwrap_or_else(|error| panic!("alpha {alpha}: {error}"));
    }
}

#[test]
fn displayed_photons_are_dots() {
    let mut desc = room();
    from_above(&mut desc, 1.0, 64);
    let show = PhotonMappingShow::Photons;
    let integrator = PhotonMappingDesc { photons: 60, show, ..PhotonMappingDesc::default() };
    let dots = luminances(&desc, &IntegratorDesc::PhotonMapping(integrator), 1, 1);
    let lit = dots.iter().filter(|&&value| value > 0.0).count();
    assert!((10..1500).contains(&lit), "{lit} of {} pixels are lit", dots.len());
    assert!(dots.iter().any(|&value| value > 0.05));
}

#[test]
fn no_lights_give_black_and_no_photons_give_direct_light() {
    let dark = SceneDesc { lights: Default::default(), ..ball_in_a_beam(1.0) };
    let none = PhotonMappingDesc { photons: 0, caustic_photons: 0, ..PhotonMappingDesc::default() };
    for gather in [0, 2] {
        for show in [PhotonMappingShow::Radiance, PhotonMappingShow::Photons] {
            let integrator = PhotonMappingDesc { gather, show, ..small(&PhotonMappingDesc::default()) };
            let picture = luminances(&dark, &IntegratorDesc::PhotonMapping(integrator), 1, 1);
            assert!(picture.iter().all(|&value| value == 0.0));
        }
        let integrator = PhotonMappingDesc { gather, ..none };
        let mut desc = room();
        from_above(&mut desc, 1.0, 16);
        let found = mean(&luminances(&desc, &IntegratorDesc::PhotonMapping(integrator), 1, 64));
        let expected = mean(&luminances(&desc, &path(1), 1, 64));
        assert!((found / expected - 1.0).abs() < 0.02, "{found} beside {expected}");
    }
}

#[test]
fn photons_are_in_the_summary_and_passes_can_be_cancelled() {
    let mut desc = room();
    from_above(&mut desc, 1.0, 16);
    desc.integrator = IntegratorDesc::PhotonMapping(small(&PhotonMappingDesc::default())).into();
    let (scene, view) = crate::support::viewed(&desc);
    let mut film = film::compile(&desc).unwrap().film;
    let mut integrator = build(&desc).unwrap().integrator;
    integrator.prepare(&scene, &view, &Control::default()).unwrap();
    let control = Control::default();
    integrator.pass(0, &scene, &view, &mut film, &control).unwrap();
    let summary = integrator.summary();
    assert!(summary[0].1.contains("in the global map") && summary[1].1.contains("on average"), "{summary:?}");
    control.cancel.store(true, std::sync::atomic::Ordering::Relaxed);
    assert!(integrator.pass(1, &scene, &view, &mut film, &control).is_err());
}
