// Translated from crates/scene/src/material/dispersion.rs
// by `cargo xtask wgsl`, which translates it again.

const dispersion_F: f32 = 486.134f;

const dispersion_D: f32 = 587.562f;

const dispersion_C: f32 = 656.281f;

// The index of refraction at a wavelength, of a glass of index `ior` at the d line.
fn cauchy(ior: f32, abbe_number: f32, lambda: f32) -> f32 {
    let f = 1.0f / sqr(dispersion_F);
    let d = 1.0f / sqr(dispersion_D);
    let c = 1.0f / sqr(dispersion_C);
    let scale_1 = (ior - 1.0f) / (abbe_number * (f - c));
    return ior + (scale_1 * ((1.0f / sqr(lambda)) - d));
}
