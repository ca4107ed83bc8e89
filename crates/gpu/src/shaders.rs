//! The sources of the shaders. WGSL has no modules: a shader is the concatenation of texts, in any
//! order.

/// What translated laws use and WGSL has not.
const PRELUDE: &str = include_str!("../shaders/prelude.wgsl");

/// Rays through the buffers of a [`Bvh`](crate::Bvh), for kernels that declare these.
pub const TRACE: &str = include_str!("../shaders/trace.wgsl");

/// The laws, translated from Rust by `cargo xtask wgsl`.
macro_rules! laws {
    ($($name:literal)*) => { [$(include_str!(concat!("../shaders/law/", $name, ".wgsl"))),*] };
}

const LAWS: [&str; 36] = laws! {
    "address" "arc" "circular" "conductor" "dielectric" "diffuse" "diffuse_transmission" "disk" "error"
    "exponential" "flags" "float" "frame" "fresnel" "function" "hash" "hash_sequence" "independent"
    "interval" "logarithm" "microfacet" "octahedral" "phase" "ray" "rectangle" "rgb_spectrum" "sampled"
    "scatter" "sphere" "spherical" "square" "thin_dielectric" "triangle" "tuples" "uplift" "vector"
};

/// A shader: the laws, and what uses them.
pub fn with_laws(parts: &[&str]) -> String {
    let all = [PRELUDE].iter().chain(&LAWS).chain(parts);
    all.copied().collect::<Vec<_>>().join("\n")
}
