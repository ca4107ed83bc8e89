//! Metropolis light transport agrees with path tracing, does not depend on threads, and has
//! independent passes.

use std::sync::atomic::Ordering;

use alhazen_integrators::{Control, Integrator, PassError, build};
use description::{
    IntegratorDesc, LightKind, LightSamplerDesc, MltDesc, MltTechnique, Origin, PathDesc, SamplerDesc,
    SamplerKind, SceneDesc, ShapeDesc, Span, SpectrumDesc, Stated,
};
use film::Film;
use math::Vec3;
use scene::{Scene, View};
use testkit::{Moments, welch_test};

use crate::support::{
    at, diffuse, emission, finished, glass, mirror, quad, sphere, v, viewed, walls, white_sky,
};

const TECHNIQUES: [MltTechnique; 2] = [MltTechnique::Path, MltTechnique::Bdpt];

fn view(resolution: [i32; 2]) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.resolution = resolution;
    desc.film.save_fp16 = false;
    desc
}

fn mlt(technique: MltTechnique, max_depth: u32) -> MltDesc {
    MltDesc { technique, max_depth, mutations_per_pixel: 4, ..MltDesc::default() }
}

fn with(desc: &SceneDesc, integrator: IntegratorDesc, seed: i32) -> SceneDesc {
    let mut desc = SceneDesc { integrator: integrator.into(), ..desc.clone() };
    desc.sampler.value =
        SamplerDesc { kind: SamplerKind::Independent { pixel_samples: 64 }, seed: Some(seed) };
    desc
}

fn prepared(desc: &SceneDesc) -> ((Scene, View), Film, Box<dyn Integrator>) {
    (viewed(desc), film::compile(desc).unwrap().film, build(desc).unwrap().integrator)
}

fn picture(desc: &SceneDesc) -> Film {
    let film = finished(desc, build(desc).unwrap().integrator).into_state().film;
    assert_eq!(film.rejected().count, 0);
    film
}

fn bits(film: &Film) -> Vec<u32> {
    film.develop().unwrap().values().map(f32::to_bits).collect()
}

/// The mean luminance of the picture.
fn mean(desc: &SceneDesc) -> f64 {
    let image = picture(desc).develop().unwrap();
    let (width, height) = (image.width(), image.height());
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let luminance = pixels.map(|[x, y]| {
        let [r, g, b] = image.rgb(x, y).map(f64::from);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    });
    luminance.sum::<f64>() / f64::from(width * height)
}

fn floor(desc: &mut SceneDesc) {
    let material = diffuse(desc, 0.6);
    let floor = quad(v(-4.0, -1.0, 8.0), v(8.0, 0.0, 0.0), v(0.0, 0.0, -9.0));
    desc.shapes.push(ShapeDesc { material, ..floor.into() });
}

/// Grey walls, a lamp below the ceiling, a ball on the floor.
fn diffuse_box() -> SceneDesc {
    let mut desc = view([24, 24]);
    for (wall, rho) in walls(1.0).into_iter().zip([0.7, 0.3, 0.5, 0.8, 0.2, 0.6]) {
        let material = diffuse(&mut desc, rho);
        desc.shapes.push(ShapeDesc { material, ..wall.into() });
    }
    let area_light = emission(&mut desc, 5.0);
    let lamp = quad(v(-0.4, 0.9, 0.1), v(0.8, 0.0, 0.0), v(0.0, 0.0, 0.5));
    desc.shapes.push(ShapeDesc { area_light, ..lamp.into() });
    let material = diffuse(&mut desc, 0.4);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.25), v(0.3, -0.7, 0.6)) });
    desc
}

/// A glass ball between a lamp and the floor, beside a rough mirror.
fn caustic() -> SceneDesc {
    let mut desc = view([24, 16]);
    floor(&mut desc);
    let area_light = emission(&mut desc, 10.0);
    desc.shapes.push(ShapeDesc { area_light, ..at(sphere(0.7), v(-1.0, 3.0, 3.0)) });
    let material = glass(&mut desc);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.7), v(-0.5, -0.2, 3.0)) });
    let material = mirror(&mut desc, 0.2);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.7), v(1.1, -0.3, 3.2)) });
    desc
}

/// A sky and a sun over a ball.
fn sky() -> SceneDesc {
    let mut desc = view([24, 16]);
    floor(&mut desc);
    white_sky(&mut desc);
    let (from, to) = (v(1.0, 2.0, -1.0), Vec3::ZERO);
    let sun = LightKind::Distant { radiance: SpectrumDesc::Constant(2.0), illuminance: None, from, to };
    desc.lights.push(sun.into());
    let material = diffuse(&mut desc, 0.5);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.8), v(0.0, -0.2, 2.5)) });
    desc
}

