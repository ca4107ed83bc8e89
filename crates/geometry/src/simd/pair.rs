//! Two vectors that serve as one of twice the lanes.

use super::Vector;

/// The low half and the high half.
#[derive(Clone, Copy)]
pub(crate) struct Pair<V>(V, V);

impl<V: Copy> Pair<V> {
    #[inline(always)]
    fn zip(self, b: Self, f: impl Fn(V, V) -> V) -> Self {
        Self(f(self.0, b.0), f(self.1, b.1))
    }

    #[inline(always)]
    fn zip3(self, b: Self, c: Self, f: impl Fn(V, V, V) -> V) -> Self {
        Self(f(self.0, b.0, c.0), f(self.1, b.1, c.1))
    }
}

macro_rules! pair {
    ($half:literal, $whole:literal) => {
        impl<V: Vector<$half>> Vector<$whole> for Pair<V> {
            #[inline(always)]
            unsafe fn splat(x: f32) -> Self {
                // SAFETY: as the caller promises.
                let half = unsafe { V::splat(x) };
                Self(half, half)
            }
            #[inline(always)]
            unsafe fn load(from: &[f32; $whole]) -> Self {
                let half = |first: usize| -> [f32; $half] { std::array::from_fn(|i| from[first + i]) };
                // SAFETY: as the caller promises.
                unsafe { Self(V::load(&half(0)), V::load(&half($half))) }
            }
            #[inline(always)]
            fn store(self) -> [f32; $whole] {
                let (low, high) = (self.0.store(), self.1.store());
                std::array::from_fn(|i| if i < $half { low[i] } else { high[i - $half] })
            }
            #[inline(always)]
            fn add(self, b: Self) -> Self {
                self.zip(b, V::add)
            }
            #[inline(always)]
            fn sub(self, b: Self) -> Self {
                self.zip(b, V::sub)
            }
            #[inline(always)]
            fn mul(self, b: Self) -> Self {
                self.zip(b, V::mul)
            }
            #[inline(always)]
            fn div(self, b: Self) -> Self {
                self.zip(b, V::div)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self(self.0.abs(), self.1.abs())
            }
            #[inline(always)]
            fn min(self, b: Self) -> Self {
                self.zip(b, V::min)
            }
            #[inline(always)]
            fn max(self, b: Self) -> Self {
                self.zip(b, V::max)
            }
            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                self.zip3(b, c, V::mul_add)
            }
            #[inline(always)]
            fn neg_mul_add(self, b: Self, c: Self) -> Self {
                self.zip3(b, c, V::neg_mul_add)
            }
            #[inline(always)]
            fn mul_sub(self, b: Self, c: Self) -> Self {
                self.zip3(b, c, V::mul_sub)
            }
            #[inline(always)]
            fn mul_sub_loosely(self, b: Self, c: Self) -> Self {
                self.zip3(b, c, V::mul_sub_loosely)
            }
            #[inline(always)]
            fn le(self, b: Self) -> u32 {
                self.0.le(b.0) | self.1.le(b.1) << $half
            }
            #[inline(always)]
            fn lt(self, b: Self) -> u32 {
                self.0.lt(b.0) | self.1.lt(b.1) << $half
            }
        }
    };
}

pair!(4, 8);
pair!(8, 16);
