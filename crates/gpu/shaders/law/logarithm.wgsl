// Translated from crates/lanes/src/function/logarithm.rs
// by `cargo xtask wgsl`, which translates it again.

// ln x, with an error below 0.9 ulp; −∞ for zeros, NaN below.
fn ln(x: f32) -> f32 {
    let parts = logarithmic_parts(x);
    let f = parts.v0;
    let n = parts.v1;
    let result = logarithm(f, n, 0.0f);
    return limits(x, x, result);
}

// log₂ x, with an error below 2 ulp; exact for powers of two, −∞ for zeros, NaN below.
fn logarithm_log2(x: f32) -> f32 {
    let parts = logarithmic_parts(x);
    let f = parts.v0;
    let n = parts.v1;
    let part = logarithm(f, 0.0f, 0.0f) * 1.442695f;
    return limits(x, x, n + part);
}

// ln(1 + f) + n ln 2 + rest for √½ ≤ 1 + f < √2 and a small rest.
fn logarithm(f: f32, n: f32, rest: f32) -> f32 {
    let z = f * f;
    let cubic = (f * z) * (((((((-8.114867e-2f * f + 0.13032317f) * f + -0.13088742f) * f + 0.14150462f) * f + -0.16626267f) * f + 0.20004311f) * f + -0.25000796f) * f + 0.33333275f);
    let small = (cubic + ((n * 1.4286068e-6f) + rest)) - (0.5f * z);
    return (n * 0.69314575f) + (f + small);
}

// The logarithm where it is finite; else that of zero, negative numbers, infinity and NaN. `x`
// and the argument of the logarithm differ by a constant.
fn limits(x: f32, argument: f32, logarithm_1: f32) -> f32 {
    let limit = select(not_a_number(), -infinity(), argument == 0.0f);
    let positive = select(x, logarithm_1, x < infinity());
    return select(limit, positive, argument > 0.0f);
}
