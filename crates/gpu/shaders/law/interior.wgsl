// Translated from crates/scattering/src/interior.rs
// by `cargo xtask wgsl`, which translates it again.

// The medium under a surface, for random walks.
struct Interior {
    sigma_s: vec4f,
    sigma_t: vec4f,
    phase: HenyeyGreenstein,
    eta: f32,
}
