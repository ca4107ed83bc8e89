//! Pseudo-random numbers: O'Neill's PCG32 (XSH-RR), with a 64-bit state and 2⁶³ sequences
//! [O'Neill 2014].

use crate::hash::{mix_bits, unit_interval};

const MULTIPLIER: u64 = 0x5851_f42d_4c95_7f2d;

/// A generator of 32-bit words; equal sequences and offsets give equal words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rng {
    state: u64,
    increment: u64,
}

impl Rng {
    /// The generator of a sequence, at an offset into its period.
    #[inline]
    pub fn new(sequence: u64, offset: u64) -> Rng {
        let mut rng = Rng { state: 0, increment: (sequence << 1) | 1 };
        rng.uniform_u32();
        rng.state = rng.state.wrapping_add(offset);
        rng.uniform_u32();
        rng
    }

    /// The generator of a sequence, at an offset that depends on the sequence alone.
    #[inline]
    pub fn from_sequence(sequence: u64) -> Rng {
        Rng::new(sequence, mix_bits(sequence))
    }

    /// 32 uniform bits.
    #[inline]
    pub fn uniform_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(MULTIPLIER).wrapping_add(self.increment);
        let xor_shifted = (((old >> 18) ^ old) >> 27) as u32;
        xor_shifted.rotate_right((old >> 59) as u32)
    }

    /// A uniform number in [0, 1).
    #[inline]
    pub fn uniform_f32(&mut self) -> f32 {
        unit_interval(self.uniform_u32())
    }

    /// Skips `count` words in time O(log `count`); a wrapped negative number steps back.
    pub fn advance(&mut self, count: u64) {
        let (mut multiplier, mut increment) = (MULTIPLIER, self.increment);
        let (mut total_multiplier, mut total_increment) = (1u64, 0u64);
        let mut left = count;
        while left > 0 {
            if left & 1 == 1 {
                total_multiplier = total_multiplier.wrapping_mul(multiplier);
                total_increment = total_increment.wrapping_mul(multiplier).wrapping_add(increment);
            }
            increment = multiplier.wrapping_add(1).wrapping_mul(increment);
            multiplier = multiplier.wrapping_mul(multiplier);
            left >>= 1;
        }
        self.state = total_multiplier.wrapping_mul(self.state).wrapping_add(total_increment);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Chi2;

    #[test]
    fn the_words_of_the_reference_implementation() {
        let mut rng = Rng::new(54, 42);
        let words: Vec<u32> = (0..6).map(|_| rng.uniform_u32()).collect();
        assert_eq!(words, [0xa15c02b7, 0x7b47f409, 0xba1d3330, 0x83d2f293, 0xbfa4784b, 0xcbed606e]);
    }

    #[test]
    fn advancing_skips_words() {
        let start = Rng::from_sequence(9);
        let mut stepped = start.clone();
        (0..1000).for_each(|_| {
            stepped.uniform_u32();
        });
        let mut advanced = start.clone();
        advanced.advance(1000);
        assert_eq!(advanced, stepped);
        advanced.advance(1000u64.wrapping_neg());
        assert_eq!(advanced, start);
    }

    #[test]
    fn numbers_are_uniform_in_pairs() {
        let mut rng = Rng::from_sequence(5);
        let pair = |_| Some([rng.uniform_f32(), rng.uniform_f32()]);
        Chi2::default().rectangle([[0.0, 1.0]; 2], pair, |_| 1.0).unwrap();
    }
}
