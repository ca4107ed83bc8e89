// Translated from crates/spectrum/src/rgb_spectrum.rs
// by `cargo xtask wgsl`, which translates it again.

// A reflectance or transmittance, in [0, 1], one for each lane.
struct RgbAlbedoSpectrum {
    polynomial: RgbSigmoidPolynomial,
}

// The value at `lambda` nanometres.
fn RgbAlbedoSpectrum_at(this_: RgbAlbedoSpectrum, lambda: f32) -> f32 {
    return RgbSigmoidPolynomial_at(this_.polynomial, lambda);
}

// An unbounded quantity other than light, such as an absorption coefficient, one for each lane.
struct RgbUnboundedSpectrum {
    scale: f32,
    polynomial: RgbSigmoidPolynomial,
}

// The value at `lambda` nanometres.
fn RgbUnboundedSpectrum_at(this_: RgbUnboundedSpectrum, lambda: f32) -> f32 {
    return RgbSigmoidPolynomial_at(this_.polynomial, lambda) * this_.scale;
}
