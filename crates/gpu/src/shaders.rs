//! The sources of the shaders. WGSL has no modules: a shader is the concatenation of texts, in any
//! order.

use crate::Algorithm;

/// What translated laws use and WGSL has not.
const PRELUDE: &str = include_str!("../shaders/prelude.wgsl");

/// Rays through the buffers of a [`Bvh`](crate::Bvh), for kernels that declare these.
pub const TRACE: &str = include_str!("../shaders/trace.wgsl");

/// The laws, translated from Rust by `cargo xtask wgsl`.
macro_rules! laws {
    ($($name:literal)*) => { [$(include_str!(concat!("../shaders/law/", $name, ".wgsl"))),*] };
}

const LAWS: [&str; 49] = laws! {
    "address" "arc" "bilerp" "checkerboard" "circular" "cluster" "conductor" "dielectric" "diffuse"
    "diffuse_transmission" "direct" "disk" "error" "exponential" "flags" "flat_shape" "float"
    "footprint" "frame" "fresnel" "function" "hash" "hash_sequence" "independent" "interval"
    "logarithm" "mapping" "microfacet" "minimum_differentials" "octahedral" "orthographic"
    "perspective" "phase" "power" "ray" "rectangle" "rgb_spectrum" "sample" "sampled" "scatter"
    "screen" "sphere" "spherical" "square" "thin_dielectric" "triangle" "tuples" "uplift" "vector"
};

/// Plumbing that all algorithms share.
macro_rules! plumbing {
    ($($name:literal)*) => { [$(include_str!(concat!("../shaders/", $name, ".wgsl"))),*] };
}

const PLUMBING: [&str; 12] = plumbing! {
    "scene" "trace" "distributions" "spectra" "textures" "surfaces" "footprints" "materials" "lights" "light_choices" "cameras" "pixels"
};

/// A shader: the laws, and what uses them.
pub fn with_laws(parts: &[&str]) -> String {
    let all = [PRELUDE].iter().chain(&LAWS).chain(parts);
    all.copied().collect::<Vec<_>>().join("\n")
}

/// The kernel that renders a sample of each pixel by an algorithm.
pub fn pixels(algorithm: &Algorithm) -> String {
    let rays = match algorithm {
        Algorithm::RayCasting => include_str!("../shaders/ray_casting.wgsl"),
        Algorithm::AmbientOcclusion(..) => include_str!("../shaders/ambient_occlusion.wgsl"),
        Algorithm::Path(_) => include_str!("../shaders/path.wgsl"),
    };
    let direct = include_str!("../shaders/direct.wgsl");
    with_laws(&[&PLUMBING[..], &[direct, rays]].concat())
}
