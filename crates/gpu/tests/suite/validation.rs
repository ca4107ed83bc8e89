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
    for algorithm in algorithms {
        for bits in 0..32 {
            let [holes, images, noise, coats, principled] = [1, 2, 4, 8, 16].map(|bit| bits & bit != 0);
            let parts = Parts { holes, images, noise, coats, principled, padded_sobol: holes };
            let mut kernels = vec![shaders::pixels(&algorithm, parts)];
            if algorithm.splats().is_none() {
                kernels.push(shaders::surfaces(&algorithm, parts));
                kernels.extend([false, true].map(|has| shaders::light(&algorithm, parts, has)));
                kernels.extend(shaders::reservoirs(parts));
            }
            for source in &kernels {
                validate(source).unwrap_or_else(|error| panic!("{algorithm:?}: {error}"));
            }
        }
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
