//! AOVs of the film: every algorithm writes them, and they do not change the colours.

use alhazen_integrators::build;
use description::{
    BdptDesc, Engine, FilmKind, InfiniteRadiance, IntegratorDesc, LightKind, LightTracingDesc, MltDesc,
    PathDesc, RadiosityDesc, RandomWalkDesc, SamplerDesc, SamplerKind, SceneDesc, ShapeDesc, ShapeKind, Span,
    Spanned, SpectrumDesc, TransformDesc,
};
use film::{Film, Layer, id_of_name};
use image::{Format, Image, ReadOptions, WriteOptions, encode, read};
use math::{DMat4, DVec3};
use spectrum::{CIE_Y_INTEGRAL, Spectrum};

use crate::support::{diffuse, finished, quad, v};

const RESOLUTION: [u32; 2] = [24, 24];

/// A wall at distance 4 that moves to the right by half a unit while the shutter is open.
fn wall(integrator: IntegratorDesc, layers: &[Layer]) -> SceneDesc {
    let wall = quad(v(-9.0, -9.0, 4.0), v(0.0, 18.0, 0.0), v(18.0, 0.0, 0.0));
    under_sky(integrator, layers, wall, SpectrumDesc::Constant(1.0))
}

/// A shape that moves so, under a sky of this light.
fn under_sky(
    integrator: IntegratorDesc,
    layers: &[Layer],
    shape: ShapeKind,
    light: SpectrumDesc,
) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION.map(|side| side as i32);
    desc.film.save_fp16 = false;
    desc.film.layers = layers.iter().map(|layer| Spanned::new(layer.name().into(), Span::NONE)).collect();
    desc.sampler.value = SamplerDesc { kind: SamplerKind::Independent { pixel_samples: 16 }, seed: Some(1) };
    desc.integrator.value = integrator;
    let radiance = InfiniteRadiance::Constant(light);
    desc.lights.push(LightKind::Infinite { radiance, illuminance: None, portal: None }.into());
    let material = diffuse(&mut desc, 0.5);
    let world_from_object =
        TransformDesc { end: DMat4::from_translation(DVec3::new(0.5, 0.0, 0.0)), ..TransformDesc::default() };
    desc.shapes.push(ShapeDesc { material, world_from_object, ..shape.into() });
    desc
}

fn rendered(desc: &SceneDesc) -> Film {
    finished(desc, build(desc).unwrap().integrator).into_state().film
}

fn written(film: &Film) -> Image {
    let bytes = encode(&film.development(), Format::Exr, &WriteOptions::default()).unwrap();
    read(&bytes, "", &ReadOptions::default()).unwrap()
}

#[test]
fn every_algorithm_writes_aovs_without_changing_colours() {
    let path = PathDesc { max_depth: 2, ..PathDesc::default() };
    for integrator in [
        IntegratorDesc::Path(path),
        IntegratorDesc::RandomWalk(RandomWalkDesc { max_depth: 2 }),
        IntegratorDesc::LightTracing(LightTracingDesc { max_depth: 2 }),
        IntegratorDesc::Mlt(MltDesc { mutations_per_pixel: 16, ..MltDesc::default() }),
        IntegratorDesc::Radiosity(RadiosityDesc::default()),
    ] {
        let name = format!("{integrator:?}");
        let layers: Vec<_> = Layer::ALL.into_iter().filter(|layer| !layer.is_part()).collect();
        let film = rendered(&wall(integrator.clone(), &layers));
        let colors = |film: &Film| film.develop().unwrap().values().map(f32::to_bits).collect::<Vec<_>>();
        assert!(colors(&film) == colors(&rendered(&wall(integrator, &[]))), "{name}");

        let image = written(&film);
        let at = |channel: &str| image.channel(12, 7, image.channel_index(channel).unwrap());
        let near = |channel: &str, expected: f32, tolerance: f32| {
            let value = at(channel);
            assert!((value - expected).abs() <= tolerance, "{name}: {channel} is {value}, not {expected}");
        };
        near("A", 1.0, 0.0);
        near("Z", 4.0, 1e-5);
        near("N.X", 0.0, 1e-6);
        near("N.Y", 0.0, 1e-6);
        near("N.Z", -1.0, 1e-6);
        // The centre of pixel 12 of 24 is 1/24 to the right of the middle, at distance 1.
        near("P.X", 4.0 / 24.0, 0.2);
        near("P.Z", 4.0, 1e-5);
        near("Pcam.Z", 4.0, 1e-5);
        near("Ncam.Z", -1.0, 1e-6);
        assert!((0.0..=1.0).contains(&at("uv.U")) && (0.0..=1.0).contains(&at("uv.V")), "{name}");
        // 24 pixels see 8 units.
        near("motion.X", 1.5, 1e-3);
        near("motion.Y", 0.0, 1e-3);
        assert!(at("samples") >= 1.0, "{name}");
        assert_eq!(at("CryptoObject00.r").to_bits(), id_of_name("shape-0"), "{name}");
        assert_eq!(at("CryptoMaterial00.r").to_bits(), id_of_name("material-0"), "{name}");
        near("CryptoObject00.g", 1.0, 0.0);
        near("CryptoObject00.a", 0.0, 0.0);
        // The mean over all pixels; a single pixel has the noise of its wavelengths.
        let albedo = |c| {
            let values = (0..24 * 24).map(|i| image.channel(i % 24, i / 24, c));
            values.map(f64::from).sum::<f64>() / f64::from(24 * 24)
        };
        let green = albedo(image.channel_index("albedo.G").unwrap());
        assert!((green - 0.5).abs() < 0.05, "{name}: albedo {green}");
    }
}

