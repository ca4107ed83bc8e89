// Translated from crates/lanes/src/function/mod.rs
// by `cargo xtask wgsl`, which translates it again.

// x·2ⁿ for −252 ≤ n ≤ 254, rounded once.
fn scale(x: f32, n: u32) -> f32 {
    let half = ((n + 256u) >> 1) - 128u;
    return (x * power_of_two(half)) * power_of_two(n - half);
}

// 2ⁿ for −126 ≤ n ≤ 127.
fn power_of_two(n: u32) -> f32 {
    return bitcast<f32>((n + 127u) << 23);
}

// x > 0 as (1 + f)·2ⁿ with √½ ≤ 1 + f < √2: f, which is exact, and n.
fn logarithmic_parts(x: f32) -> Tuple_f32_f32 {
    let is_subnormal = x < 1.1754944e-38f;
    let scaled = select(x, x * 8388608.0f, is_subnormal);
    let bias = select(127u, u32(127 + 23), is_subnormal);
    let root = u32(bitcast<u32>(0.70710677f));
    let shifted = (bitcast<u32>(scaled) - root) + bitcast<u32>(1.0f);
    let mantissa = (shifted & 0x7fffffu) + root;
    return Tuple_f32_f32(bitcast<f32>(mantissa) - 1.0f, f32(bitcast<i32>(((shifted >> 23) - bias))));
}
