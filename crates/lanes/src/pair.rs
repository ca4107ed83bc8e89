//! Two vectors that serve as one of twice the lanes.

use crate::simd::Vector;

/// The low half and the high half.
#[derive(Clone, Copy)]
pub struct Pair<V>(V, V);

/// Implements [`Vector`] of `$n` lanes for pairs of vectors of `$half` lanes.
macro_rules! pair {
    ($half:literal, $n:literal) => {
        pair! {
            $half, $n;
            add(b) sub(b) mul(b) div(b) abs() min(b) max(b) min_int(b) max_int(b) min_uint(b) max_uint(b)
            mul_add(b, c) neg_mul_add(b, c) mul_sub(b, c) relaxed_mul_sub(b, c);
            le lt
        }
    };
    ($half:literal, $n:literal; $($operation:ident($($b:ident),*))*; $($comparison:ident)*) => {
        impl<V: Vector<$half>> Vector<$n> for Pair<V> {
            #[inline(always)]
            unsafe fn splat(x: f32) -> Self {
                // SAFETY: as the caller promises.
                let half = unsafe { V::splat(x) };
                Self(half, half)
            }

            #[inline(always)]
            unsafe fn load(from: &[f32; $n]) -> Self {
                let (mut low, mut high) = ([0.0; $half], [0.0; $half]);
                low.copy_from_slice(&from[..$half]);
                high.copy_from_slice(&from[$half..]);
                // SAFETY: as the caller promises.
                unsafe { Self(V::load(&low), V::load(&high)) }
            }

            #[inline(always)]
            fn store(self) -> [f32; $n] {
                let mut all = [0.0; $n];
                all[..$half].copy_from_slice(&self.0.store());
                all[$half..].copy_from_slice(&self.1.store());
                all
            }

            #[inline(always)]
            fn lane(self, lane: usize) -> f32 {
                self.store()[lane]
            }

            $(
                #[inline(always)]
                fn $operation(self $(, $b: Self)*) -> Self {
                    Self(self.0.$operation($($b.0),*), self.1.$operation($($b.1),*))
                }
            )*

            $(
                #[inline(always)]
                fn $comparison(self, b: Self) -> u32 {
                    self.0.$comparison(b.0) | self.1.$comparison(b.1) << $half
                }
            )*
        }
    };
}

pair!(1, 2);
pair!(2, 4);
pair!(4, 8);
pair!(8, 16);
