//! AOVs of the film: every algorithm writes them, and they do not change the colours.

use alhazen_integrators::build;
use description::{
    IntegratorDesc, LightTracingDesc, MltDesc, PathDesc, RadiosityDesc, RandomWalkDesc, SamplerDesc,
    SamplerKind, SceneDesc, ShapeDesc, Span, Spanned, TransformDesc,
};
use film::{Film, Layer, id_of_name};
use image::{Format, Image, ReadOptions, WriteOptions, encode, read};
use math::{DMat4, DVec3};

use crate::support::{diffuse, finished, quad, v, white_sky};

const RESOLUTION: [u32; 2] = [24, 24];

/// A wall at distance 4 that moves to the right by half a unit while the shutter is open.
fn wall(integrator: IntegratorDesc, layers: &[Layer]) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION.map(|side| side as i32);
    desc.film.save_fp16 = false;
    desc.film.layers = layers.iter().map(|layer| Spanned::new(layer.name().into(), Span::NONE)).collect();
    desc.sampler.value = SamplerDesc { kind: SamplerKind::Independent { pixel_samples: 16 }, seed: Some(1) };
    desc.integrator.value = integrator;
    white_sky(&mut desc);
    let material = diffuse(&mut desc, 0.5);
    let world_from_object =
        TransformDesc { end: DMat4::from_translation(DVec3::new(0.5, 0.0, 0.0)), ..TransformDesc::default() };
    let wall = quad(v(-9.0, -9.0, 4.0), v(0.0, 18.0, 0.0), v(18.0, 0.0, 0.0));
    desc.shapes.push(ShapeDesc { material, world_from_object, ..wall.into() });
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
        let film = rendered(&wall(integrator.clone(), &Layer::ALL));
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
