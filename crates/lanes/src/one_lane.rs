//! One lane: `f32`, `u32` and `bool` themselves.

use crate::{Callee, Int, Mask, Real};

impl Real for f32 {
    const LANES: usize = 1;

    type Mask = bool;
    type Int = u32;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        x
    }

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        from[0]
    }

    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[0] = self;
    }

    #[inline(always)]
    fn gather_rows<const K: usize>(table: &[f32], index: u32) -> [Self; K] {
        *table[index as usize..].first_chunk().expect("an index inside of the table")
    }

    // Not `inline`, which would compile it in each codegen unit that calls it.
    fn call<C: Callee<Self>>(callee: C) -> C::Output {
        callee.run()
    }

    #[inline(always)]
    fn lane(self, _: usize) -> f32 {
        self
    }

    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f32::abs(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        f32::floor(self)
    }

    #[inline(always)]
    fn min(self, b: Self) -> Self {
        if self < b { self } else { b }
    }

    #[inline(always)]
    fn max(self, b: Self) -> Self {
        if self > b { self } else { b }
    }

    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        f32::mul_add(self, b, c)
    }

    #[inline(always)]
    fn lt(self, b: Self) -> bool {
        self < b
    }

    #[inline(always)]
    fn le(self, b: Self) -> bool {
        self <= b
    }

    #[inline(always)]
    fn eq(self, b: Self) -> bool {
        self == b
    }

    #[inline(always)]
    fn to_bits(self) -> u32 {
        f32::to_bits(self)
    }

    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        f32::from_bits(bits)
    }

    #[inline(always)]
    fn to_int(self) -> u32 {
        self as i32 as u32
    }
}

impl Int for u32 {
    type Real = f32;
    type Mask = bool;

    #[inline(always)]
    fn splat(x: u32) -> Self {
        x
    }

    #[inline(always)]
    fn load(from: &[u32]) -> Self {
        from[0]
    }

    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        to[0] = self;
    }

    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }

    #[inline(always)]
    fn wrapping_add(self, b: Self) -> Self {
        u32::wrapping_add(self, b)
    }

    #[inline(always)]
    fn wrapping_sub(self, b: Self) -> Self {
        u32::wrapping_sub(self, b)
    }

    #[inline(always)]
    fn wrapping_mul(self, b: Self) -> Self {
        u32::wrapping_mul(self, b)
    }

    #[inline(always)]
    fn mul_wide(self, b: Self) -> (Self, Self) {
        let product = u64::from(self) * u64::from(b);
        (product as u32, (product >> 32) as u32)
    }

    #[inline(always)]
    fn shl(self, bits: u32) -> Self {
        self << bits
    }

    #[inline(always)]
    fn shr(self, bits: u32) -> Self {
        self >> bits
    }

    #[inline(always)]
    fn eq(self, b: Self) -> bool {
        self == b
    }

    #[inline(always)]
    fn lt(self, b: Self) -> bool {
        self < b
    }

    #[inline(always)]
    fn to_real(self) -> f32 {
        self as i32 as f32
    }
}

impl Mask for bool {
    #[inline(always)]
    fn splat(x: bool) -> Self {
        x
    }

    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        bits & 1 == 1
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        self.into()
    }
}
