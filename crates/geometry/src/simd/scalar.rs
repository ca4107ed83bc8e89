//! Arrays: what the other sets are measured against.

use super::{Simd, Task, Vector};

/// Floats one by one.
#[derive(Clone, Copy)]
pub(crate) struct Scalar;

impl Simd for Scalar {
    type Four = Lanes<4>;
    type Eight = Lanes<8>;
    type Sixteen = Lanes<16>;
}

/// Runs a task.
pub fn run<T: Task>(task: T) -> T::Output {
    // SAFETY: every processor computes with floats.
    unsafe { task.run::<Scalar>() }
}

/// `N` floats.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<const N: usize>(pub [f32; N]);

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn zip(self, b: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], b.0[i])))
    }

    #[inline(always)]
    fn zip3(self, b: Self, c: Self, f: impl Fn(f32, f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], b.0[i], c.0[i])))
    }

    #[inline(always)]
    fn bits(self, b: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        (0..N).fold(0, |bits, i| bits | (f(self.0[i], b.0[i]) as u32) << i)
    }
}

impl<const N: usize> Vector<N> for Lanes<N> {
    #[inline(always)]
    unsafe fn splat(x: f32) -> Self {
        Self([x; N])
    }
    #[inline(always)]
    unsafe fn load(from: &[f32; N]) -> Self {
        Self(*from)
    }
    #[inline(always)]
    fn store(self) -> [f32; N] {
        self.0
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        self.zip(b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self.zip(b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        self.zip(b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        self.zip(b, |a, b| a / b)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        self.zip(b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        self.zip(b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        self.zip3(b, c, |a, b, c| a.mul_add(b, c))
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        self.zip3(b, c, |a, b, c| (-a).mul_add(b, c))
    }
    #[inline(always)]
    fn mul_sub(self, b: Self, c: Self) -> Self {
        self.zip3(b, c, |a, b, c| a.mul_add(b, -c))
    }
    #[inline(always)]
    fn mul_sub_loosely(self, b: Self, c: Self) -> Self {
        self.zip3(b, c, |a, b, c| a * b - c)
    }
    #[inline(always)]
    fn le(self, b: Self) -> u32 {
        self.bits(b, |a, b| a <= b)
    }
    #[inline(always)]
    fn lt(self, b: Self) -> u32 {
        self.bits(b, |a, b| a < b)
    }
}
