//! What every instruction set offers, and macros that implement it from a table of intrinsics.

use crate::Real;

/// `N` floats, one in each lane.
pub trait Vector<const N: usize>: Copy {
    /// The same number in all lanes.
    ///
    /// # Safety
    /// The processor must have the instruction set that the vector belongs to.
    unsafe fn splat(x: f32) -> Self;

    /// A number for each lane.
    ///
    /// # Safety
    /// The processor must have the instruction set that the vector belongs to.
    unsafe fn load(from: &[f32; N]) -> Self;

    /// The number in each lane.
    fn store(self) -> [f32; N];

    /// `self` + b.
    fn add(self, b: Self) -> Self;
    /// `self` − b.
    fn sub(self, b: Self) -> Self;
    /// `self`·b.
    fn mul(self, b: Self) -> Self;
    /// `self` / b.
    fn div(self, b: Self) -> Self;
    /// |`self`|.
    fn abs(self) -> Self;
    /// The smaller of the two; `b` where either is NaN.
    fn min(self, b: Self) -> Self;
    /// The larger of the two; `b` where either is NaN.
    fn max(self, b: Self) -> Self;
    /// `self`·b + c, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// c − `self`·b, rounded once.
    fn neg_mul_add(self, b: Self, c: Self) -> Self;
    /// `self`·b − c, rounded once.
    fn mul_sub(self, b: Self, c: Self) -> Self;

    /// `self`·b − c, rounded once or twice, whichever is faster.
    #[inline(always)]
    fn relaxed_mul_sub(self, b: Self, c: Self) -> Self {
        self.mul_sub(b, c)
    }

    /// A bit for each lane where `self` ≤ b; 0 where either is NaN.
    fn le(self, b: Self) -> u32;
    /// A bit for each lane where `self` < b; 0 where either is NaN.
    fn lt(self, b: Self) -> u32;
}

/// An instruction set, as a type.
pub trait Simd: Copy {
    /// Four floats.
    type F32x4: Vector<4>;
    /// Eight floats.
    type F32x8: Vector<8>;
    /// Sixteen floats.
    type F32x16: Vector<16>;
    /// As many floats as a register holds.
    type Real: Real;

    /// The four lanes of `from` whose indices are in byte `BYTE` of each element of `indices`. Only
    /// the low three bits of an index count.
    #[inline(always)]
    fn permute<const BYTE: usize>(from: Self::F32x8, indices: &[u32; 4]) -> Self::F32x4 {
        let from = from.store();
        // SAFETY: `from` is the proof of the instruction set.
        unsafe { Self::F32x4::load(&indices.map(|index| from[(index >> (8 * BYTE)) as usize & 7])) }
    }
}

/// A computation that is compiled for every instruction set.
pub trait Task {
    /// The result.
    type Output;

    /// Computes it. This and everything it calls must be `#[inline(always)]`: a function that is
    /// called instead is compiled without the instruction set.
    ///
    /// # Safety
    /// The processor must have the instruction set `S`.
    unsafe fn run<S: Simd>(self) -> Self::Output;
}

/// A computation that is written for any number of lanes. This and everything it calls must be
/// `#[inline(always)]`, as for a [`Task`].
pub trait Kernel {
    /// The result.
    type Output;

    /// Computes it with as many lanes as `R` has.
    fn run<R: Real>(self) -> Self::Output;
}

/// Runs a kernel with the widest vectors of an instruction set.
pub(crate) struct Widest<K>(pub K);

impl<K: Kernel> Task for Widest<K> {
    type Output = K::Output;

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> K::Output {
        self.0.run::<S::Real>()
    }
}

/// Defines a vector as a newtype over a register. Each operation is an expression of registers;
/// `load` and `store` have pointers.
macro_rules! vector {
    (
        $(#[$doc:meta])* $name:ident($register:ty): Vector<$n:literal>;
        splat($x:ident) = $splat:expr;
        load($from:ident) = $load:expr;
        store($to:ident, $value:ident) = $store:expr;
        $($operation:ident($a:ident $(, $b:ident)*) = $result:expr;)*
        -> u32:
        $($comparison:ident($left:ident, $right:ident) = $bits:expr;)*
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $name($register);

        // SAFETY, for every block: the caller of the constructor promised the instruction set, and
        // a vector is the proof of it. Arrays have as many floats as are read or written.
        #[allow(unused_unsafe)]
        impl $crate::simd::Vector<$n> for $name {
            #[inline(always)]
            unsafe fn splat($x: f32) -> Self {
                unsafe { Self($splat) }
            }

            #[inline(always)]
            unsafe fn load(from: &[f32; $n]) -> Self {
                let $from = from.as_ptr();
                unsafe { Self($load) }
            }

            #[inline(always)]
            fn store(self) -> [f32; $n] {
                let mut to = [0.0; $n];
                let ($to, $value) = (to.as_mut_ptr(), self.0);
                unsafe { $store };
                to
            }

            $(
                #[inline(always)]
                fn $operation(self $(, $b: Self)*) -> Self {
                    let $a = self.0;
                    $(let $b = $b.0;)*
                    unsafe { Self($result) }
                }
            )*

            $(
                #[inline(always)]
                fn $comparison(self, $right: Self) -> u32 {
                    let ($left, $right) = (self.0, $right.0);
                    unsafe { $bits }
                }
            )*
        }
    };
}

/// Defines an instruction set: its processor features, which are detected and enabled alike, and
/// its vectors.
macro_rules! instruction_set {
    (
        $name:ident, $is_detected:ident [$($feature:tt)*];
        $f32x4:ty, $f32x8:ty, $f32x16:ty;
        $real:ty;
        $($item:item)*
    ) => {
        #[doc = concat!("See [`crate::InstructionSet::", stringify!($name), "`].")]
        #[derive(Clone, Copy)]
        pub struct $name;

        impl $crate::simd::Simd for $name {
            type F32x4 = $f32x4;
            type F32x8 = $f32x8;
            type F32x16 = $f32x16;
            type Real = $real;
            $($item)*
        }

        /// Whether the processor has the instruction set.
        pub fn is_available() -> bool {
            true $(&& $is_detected!($feature))*
        }

        /// Runs a task.
        ///
        /// # Safety
        /// The processor must have the instruction set.
        $(#[target_feature(enable = $feature)])*
        pub unsafe fn run<T: $crate::simd::Task>(task: T) -> T::Output {
            // SAFETY: the caller promises the instruction set.
            unsafe { task.run::<$name>() }
        }
    };
}
