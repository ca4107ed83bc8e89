// Translated from crates/lanes/src/function/exponential.rs
// by `cargo xtask wgsl`, which translates it again.

// eˣ, with an error below 1.1 ulp.
fn exponential_exp(x: f32) -> f32 {
    let parts = exponential_reduce(real_min(89.0f, real_max(-104.0f, x)));
    let n = parts.v0;
    let power_m1 = parts.v1;
    return scale(1.0f + power_m1, n);
}

// An integer n and p = e^(x − n ln 2) − 1 with |x − n ln 2| ≤ ln 2 / 2.
fn exponential_reduce(x: f32) -> Tuple_u32_f32 {
    let parts = function_round(x * 1.442695f);
    let n = parts.v0;
    let integer = parts.v1;
    let r = (x - (n * 0.69314575f)) - (n * 1.4286068e-6f);
    return Tuple_u32_f32(integer, r + ((r * r) * ((((1.3864287e-3f * r + 8.366556e-3f) * r + 4.1667506e-2f) * r + 0.16666543f) * r + 0.49999997f)));
}
