// Translated from crates/spectrum/src/sampled.rs
// by `cargo xtask wgsl`, which translates it again.

const sampled_N: u32 = 4;

const sampled_LAMBDA_MIN: f32 = 360.0f;

const sampled_LAMBDA_MAX: f32 = 830.0f;

// The same value at every wavelength.
fn SampledSpectrum_splat(value_1: f32) -> vec4f {
    return vec4f(value_1, value_1, value_1, value_1);
}

// Zero at every wavelength.
fn SampledSpectrum_zero() -> vec4f {
    return SampledSpectrum_splat(0.0f);
}

// `a` where the mask is true, else `b`.
fn SampledSpectrum_select(mask: bool, a: vec4f, b: vec4f) -> vec4f {
    let a_1 = a.x;
    let b_1 = a.y;
    let c = a.z;
    let d = a.w;
    let p = b.x;
    let q = b.y;
    let r = b.z;
    let s = b.w;
    return vec4f(select(p, a_1, mask), select(q, b_1, mask), select(r, c, mask), select(s, d, mask));
}

// The largest value.
fn SampledSpectrum_max_component(this_: vec4f) -> f32 {
    let a = this_.x;
    let b = this_.y;
    let c = this_.z;
    let d = this_.w;
    return real_max(d, real_max(c, real_max(b, real_max(a, -infinity()))));
}

// The larger of both at each wavelength.
fn SampledSpectrum_max(this_: vec4f, other: vec4f) -> vec4f {
    let a = this_.x;
    let b = this_.y;
    let c = this_.z;
    let d = this_.w;
    let p = other.x;
    let q = other.y;
    let r = other.z;
    let s = other.w;
    return vec4f(real_max(a, p), real_max(b, q), real_max(c, r), real_max(d, s));
}

// The mean of the values.
fn SampledSpectrum_average(this_: vec4f) -> f32 {
    let a = this_.x;
    let b = this_.y;
    let c = this_.z;
    let d = this_.w;
    return (((a + b) + c) + d) / f32(sampled_N);
}

// Whether every value is zero.
fn SampledSpectrum_is_black(this_: vec4f) -> bool {
    let v = this_.x;
    let v_1 = this_.y;
    let v_2 = this_.z;
    let v_3 = this_.w;
    let a = v == 0.0f;
    let b = v_1 == 0.0f;
    let c = v_2 == 0.0f;
    let d = v_3 == 0.0f;
    return ((a & b) & c) & d;
}

// Negative values become zero.
fn SampledSpectrum_clamp_zero(this_: vec4f) -> vec4f {
    let v = this_.x;
    let v_1 = this_.y;
    let v_2 = this_.z;
    let v_3 = this_.w;
    return vec4f(real_max(v, 0.0f), real_max(v_1, 0.0f), real_max(v_2, 0.0f), real_max(v_3, 0.0f));
}

// The quotient where the divisor is not zero, zero elsewhere.
fn SampledSpectrum_safe_div(this_: vec4f, divisor: vec4f) -> vec4f {
    let a = this_.x;
    let b = this_.y;
    let c = this_.z;
    let d = this_.w;
    let p = divisor.x;
    let q = divisor.y;
    let r = divisor.z;
    let s = divisor.w;
    return vec4f(select(a / p, 0.0f, p == 0.0f), select(b / q, 0.0f, q == 0.0f), select(c / r, 0.0f, r == 0.0f), select(d / s, 0.0f, s == 0.0f));
}

// (1 − t)·`self` + t·`other`.
fn SampledSpectrum_lerp(this_: vec4f, other: vec4f, t: f32) -> vec4f {
    return (this_ * (1.0f - t)) + (other * t);
}

// The wavelengths of a path, in nanometres, and their sampling densities, per nanometre.
struct SampledWavelengths {
    lambda: vec4f,
    pdf: vec4f,
}

// Wavelengths sampled uniformly over `min..max`, from `u` in [0, 1).
fn SampledWavelengths_sample_uniform_in(u: f32, min_1: f32, max_1: f32) -> SampledWavelengths {
    let parts = rotations(u);
    let u_1 = parts.x;
    let u_2 = parts.y;
    let u_3 = parts.z;
    let u_4 = parts.w;
    let lambda_0 = min_1 + (u_1 * (max_1 - min_1));
    let lambda_1 = min_1 + (u_2 * (max_1 - min_1));
    let lambda_2 = min_1 + (u_3 * (max_1 - min_1));
    let lambda_3 = min_1 + (u_4 * (max_1 - min_1));
    let element = 1.0f / (max_1 - min_1);
    return SampledWavelengths(vec4f(lambda_0, lambda_1, lambda_2, lambda_3), vec4f(element, element, element, element));
}

// Wavelengths sampled about in proportion to the eye's response, from `u` in [0, 1).
fn SampledWavelengths_sample_visible(u: f32) -> SampledWavelengths {
    var lambda = rotations(u);
    var pdf = vec4f(0.0f, 0.0f, 0.0f, 0.0f);
    for (var i = 0u; i < sampled_N; i++) {
        let tanh = visible_tanh(lambda[i]);
        lambda[i] = wavelength_of_tanh(tanh);
        pdf[i] = sampled_VISIBLE_PEAK * (1.0f - (tanh * tanh));
    }
    return SampledWavelengths(lambda, pdf);
}

// The wavelengths in nanometres.
fn SampledWavelengths_lambda(this_: SampledWavelengths) -> vec4f {
    return this_.lambda;
}

// Keeps only the first wavelength, for dispersion, and divides its density by N.
fn SampledWavelengths_terminate_secondary(this_: ptr<function, SampledWavelengths>) {
    let terminated = SampledWavelengths_secondary_terminated(*this_);
    let parts = (*this_).pdf;
    let hero = parts.x;
    (*this_).pdf = vec4f(0.0f, 0.0f, 0.0f, 0.0f);
    (*this_).pdf.x = select(hero / f32(sampled_N), hero, terminated);
}

// Whether the secondary wavelengths are terminated.
fn SampledWavelengths_secondary_terminated(this_: SampledWavelengths) -> bool {
    let parts = this_.pdf;
    let p = parts.x;
    let p_1 = parts.y;
    let p_2 = parts.z;
    let p_3 = parts.w;
    let a = p_1 == 0.0f;
    let b = p_2 == 0.0f;
    let c = p_3 == 0.0f;
    return (a & b) & c;
}

// `u` and its rotations by 1/4, 2/4 and 3/4 within [0, 1).
fn rotations(u: f32) -> vec4f {
    let rotated = u + 0.0f;
    let rotated_1 = u + 0.25f;
    let rotated_2 = u + 0.5f;
    let rotated_3 = u + 0.75f;
    return vec4f(select(rotated, rotated - 1.0f, rotated >= 1.0f), select(rotated_1, rotated_1 - 1.0f, rotated_1 >= 1.0f), select(rotated_2, rotated_2 - 1.0f, rotated_2 >= 1.0f), select(rotated_3, rotated_3 - 1.0f, rotated_3 >= 1.0f));
}

const sampled_VISIBLE_PEAK: f32 = 0.003939804f;

// tanh(0.0072 (538 − λ)) of the wavelength that `u` samples.
fn visible_tanh(u: f32) -> f32 {
    return 0.85691062f - (u * 1.827502f);
}

fn wavelength_of_tanh(tanh: f32) -> f32 {
    let log_1 = ln((1.0f + tanh) / (1.0f - tanh));
    return real_min(real_max(538.0f - (log_1 * 69.44444f), sampled_LAMBDA_MIN), sampled_LAMBDA_MAX);
}
