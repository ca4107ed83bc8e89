// Translated from crates/spectrum/src/sampled.rs
// by `cargo xtask wgsl`, which translates it again.

const sampled_N: u32 = 4;

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
