//! Integers of 64 bits as pairs of 32-bit integers.

use crate::Int;
use std::ops::{BitXor, Shl, Shr};

/// A 64-bit integer for each lane, unsigned. Arithmetic wraps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wide<I> {
    /// The integer modulo 2³².
    pub low: I,
    /// The integer divided by 2³².
    pub high: I,
}

impl<I: Int> Wide<I> {
    /// The same integer in all lanes.
    #[inline(always)]
    pub fn splat(x: u64) -> Self {
        Self { low: I::splat(x as u32), high: I::splat((x >> 32) as u32) }
    }

    /// The sum modulo 2⁶⁴.
    #[inline(always)]
    pub fn wrapping_add(self, b: Self) -> Self {
        let low = self.low.wrapping_add(b.low);
        let carry = I::select(low.lt(b.low), I::splat(1), I::splat(0));
        Self { low, high: self.high.wrapping_add(b.high).wrapping_add(carry) }
    }

    /// The product modulo 2⁶⁴.
    #[inline(always)]
    pub fn wrapping_mul(self, b: Self) -> Self {
        let (low, carry) = self.low.mul_wide(b.low);
        let cross = self.low.wrapping_mul(b.high).wrapping_add(self.high.wrapping_mul(b.low));
        Self { low, high: carry.wrapping_add(cross) }
    }
}

/// Shifted left by less than 64 bits.
impl<I: Int> Shl<u32> for Wide<I> {
    type Output = Self;

    #[inline(always)]
    fn shl(self, bits: u32) -> Self {
        match bits {
            0 => self,
            1..32 => Self { low: self.low.shl(bits), high: self.high.shl(bits) | self.low.shr(32 - bits) },
            _ => Self { low: I::splat(0), high: self.low.shl(bits - 32) },
        }
    }
}

/// Shifted right by less than 64 bits; zeros come in.
impl<I: Int> Shr<u32> for Wide<I> {
    type Output = Self;

    #[inline(always)]
    fn shr(self, bits: u32) -> Self {
        match bits {
            0 => self,
            1..32 => Self { low: self.low.shr(bits) | self.high.shl(32 - bits), high: self.high.shr(bits) },
            _ => Self { low: self.high.shr(bits - 32), high: I::splat(0) },
        }
    }
}

impl<I: Int> BitXor for Wide<I> {
    type Output = Self;

    #[inline(always)]
    fn bitxor(self, b: Self) -> Self {
        Self { low: self.low ^ b.low, high: self.high ^ b.high }
    }
}
