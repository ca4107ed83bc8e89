//! A small generator of uniform numbers, independent of the ones under test.
//!
//! SplitMix64 [Steele 2014]: a counter with an odd increment, followed by a bijective mixer.

/// A deterministic stream of uniform numbers.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The stream of `seed`.
    pub fn new(seed: u64) -> Random {
        Random { state: seed }
    }

    /// 64 uniform bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A uniform number in [0, 1).
    pub fn get_1d(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1 << 24) as f32
    }

    /// A uniform point of the unit square, 1 excluded.
    pub fn get_2d(&mut self) -> [f32; 2] {
        [self.get_1d(), self.get_1d()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Chi2, Moments, t_test};

    #[test]
    fn numbers_are_uniform_and_below_one() {
        let mut random = Random::new(7);
        let numbers: Vec<f32> = (0..100_000).map(|_| random.get_1d()).collect();
        assert!(numbers.iter().all(|u| (0.0..1.0).contains(u)));
        let mean: Moments = numbers.iter().map(|&u| u as f64).collect();
        t_test(&mean, 0.5, 1).unwrap();
        Chi2::default().rectangle([[0.0, 1.0]; 2], |_| Some(random.get_2d()), |_| 1.0).unwrap();
    }

    #[test]
    fn equal_seeds_give_equal_streams() {
        let (mut a, mut b) = (Random::new(3), Random::new(3));
        assert!((0..100).all(|_| a.bits() == b.bits()));
    }
}
