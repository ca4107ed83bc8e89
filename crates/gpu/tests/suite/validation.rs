//! Every shader is valid WGSL. Needs no GPU.

use std::collections::BTreeSet;
use std::fmt::Debug;

use alhazen_gpu::Algorithm;
use alhazen_gpu::shaders::{self, Parts};
use rayon::prelude::*;
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

/// Parts, of which there are those whose bits are set.
fn parts(bits: u32) -> Parts {
    let [holes, images, noise, coats, principled, rare_samplers] =
        [0, 1, 2, 3, 4, 5].map(|i| bits >> i & 1 == 1);
    Parts { holes, images, noise, coats, principled, rare_samplers }
}

/// No parts, all of them, and others so that each two parts are there together, each without the
/// other, and neither: of the last four each part is in another two.
const PAIRS: [u32; 6] = [0b000000, 0b111111, 0b000111, 0b011001, 0b101010, 0b110100];

#[test]
fn each_two_parts_are_there_in_all_ways() {
    for (a, b) in (0..6).flat_map(|a| (0..a).map(move |b| (a, b))) {
        let ways: BTreeSet<u32> = PAIRS.iter().map(|bits| 2 * (bits >> a & 1) + (bits >> b & 1)).collect();
        assert_eq!(ways.len(), 4, "{a} {b}");
    }
}

#[test]
fn kernels_are_valid() {
    let occlusion = Algorithm::AmbientOcclusion(Default::default(), RgbColorSpace::srgb());
    let path = Algorithm::Path(Default::default());
    let algorithms = [
        Algorithm::RayCasting,
        Algorithm::Whitted(Default::default()),
        occlusion,
        path.clone(),
        Algorithm::LightTracing(Default::default()),
        Algorithm::Bdpt(Default::default()),
    ];
    // What depends on parts is shared by all kernels; one has them in all ways.
    let all = (0..1 << 6).map(parts);
    let mut sources: Vec<_> =
        all.map(|parts| (format!("{parts:?}"), shaders::pixels(&path, parts))).collect();
    for parts in PAIRS.map(parts) {
        let mut add = |name: &dyn Debug, source| sources.push((format!("{name:?}, {parts:?}"), source));
        for algorithm in &algorithms {
            add(algorithm, shaders::pixels(algorithm, parts));
            if algorithm.splats().is_none() {
                add(algorithm, shaders::surfaces(algorithm, parts));
                add(algorithm, shaders::light(algorithm, parts, false));
            }
        }
        add(&"other light", shaders::light(&path, parts, true));
        shaders::reservoirs(parts).into_iter().for_each(|source| add(&"reservoirs", source));
    }
    let error =
        |(name, source): &(String, String)| validate(source).err().map(|error| format!("{name}: {error}"));
    assert_eq!(sources.par_iter().find_map_any(error), None);
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
fn kernels_of_moving_spheres_are_valid() {
    let tree = shaders::tree().map(|(_, source)| source);
    for source in shaders::sort().into_iter().chain(tree).chain([shaders::place()]) {
        validate(&source).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn what_is_wrong_is_found() {
    assert!(validate("fn f() -> f32 { return 1u; }").is_err());
}
