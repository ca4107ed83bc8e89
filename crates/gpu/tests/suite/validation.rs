//! Every shader is valid WGSL. Needs no GPU.

use alhazen_gpu::Algorithm;
use alhazen_gpu::shaders::{self, Parts};
use spectrum::RgbColorSpace;
use wgpu::naga::front::wgsl;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

fn validate(source: &str) -> Result<(), String> {
    let module = wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).map(|_| ()).map_err(|error| error.emit_to_string(source))
}

#[test]
fn all_laws_are_valid() {
    validate(&shaders::with_laws(&[])).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn shaders_have_all_laws() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/law");
    let all = shaders::with_laws(&[&shaders::principled()]);
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        assert!(all.contains(&std::fs::read_to_string(&path).unwrap()), "{}", path.display());
    }
}

#[test]
fn traversal_is_valid() {
    let source = format!("{}{}", shaders::TRACE, crate::trace::KERNEL);
    validate(&source).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn kernels_are_valid() {
    let occlusion = Algorithm::AmbientOcclusion(Default::default(), RgbColorSpace::srgb());
    let algorithms = [
        Algorithm::RayCasting,
        Algorithm::Whitted(Default::default()),
        occlusion,
        Algorithm::Path(Default::default()),
        Algorithm::LightTracing(Default::default()),
        Algorithm::Bdpt(Default::default()),
    ];
    // All parts but principled surfaces are constants of one text, whose branches are all
    // validated.
    for [has, principled] in [[false, false], [false, true], [true, false], [true, true]] {
        let parts = Parts { holes: has, images: has, noise: has, coats: has, principled, rare_samplers: has };
        let valid = |name: &str, source: &str| {
            validate(source).unwrap_or_else(|error| panic!("{name}, {parts:?}: {error}"));
        };
        for algorithm in &algorithms {
            let name = format!("{algorithm:?}");
            valid(&name, &shaders::pixels(algorithm, parts));
            if algorithm.splats().is_none() {
                valid(&name, &shaders::surfaces(algorithm, parts));
                valid(&name, &shaders::light(algorithm, parts, false));
            }
        }
        let path = Algorithm::Path(Default::default());
        valid("other light", &shaders::light(&path, parts, true));
        shaders::reservoirs(parts).iter().for_each(|source| valid("reservoirs", source));
    }
}

#[test]
fn shaders_of_the_raster_pipeline_are_valid() {
    validate(&shaders::raster()).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn kernels_of_frames_are_valid() {
    for source in shaders::filters() {
        validate(&source).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn what_is_wrong_is_found() {
    assert!(validate("fn f() -> f32 { return 1u; }").is_err());
}
