//! Instruction sets as values: which the processor has, and how to run with one of them.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
mod portable;
mod scalar;
#[cfg(target_arch = "x86_64")]
mod sse2;

pub use scalar::F32x1;

use crate::real::Kernel;
use crate::simd::{Task, Widest};

/// An instruction set. All give the same results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InstructionSet {
    /// One float at a time: every processor.
    Scalar,
    /// Arrays of four floats, of which the compiler makes vectors where it can: every processor.
    Portable,
    /// Four floats at once: every x86-64 processor.
    Sse2,
    /// Eight floats at once, with fused multiply-add: x86-64 since 2013.
    Avx2,
    /// Sixteen floats at once: x86-64 with AVX-512.
    Avx512,
    /// Four floats at once: every 64-bit Arm processor.
    Neon,
}

impl InstructionSet {
    /// All instruction sets, the best first.
    pub const ALL: [Self; 6] =
        [Self::Avx512, Self::Avx2, Self::Neon, Self::Sse2, Self::Portable, Self::Scalar];

    /// The sets that processors of this build choose by themselves; every one has the last.
    pub const CHOSEN: &[Self] = if cfg!(target_arch = "aarch64") {
        &[Self::Neon]
    } else if cfg!(not(target_arch = "x86_64")) {
        &[Self::Portable]
    } else if cfg!(target_feature = "avx2") {
        &[Self::Avx512, Self::Avx2]
    } else {
        &[Self::Avx512, Self::Avx2, Self::Sse2]
    };

    /// The environment variable that names the instruction set to use: `avx512`, `avx2`, `neon`,
    /// `sse2`, `portable` or `scalar`.
    pub const VARIABLE: &str = "ALHAZEN_INSTRUCTION_SET";

    /// The one that [`VARIABLE`](Self::VARIABLE) names, or else the best one that this processor
    /// has.
    pub fn detect() -> Self {
        let best = || Self::ALL.into_iter().find(|set| set.is_available());
        Self::requested().ok().flatten().or_else(best).unwrap_or(Self::Scalar)
    }

    /// The one that [`VARIABLE`](Self::VARIABLE) names, if it is set. It is an error if there is no
    /// such set, or if the processor does not have it.
    pub fn requested() -> Result<Option<Self>, String> {
        let Some(name) = std::env::var_os(Self::VARIABLE) else { return Ok(None) };
        let named = |set: &Self| name.eq_ignore_ascii_case(format!("{set:?}"));
        match Self::ALL.into_iter().find(named) {
            Some(set) if set.is_available() => Ok(Some(set)),
            Some(set) => Err(format!("{}: this processor has no {set:?}", Self::VARIABLE)),
            None => Err(format!("{}: there is no instruction set {name:?}", Self::VARIABLE)),
        }
    }

    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Scalar => scalar::is_available(),
            Self::Portable => portable::is_available(),
            #[cfg(target_arch = "x86_64")]
            Self::Sse2 => sse2::is_available(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => avx2::is_available(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => avx512::is_available(),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => neon::is_available(),
            #[allow(unreachable_patterns)]
            _ => false,
        }
    }

    /// Runs a kernel with it.
    ///
    /// # Panics
    /// If the processor does not have it.
    #[inline]
    pub fn dispatch<K: Kernel>(self, kernel: K) -> K::Output {
        assert!(self.is_available(), "{self:?} on a processor without it");
        // SAFETY: as just checked.
        unsafe {
            match self {
                Self::Portable => portable::run(Widest(kernel)),
                _ => self.run(Widest(kernel)),
            }
        }
    }

    /// As [`dispatch`](Self::dispatch), for a kernel of so much code that it is compiled only for
    /// the [`CHOSEN`](Self::CHOSEN) sets: another one runs it by the last of them, with the same
    /// results.
    ///
    /// # Panics
    /// If the processor does not have it.
    pub fn dispatch_large<K: Kernel>(self, kernel: K) -> K::Output {
        assert!(self.is_available(), "{self:?} on a processor without it");
        let task = Widest(kernel);
        // SAFETY: as just checked.
        unsafe {
            match self {
                #[cfg(target_arch = "x86_64")]
                Self::Avx512 => avx512::run(task),
                #[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
                _ => avx2::run(task),
                #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
                Self::Avx2 => avx2::run(task),
                #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
                _ => sse2::run(task),
                #[cfg(target_arch = "aarch64")]
                _ => neon::run(task),
                #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
                _ => portable::run(task),
            }
        }
    }

    /// Runs a task with it; with `Scalar` instead of `Portable`, because the vectors that tasks
    /// name are arrays in both, and each set is one more copy of the ray engine. In builds that
    /// need AVX2, that set stands in for those below it where a task is not compiled for
    /// [every set](Task::EVERY_SET).
    ///
    /// # Safety
    /// The processor must have it.
    #[inline(always)]
    pub unsafe fn run<T: Task>(self, task: T) -> T::Output {
        // SAFETY: as the caller promises.
        unsafe {
            match self {
                #[cfg(target_arch = "x86_64")]
                Self::Avx512 => avx512::run(task),
                #[cfg(target_arch = "x86_64")]
                _ if const { cfg!(target_feature = "avx2") && !T::EVERY_SET } => avx2::run(task),
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
