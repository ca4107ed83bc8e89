// Translated from crates/math/src/balance.rs
// by `cargo xtask wgsl`, which translates it again.

// A power of two whose product with `x` ≥ 0 is from one to two; less for denormal numbers, and up
// to four for the largest ones. A product with it has the same digits.
fn balance(x: f32) -> f32 {
    let exponent = bitcast<u32>(real_min(x, 1.7e38f)) & 0x7f800000u;
    return bitcast<f32>(0x7f000000u - exponent);
}
