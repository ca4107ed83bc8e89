//! Adaptive supersampling: where pixels take more samples, and that the mean stays.

use alhazen_integrators::{Session, build};
use description::{Engine, IntegratorDesc, MaterialKind, PathDesc, SamplerKind, SceneDesc, ShapeDesc};
use testkit::{Moments, welch_test};

use crate::support::{at, emission, finished, sphere, v, white_sky};

/// A bright ball before a dimmer sky, which differ along the ball's edge alone.
fn ball(samples: u32, adaptive: Option<f32>) -> SceneDesc {
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    let material = Some(desc.materials.push(MaterialKind::Diffuse { reflectance: 0.0.into() }.into()));
    let area_light = emission(&mut desc, 0.25);
    desc.shapes.push(ShapeDesc { material, area_light, ..at(sphere(1.0), v(0.1, 0.2, 4.0)) });
    desc.film.resolution = [48, 48];
    desc.sampler.kind = SamplerKind::Independent { pixel_samples: samples };
    desc.integrator.value = IntegratorDesc::Path(PathDesc { max_depth: 0, ..PathDesc::default() });
    desc.options.adaptive = adaptive;
    desc.options.disable_wavelength_jitter = true;
    desc
}

fn rendered(desc: &SceneDesc) -> Session {
    finished(desc, build(desc).unwrap().integrator)
}

#[test]
fn pixels_take_more_samples_where_neighbours_differ() {
    for engine in [Engine::Wavefront, Engine::Scalar] {
        let mut desc = ball(64, Some(0.1));
        desc.options.engine = engine;
        let session = rendered(&desc);
        let film = &session.state().film;
        let picture = session.state().develop().unwrap();
        let brightness = |x: i32, y: i32| picture.rgb(x as u32, y as u32)[1];
        let (mut flat, mut edges) = (0, 0);
        for [x, y] in (1..47).flat_map(|y| (1..47).map(move |x| [x, y])) {
            let count = film.pixel_sample_count([x, y]);
            let around =
                [brightness(x - 1, y), brightness(x + 1, y), brightness(x, y - 1), brightness(x, y + 1)];
            let differs = around.iter().any(|&l| (l - brightness(x, y)).abs() > 0.2);
            assert!((4..=64).contains(&count), "{engine:?} {count}");
            assert!(!differs || count >= 32, "{engine:?} at {x}, {y}: {count} samples at the edge");
            if count == 64 { edges += 1 } else { flat += 1 }
        }
        assert!(edges > 50 && flat > 5 * edges, "{engine:?}: {edges} of {flat}");
    }
}

#[test]
fn the_mean_is_that_of_all_samples() {
    let mean = |seed: i32, adaptive| {
        let mut desc = ball(4, adaptive);
        desc.options.seed = seed;
        let picture = rendered(&desc).state().develop().unwrap();
        picture.values().map(f64::from).sum::<f64>() / (3.0 * 48.0 * 48.0)
    };
    let all: Moments = (0..48).map(|seed| mean(seed, None)).collect();
    let some: Moments = (1000..1048).map(|seed| mean(seed, Some(0.2))).collect();
    welch_test(&all, &some, 1).unwrap();
    assert!(all.variance_of_mean().sqrt() < 1e-3 * all.mean);
}

#[test]
fn any_division_of_passes_gives_the_same_bits() {
    let desc = ball(16, Some(0.3));
    let whole = rendered(&desc);
    let parts = [0..5, 5..16].map(|passes| {
        let mut session = crate::support::session(&desc, build(&desc).unwrap().integrator);
        session.run(passes, &Default::default(), &Default::default(), &mut |_| ()).unwrap();
        session.into_state().film
    });
    let [mut merged, other] = parts;
    merged.merge(&other).unwrap();
    let [a, b] = [merged.develop().unwrap(), whole.state().film.develop().unwrap()];
    assert!(a.values().eq(b.values()));
    let scalar = {
        let mut desc = desc.clone();
        desc.options.engine = Engine::Scalar;
        rendered(&desc)
    };
    assert_eq!(scalar.state().sample_count(), whole.state().sample_count());
}