#[test]
fn the_mean_agrees_with_path_tracing() {
    for (name, scene) in [("box", diffuse_box()), ("caustic", caustic()), ("sky", sky())] {
        let path = IntegratorDesc::VolPath(PathDesc {
            max_depth: 4,
            regularize: false,
            light_sampler: LightSamplerDesc::Bvh,
        });
        let path: Moments = (0..6).map(|seed| mean(&with(&scene, path.clone(), seed))).collect();
        for technique in TECHNIQUES {
            let desc = MltDesc { mutations_per_pixel: 40, ..mlt(technique, 4) };
            let desc = |seed| with(&scene, IntegratorDesc::Mlt(desc), seed);
            let found: Moments = (0..8).map(|seed| mean(&desc(seed))).collect();
            let error = found.variance_of_mean().sqrt() / path.mean;
            assert!(error < 0.015, "{name} {technique:?}: the error {error} is too large for a test");
            welch_test(&found, &path, 6).unwrap_or_else(|e| panic!("{name} {technique:?}: {e}"));
        }
    }
}

#[test]
fn long_paths_are_supported() {
    let scene = diffuse_box();
    let found = |max_depth| -> Moments {
        let desc = MltDesc { mutations_per_pixel: 40, ..mlt(MltTechnique::Bdpt, max_depth) };
        (0..8).map(|seed| mean(&with(&scene, IntegratorDesc::Mlt(desc), seed))).collect()
    };
    let expected = found(30);
    let error = expected.variance_of_mean().sqrt() / expected.mean;
    assert!(error < 0.015, "the error {error} is too large for a test");
    for max_depth in [1000, 70_000, 2_000_000_000] {
        welch_test(&found(max_depth), &expected, 3).unwrap_or_else(|e| panic!("depth {max_depth}: {e}"));
    }
}

#[test]
fn the_picture_does_not_depend_on_threads() {
    for technique in TECHNIQUES {
        let desc = with(&caustic(), IntegratorDesc::Mlt(mlt(technique, 5)), 1);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| bits(&picture(&desc)))
        };
        assert!(on(1) == on(5), "{technique:?}");
    }
}

#[test]
fn passes_are_independent() {
    for technique in TECHNIQUES {
        let desc = with(&caustic(), IntegratorDesc::Mlt(mlt(technique, 5)), 2);
        let ((scene, view), mut film, mut integrator) = prepared(&desc);
        integrator.prepare(&scene, &view, &Control::default()).unwrap();
        let mut parts = film.blank().unwrap();
        for pass in [0, 1, 2] {
            integrator.pass(pass, &scene, &view, &mut film, &Control::default()).unwrap();
        }
        for pass in [2, 0, 1] {
            let (_, mut part, mut integrator) = prepared(&desc);
            integrator.prepare(&scene, &view, &Control::default()).unwrap();
            integrator.pass(pass, &scene, &view, &mut part, &Control::default()).unwrap();
            parts.merge(&part).unwrap();
        }
        assert!(bits(&film) == bits(&parts), "{technique:?}");
    }
}

#[test]
fn chains_can_be_cancelled() {
    let desc = with(&caustic(), IntegratorDesc::Mlt(mlt(MltTechnique::Bdpt, 5)), 3);
    let ((scene, view), mut film, mut integrator) = prepared(&desc);
    integrator.prepare(&scene, &view, &Control::default()).unwrap();
    let control = Control::default();
    control.cancel.store(true, Ordering::Relaxed);
    assert_eq!(integrator.pass(0, &scene, &view, &mut film, &control), Err(PassError::Cancelled));
    assert!(film.develop().unwrap().values().all(|value| value == 0.0));
}

#[test]
fn a_scene_without_light_is_black() {
    let mut scene = view([8, 8]);
    floor(&mut scene);
    for technique in TECHNIQUES {
        assert_eq!(mean(&with(&scene, IntegratorDesc::Mlt(mlt(technique, 5)), 0)), 0.0);
    }
}

#[test]
fn invalid_settings_are_errors_at_their_parameter() {
    let names = ["bootstrapsamples", "chains", "mutationsperpixel", "largestepprobability", "sigma"];
    let spans = names.iter().enumerate().map(|(i, &name)| (name, Span { start: i as u32 + 1, ..Span::NONE }));
    let origin = Origin { span: Span::NONE, parameters: spans.collect() };
    let senseless = MltDesc {
        bootstrap_samples: 0,
        chains: 0,
        mutations_per_pixel: 0,
        large_step_probability: 1.5,
        sigma: f32::NAN,
        ..MltDesc::default()
    };
    let desc =
        SceneDesc { integrator: Stated::new(IntegratorDesc::Mlt(senseless), origin), ..SceneDesc::default() };
    let errors = build(&desc).err().unwrap();
    let mut found: Vec<_> = errors.iter().map(|error| (error.span().start, error.message.as_str())).collect();
    found.sort();
    assert_eq!(
        found,
        [
            (1, "`bootstrapsamples` is a whole number of 1 or more, not 0"),
            (2, "`chains` is a whole number of 1 or more, not 0"),
            (3, "`mutationsperpixel` is a whole number of 1 or more, not 0"),
            (4, "`largestepprobability` is a number from 0 to 1, not 1.5"),
            (5, "`sigma` is a number above 0, not NaN"),
        ]
    );
}
