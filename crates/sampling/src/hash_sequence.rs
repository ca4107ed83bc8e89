//! Random numbers of computations that have no sampler, from the numbers that they are given.

use crate::hash::{mix_word, unit_interval};
use lanes::Int;
use math::Vec2;

/// A sequence of random numbers for each lane, which depends on some words alone: the images
/// under a hash function of multiples of 2³²/φ, from a hash of the words on.
#[derive(Clone, Copy, Debug)]
pub struct HashSequence<I> {
    state: I,
}

impl<I: Int> HashSequence<I> {
    /// The sequence of these words. Floats enter as their bits.
    #[inline(always)]
    pub fn new<const N: usize>(words: [I; N]) -> Self {
        let mut state = I::splat(0x6a09_e667);
        for word in words {
            // The sum before mixing keeps zeros from having no effect.
            state = mix_word(state ^ word).wrapping_add(I::splat(0x3c6e_f372));
        }
        Self { state }
    }

    /// 32 uniform bits.
    #[inline(always)]
    pub fn word(&mut self) -> I {
        self.state = self.state.wrapping_add(I::splat(0x9e37_79b9));
        mix_word(self.state)
    }

    /// A uniform number in [0, 1).
    #[inline(always)]
    pub fn get_1d(&mut self) -> I::Real {
        unit_interval(self.word())
    }

    /// A uniform point of the unit square.
    #[inline(always)]
    pub fn get_2d(&mut self) -> Vec2<I::Real> {
        let x = self.get_1d();
        Vec2::new(x, self.get_1d())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Chi2;

    #[test]
    fn numbers_are_uniform_within_a_sequence_and_across_sequences() {
        let test = Chi2 { tests: 3, ..Chi2::default() };
        let mut sequence = HashSequence::new([7u32, 0]);
        test.rectangle([[0.0, 1.0]; 2], |_| Some(sequence.get_2d().into()), |_| 1.0).unwrap();
        let mut seed = 0u32;
        let first = |_| {
            seed += 1;
            Some(HashSequence::new([0, seed]).get_2d().into())
        };
        test.rectangle([[0.0, 1.0]; 2], first, |_| 1.0).unwrap();
        let mut x = 1.0f32;
        let of_floats = |_| {
            x += 1e-6;
            Some([HashSequence::new([x.to_bits()]).get_1d(), HashSequence::new([(-x).to_bits()]).get_1d()])
        };
        test.rectangle([[0.0, 1.0]; 2], of_floats, |_| 1.0).unwrap();
    }
}
