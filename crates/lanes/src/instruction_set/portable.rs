//! Four floats as an array: for processors whose instructions no other set knows. The compiler
//! makes vectors of it where it can.

use crate::pair::Pair;

instruction_set! {
    Portable, is_detected [];
    F32x4, Pair<F32x4>, Pair<Pair<F32x4>>;
    F32x4;
}

vector! {
    /// Four floats.
    F32x4([f32; 4]): Vector<4>;
    splat(x) = [x; 4];
    lane(a, lane) = a[lane];
    add(a, b) = each(|i| a[i] + b[i]);
    sub(a, b) = each(|i| a[i] - b[i]);
    mul(a, b) = each(|i| a[i] * b[i]);
    div(a, b) = each(|i| a[i] / b[i]);
    abs(a) = each(|i| a[i].abs());
    min(a, b) = each(|i| if a[i] < b[i] { a[i] } else { b[i] });
    max(a, b) = each(|i| if a[i] > b[i] { a[i] } else { b[i] });
    min_int(a, b) = each(|i| f32::from_bits((a[i].to_bits() as i32).min(b[i].to_bits() as i32) as u32));
    max_int(a, b) = each(|i| f32::from_bits((a[i].to_bits() as i32).max(b[i].to_bits() as i32) as u32));
    min_uint(a, b) = each(|i| f32::from_bits(a[i].to_bits().min(b[i].to_bits())));
    max_uint(a, b) = each(|i| f32::from_bits(a[i].to_bits().max(b[i].to_bits())));
    mul_add(a, b, c) = each(|i| a[i].mul_add(b[i], c[i]));
    neg_mul_add(a, b, c) = each(|i| (-a[i]).mul_add(b[i], c[i]));
    mul_sub(a, b, c) = each(|i| a[i].mul_add(b[i], -c[i]));
    relaxed_mul_sub(a, b, c) = each(|i| a[i] * b[i] - c[i]);
    -> u32:
    le(a, b) = (0..4).map(|i| u32::from(a[i] <= b[i]) << i).sum();
    lt(a, b) = (0..4).map(|i| u32::from(a[i] < b[i]) << i).sum();
}

real! {
    F32x4, U32x4, Mask4: 4;
    select(mask, a, b) = each(|i| if mask[i] { a[i] } else { b[i] });
    from_bits(bits) = each(|i| f32::from_bits(bits[i]));
    sqrt(a) = each(|i| a[i].sqrt());
    floor(a) = each(|i| a[i].floor());
    -> Mask:
    lt(a, b) = each(|i| a[i] < b[i]);
    le(a, b) = each(|i| a[i] <= b[i]);
    eq(a, b) = each(|i| a[i] == b[i]);
    -> Int:
    to_bits(a) = each(|i| a[i].to_bits());
    to_int(a) = each(|i| a[i] as i32 as u32);
}

int! {
    /// Four integers.
    U32x4([u32; 4]), F32x4, Mask4: 4;
    splat(x) = [x; 4];
    select(mask, a, b) = each(|i| if mask[i] { a[i] } else { b[i] });
    mul_wide(a, b) = (each(|i| a[i].mul_wide(b[i]).0), each(|i| a[i].mul_wide(b[i]).1));
    shl(a, bits) = each(|i| a[i] << bits);
    shr(a, bits) = each(|i| a[i] >> bits);
    to_real(a) = each(|i| a[i] as i32 as f32);
    wrapping_add(a, b) = each(|i| a[i].wrapping_add(b[i]));
    wrapping_sub(a, b) = each(|i| a[i].wrapping_sub(b[i]));
    wrapping_mul(a, b) = each(|i| a[i].wrapping_mul(b[i]));
    -> Mask:
    eq(a, b) = each(|i| a[i] == b[i]);
    lt(a, b) = each(|i| a[i] < b[i]);
    -> Self, as operators:
    BitAnd::bitand(a, b) = each(|i| a[i] & b[i]);
    BitOr::bitor(a, b) = each(|i| a[i] | b[i]);
    BitXor::bitxor(a, b) = each(|i| a[i] ^ b[i]);
}

mask! {
    /// Four bools.
    Mask4([bool; 4]): 4;
    splat(x) = [x; 4];
    from_bits(bits) = bools(bits);
    bits(a) = (0..4).map(|i| u32::from(a[i]) << i).sum();
    -> Self, as operators:
    BitAnd::bitand(a, b) = each(|i| a[i] & b[i]);
    BitOr::bitor(a, b) = each(|i| a[i] | b[i]);
    BitXor::bitxor(a, b) = each(|i| a[i] ^ b[i]);
}

/// What a function gives for each lane.
#[inline(always)]
fn each<T>(lane: impl Fn(usize) -> T) -> [T; 4] {
    std::array::from_fn(lane)
}

fn bools(bits: u32) -> [bool; 4] {
    each(|i| bits >> i & 1 == 1)
}
