//! One float at a time: the fallback of every architecture, and the reference for other sets.

use crate::pair::Pair;

type F32x2 = Pair<F32x1>;
/// Four floats.
pub type F32x4 = Pair<F32x2>;

instruction_set! {
    Scalar, is_detected [];
    F32x4, Pair<F32x4>, Pair<Pair<F32x4>>;
    f32;
}

vector! {
    /// A single float, which every processor computes with.
    F32x1(f32): Vector<1>;
    splat(x) = x;
    lane(a, lane) = [a][lane];
    add(a, b) = a + b;
    sub(a, b) = a - b;
    mul(a, b) = a * b;
    div(a, b) = a / b;
    abs(a) = a.abs();
    min(a, b) = if a < b { a } else { b };
    max(a, b) = if a > b { a } else { b };
    min_int(a, b) = if (a.to_bits() as i32) < b.to_bits() as i32 { a } else { b };
    min_uint(a, b) = if a.to_bits() < b.to_bits() { a } else { b };
    max_int(a, b) = if a.to_bits() as i32 > b.to_bits() as i32 { a } else { b };
    max_uint(a, b) = if a.to_bits() > b.to_bits() { a } else { b };
    mul_add(a, b, c) = a.mul_add(b, c);
    neg_mul_add(a, b, c) = (-a).mul_add(b, c);
    mul_sub(a, b, c) = a.mul_add(b, -c);
    relaxed_mul_sub(a, b, c) = a * b - c;
    -> u32:
    le(a, b) = (a <= b) as u32;
    lt(a, b) = (a < b) as u32;
}