#[test]
fn slopes_are_those_of_the_surface_over_the_footprint_of_a_sample() {
    let layers = [Layer::Slope, Layer::CameraSlope, Layer::CameraGeometricNormal];
    // The plane z = 4 + x/2, which hardly moves. At the direction (k, 0, 1) its z is 4/(1 − k/2).
    let tilted = quad(v(-6.0, -9.0, 1.0), v(0.0, 18.0, 0.0), v(12.0, 0.0, 6.0));
    let path = IntegratorDesc::Path(PathDesc::default());
    let mut desc = under_sky(path, &layers, tilted, SpectrumDesc::Constant(1.0));
    desc.camera.shutter_open = 0.0;
    desc.camera.shutter_close = 1e-3;
    for engine in [Engine::Wavefront, Engine::Scalar] {
        desc.options.engine = engine;
        let image = written(&rendered(&desc));
        let at = |channel: &str| image.channel(12, 7, image.channel_index(channel).unwrap());
        // 24 pixels see 2 units at distance 1, and the footprint of 16 samples is a quarter wide.
        let k = 0.5_f32 / 12.0;
        let expected = 2.0 / (1.0 - 0.5 * k).powi(2) / 12.0 / 4.0;
        for channel in ["slope.X", "slopecam.X"] {
            assert!((at(channel) / expected - 1.0).abs() < 0.05, "{channel}: {}", at(channel));
        }
        assert!(at("slope.Y") < 1e-5 && at("slopecam.Y") < 1e-5);
        let normal = ["Ngcam.X", "Ngcam.Y", "Ngcam.Z"].map(at);
        let known = [0.2_f32.sqrt(), 0.0, -0.8_f32.sqrt()];
        assert!((0..3).all(|i| (normal[i] - known[i]).abs() < 1e-5), "{normal:?}");
    }
}

#[test]
fn every_algorithm_fills_the_buckets_of_a_spectral_film() {
    let path = PathDesc { max_depth: 2, ..PathDesc::default() };
    let light = [(400.0, 1.0), (500.0, 3.0), (520.0, 0.5), (700.0, 2.0)];
    // Half of the mean of each bucket, by the rectangle rule; the light has luminance 1.
    let spectrum = Spectrum::from_pairs(&light).unwrap();
    let scale = 0.5 * CIE_Y_INTEGRAL / spectrum.to_photometric();
    let mean = |bucket: u32| {
        let at = |i: u32| spectrum.at(400.0 + 75.0 * (bucket as f32 + (i as f32 + 0.5) / 1000.0));
        scale * (0..1000).map(at).sum::<f32>() / 1000.0
    };
    for (integrator, engine, tolerance) in [
        (IntegratorDesc::Path(path), Engine::Wavefront, 0.03),
        (IntegratorDesc::Path(path), Engine::Scalar, 0.03),
        (IntegratorDesc::Bdpt(BdptDesc { max_depth: 2, ..BdptDesc::default() }), Engine::Scalar, 0.03),
        (IntegratorDesc::LightTracing(LightTracingDesc { max_depth: 2 }), Engine::Scalar, 0.2),
        (
            IntegratorDesc::Mlt(MltDesc { mutations_per_pixel: 64, max_depth: 2, ..MltDesc::default() }),
            Engine::Scalar,
            0.05,
        ),
        (IntegratorDesc::Radiosity(RadiosityDesc::default()), Engine::Scalar, 0.06),
    ] {
        let name = format!("{integrator:?} {engine:?}");
        let wall = quad(v(-9.0, -9.0, 4.0), v(0.0, 18.0, 0.0), v(18.0, 0.0, 0.0));
        let mut desc = under_sky(integrator, &[], wall, SpectrumDesc::Samples(light.to_vec().into()));
        desc.film.kind = FilmKind::Spectral { buckets: 4, lambda_min: 400.0, lambda_max: 700.0 };
        desc.options.engine = engine;
        let image = written(&rendered(&desc));
        let names = image.channels().iter().filter(|name| name.starts_with("S0."));
        let found: Vec<f32> = names
            .map(|name| {
                let channel = image.channel_index(name).unwrap();
                let values = (0..24 * 24).map(|i| image.channel(i % 24, i / 24, channel));
                values.sum::<f32>() / (24.0 * 24.0)
            })
            .collect();
        assert_eq!(found.len(), 4);
        for (bucket, found) in (0..4).zip(&found) {
            let expected = mean(bucket);
            assert!(
                (found / expected - 1.0).abs() < tolerance,
                "{name}: bucket {bucket} is {found}, not {expected}"
            );
        }
    }
}
