// Translated from crates/scattering/src/bxdf/openpbr/film.rs
// by `cargo xtask wgsl`, which translates it again.

// A complex number.
struct Complex {
    re: f32,
    im: f32,
}

fn Complex_real(re: f32) -> Complex {
    return Complex(re, 0.0f);
}

fn Complex_norm2(this_: Complex) -> f32 {
    return sqr(this_.re) + sqr(this_.im);
}

// The root with no negative part, of a number with no negative imaginary part.
fn Complex_root(this_: Complex) -> Complex {
    let modulus = sqrt(Complex_norm2(this_));
    let re = sqrt(real_max(0.5f * (modulus + this_.re), 0.0f));
    let im = sqrt(real_max(0.5f * (modulus - this_.re), 0.0f));
    return Complex(re, im);
}

// e^{i self}.
fn Complex_exp_i(this_: Complex) -> Complex {
    let parts = sin_cos(this_.re);
    let sin_1 = parts.v0;
    let cos_1 = parts.v1;
    let scale_1 = exponential_exp(-this_.im);
    return Complex(scale_1 * cos_1, scale_1 * sin_1);
}

fn Complex_plus(this_: Complex, b: Complex) -> Complex {
    return Complex(this_.re + b.re, this_.im + b.im);
}

fn Complex_minus(this_: Complex, b: Complex) -> Complex {
    return Complex(this_.re - b.re, this_.im - b.im);
}

fn Complex_times(this_: Complex, b: Complex) -> Complex {
    return Complex((this_.re * b.re) - (this_.im * b.im), (this_.re * b.im) + (this_.im * b.re));
}

fn Complex_over(this_: Complex, b: Complex) -> Complex {
    let product_1 = Complex_times(this_, Complex(b.re, -b.im));
    return Complex(product_1.re / Complex_norm2(b), product_1.im / Complex_norm2(b));
}

// (a − b)/(a + b).
fn Complex_contrast(this_: Complex, b: Complex) -> Complex {
    return Complex_over(Complex_minus(this_, b), Complex_plus(this_, b));
}

// |r|² of both sides by their own r, with what a way through the film and back turns.
fn both_sides(first: Complex, second: Complex, turn_1: Complex) -> f32 {
    let again = Complex_times(second, turn_1);
    let ratio = Complex_over(Complex_plus(first, again), Complex_plus(Complex_real(1.0f), Complex_times(first, again)));
    return Complex_norm2(ratio);
}

// The reflectance of a film of index `film` and the optical thickness of `waves` wavelengths,
// n₁d/λ, between the indices `above` and `below`, for light from above with the cosine `cosine`.
fn film_reflectance(cosine: f32, above: f32, film: f32, below: Complex, waves: f32) -> f32 {
    let cosine_1 = real_max(cosine, 1e-3f);
    let across2 = Complex_real(sqr(above) * (1.0f - sqr(cosine_1)));
    let s0 = Complex_real(sqr(above));
    let s1 = Complex_real(sqr(film));
    let s2 = Complex_times(below, below);
    let q0 = Complex_real(above * cosine_1);
    let q1 = Complex_root(Complex_minus(s1, across2));
    let q2 = Complex_root(Complex_minus(s2, across2));
    let turn_1 = Complex_exp_i(Complex_times(q1, Complex_real(((4.0f * 3.1415927f) * waves) / film)));
    let perpendicular = both_sides(Complex_contrast(q0, q1), Complex_contrast(q1, q2), turn_1);
    let above_film = Complex_contrast(Complex_times(s1, q0), Complex_times(s0, q1));
    let below_film = Complex_contrast(Complex_times(s2, q1), Complex_times(s1, q2));
    let parallel = both_sides(above_film, below_film, turn_1);
    return real_min(real_max(0.5f * (perpendicular + parallel), 0.0f), 1.0f);
}
