// What translated laws use and WGSL has not.

// The bits of infinity. As a variable, because no constant may be infinite.
var<private> infinity_bits: u32 = 0x7f800000u;

fn infinity() -> f32 {
    return bitcast<f32>(infinity_bits);
}

fn not_a_number() -> f32 {
    return bitcast<f32>(infinity_bits | 0x400000u);
}

// The smaller of the two; `b` where either is NaN or both are zeros.
fn real_min(a: f32, b: f32) -> f32 {
    return select(b, a, a < b);
}

// The larger of the two; `b` where either is NaN or both are zeros.
fn real_max(a: f32, b: f32) -> f32 {
    return select(b, a, a > b);
}

// The magnitude of `x` with the sign of `sign`.
fn copysign(x: f32, sign: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) & 0x7fffffffu | bitcast<u32>(sign) & 0x80000000u);
}

// The nearest integer, as a float and as an integer in two's complement.
fn function_round(x: f32) -> Tuple_f32_u32 {
    let n = round(x);
    return Tuple_f32_u32(n, bitcast<u32>(i32(n)));
}

// An angle of 0 to 800 as a multiple of π/2 and a rest of at most π/4; larger angles lose digits.
fn circular_reduce(x: f32) -> Tuple_f32_u32 {
    let parts = function_round(x * 0.63661975f);
    let n = parts.v0;
    // π/2 in three parts, of which two have 15 bits, so that products with n are exact.
    let rest = (x - n * 1.5708008f) - n * -4.454516e-6f;
    return Tuple_f32_u32(rest - n * 6.0771006e-11f, parts.v1);
}
