// Translated from crates/spectrum/src/uplift.rs
// by `cargo xtask wgsl`, which translates it again.

// A reflectance made from RGB, one for each lane: a sigmoid of a quadratic polynomial of
// wavelength.
struct RgbSigmoidPolynomial {
    coefficients: vec3f,
}

// The reflectance at `lambda` nanometres, in [0, 1].
fn RgbSigmoidPolynomial_at(this_: RgbSigmoidPolynomial, lambda: f32) -> f32 {
    let parts = this_.coefficients;
    let c0 = parts.x;
    let c1 = parts.y;
    let c2 = parts.z;
    let t = (lambda - 540.0f) / 100.0f;
    return sigmoid((((c0 * t) + c1) * t) + c2);
}

// s(x) = ½ + x / (2√(1 + x²)), right for infinite x too: beyond 10⁹ it is 0 or 1 to all digits.
fn sigmoid(x: f32) -> f32 {
    let x_1 = real_min(real_max(x, -1e9f), 1e9f);
    return 0.5f + (x_1 / (sqrt(1.0f + (x_1 * x_1)) * 2.0f));
}
