//! Vectors of floats, and the instruction sets that compute with them.
//!
//! What is written once for any [`Simd`] runs on each set of instructions; the best one that the
//! processor has is chosen once, by [`InstructionSet::detect`]. Every operation gives the same bits
//! on every set, fused multiplication and addition included, so that hits do not depend on the
//! machine. The one exception is [`Vector::mul_sub_loosely`], for bounds, which are conservative
//! anyway.
//!
//! Only what makes a vector is unsafe: who has a vector has the instructions that compute with it.

#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
mod pair;
mod scalar;
#[cfg(target_arch = "x86_64")]
mod sse2;

pub(crate) use scalar::Lanes;

/// `N` floats.
pub(crate) trait Vector<const N: usize>: Copy {
    /// The same number in all lanes.
    ///
    /// # Safety
    /// The processor must have the instructions of the set that the vector belongs to.
    unsafe fn splat(x: f32) -> Self;

    /// A number for each lane.
    ///
    /// # Safety
    /// The processor must have the instructions of the set that the vector belongs to.
    unsafe fn load(from: &[f32; N]) -> Self;

    fn store(self) -> [f32; N];

    fn add(self, b: Self) -> Self;
    fn sub(self, b: Self) -> Self;
    fn mul(self, b: Self) -> Self;
    fn div(self, b: Self) -> Self;
    /// Without the sign.
    fn abs(self) -> Self;
    /// The smaller; `b` beside a NaN.
    fn min(self, b: Self) -> Self;
    /// The larger; `b` beside a NaN.
    fn max(self, b: Self) -> Self;
    /// `self`·b + c, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// c − `self`·b, rounded once.
    fn neg_mul_add(self, b: Self, c: Self) -> Self;
    /// `self`·b − c, rounded once.
    fn mul_sub(self, b: Self, c: Self) -> Self;
    /// `self`·b − c, rounded once or twice.
    fn mul_sub_loosely(self, b: Self, c: Self) -> Self;
    /// A bit for each lane where `self` ≤ b; none where either is NaN.
    fn le(self, b: Self) -> u32;
    /// A bit for each lane where `self` < b; none where either is NaN.
    fn lt(self, b: Self) -> u32;
}

/// A set of instructions.
pub(crate) trait Simd: Copy {
    type Four: Vector<4>;
    type Eight: Vector<8>;
    type Sixteen: Vector<16>;

    /// Takes four lanes of eight: those that byte `BYTE` of each place names, of which three bits
    /// count.
    #[inline(always)]
    fn pick<const BYTE: usize>(from: Self::Eight, places: &[u32; 4]) -> Self::Four {
        let from = from.store();
        // SAFETY: who has vectors has the instructions.
        unsafe { Self::Four::load(&places.map(|place| from[(place >> (8 * BYTE)) as usize & 7])) }
    }

    /// Asks for the line of the cache around an address, which need not be one, soon to be read.
    #[inline(always)]
    fn prefetch(_: *const u8) {}
}

/// Asks for the line of the cache where a value begins, soon to be read, with what every processor
/// has.
#[inline(always)]
pub(crate) fn prefetch<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    type Least = sse2::Sse2;
    #[cfg(not(target_arch = "x86_64"))]
    type Least = scalar::Scalar;
    Least::prefetch(std::ptr::from_ref(value).cast());
}

/// The index of the first key that is the same as the one at an index, with what every processor
/// has.
#[inline(always)]
pub(crate) fn first_equal(keys: &[u32; 16], to: usize) -> usize {
    #[cfg(target_arch = "x86_64")]
    return sse2::first_equal(keys, to);
    #[cfg(not(target_arch = "x86_64"))]
    keys[..to].iter().position(|&key| key == keys[to]).unwrap_or(to)
}

/// Something that is written for all sets.
pub(crate) trait Task {
    type Output;

    /// Must be inlined, all the way down, to become code of the set.
    ///
    /// # Safety
    /// The processor must have the instructions of the set.
    unsafe fn run<S: Simd>(self) -> Self::Output;
}

/// A set of instructions that rays may be traced with. All find the same hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InstructionSet {
    /// Floats one by one, which every processor can do.
    Scalar,
    /// Four floats at once: x86-64.
    Sse2,
    /// Eight floats at once: x86-64 since 2013.
    Avx2,
    /// Sixteen floats at once: x86-64 with AVX-512.
    Avx512,
    /// Four floats at once: 64-bit Arm.
    Neon,
}

impl InstructionSet {
    /// All there are, the best first.
    pub const ALL: [Self; 5] = [Self::Avx512, Self::Avx2, Self::Neon, Self::Sse2, Self::Scalar];

    /// The best set of this processor.
    pub fn detect() -> Self {
        Self::ALL.into_iter().find(|set| set.is_available()).unwrap_or(Self::Scalar)
    }

    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Scalar => true,
            #[cfg(target_arch = "x86_64")]
            Self::Sse2 => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                Self::Avx2.is_available()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512bw")
            }
            #[cfg(target_arch = "aarch64")]
            Self::Neon => true,
            #[allow(unreachable_patterns)]
            _ => false,
        }
    }

    /// Runs a task with this set.
    ///
    /// # Safety
    /// The processor must have it.
    #[inline(always)]
    pub(crate) unsafe fn run<T: Task>(self, task: T) -> T::Output {
        // SAFETY: as the caller promises.
        unsafe {
            match self {
                #[cfg(target_arch = "x86_64")]
                Self::Avx512 => avx512::run(task),
                #[cfg(target_arch = "x86_64")]
                Self::Avx2 => avx2::run(task),
                #[cfg(target_arch = "x86_64")]
                Self::Sse2 => sse2::run(task),
                #[cfg(target_arch = "aarch64")]
                Self::Neon => neon::run(task),
                _ => scalar::run(task),
            }
        }
    }
}
