//! Weighted reservoir sampling: one sample of a stream, with probability proportional to its
//! weight, without storing the stream [Chao 1982], [Pharr 2023 §A.2].

use crate::Rng;

/// The kept sample, and the sum of all weights.
#[derive(Clone, Debug)]
pub struct WeightedReservoir<T> {
    rng: Rng,
    weight_sum: f32,
    kept: Option<(T, f32)>,
}

impl<T> WeightedReservoir<T> {
    /// An empty reservoir; its choices follow from the seed.
    pub fn new(seed: u64) -> WeightedReservoir<T> {
        WeightedReservoir { rng: Rng::from_sequence(seed), weight_sum: 0.0, kept: None }
    }

    /// Adds a sample, which is never kept without a positive weight; returns whether it is kept for
    /// now.
    pub fn add(&mut self, sample: T, weight: f32) -> bool {
        self.add_with(weight, || sample)
    }

    /// [`add`](Self::add) with a sample that is computed only if it is kept.
    pub fn add_with(&mut self, weight: f32, sample: impl FnOnce() -> T) -> bool {
        if weight.is_nan() || weight <= 0.0 {
            return false;
        }
        self.weight_sum += weight;
        let keep = self.rng.uniform_f32() * self.weight_sum < weight;
        if keep {
            self.kept = Some((sample(), weight));
        }
        keep
    }

    /// Merges another reservoir.
    pub fn merge(&mut self, other: WeightedReservoir<T>) {
        let total = other.weight_sum;
        if let Some((sample, weight)) = other.kept
            && self.add(sample, total)
            && let Some(kept) = &mut self.kept
        {
            kept.1 = weight;
        }
    }

    /// The kept sample, if any had weight.
    pub fn sample(&self) -> Option<&T> {
        self.kept.as_ref().map(|(sample, _)| sample)
    }

    /// The probability of the kept sample; 0 if there is none.
    pub fn sample_probability(&self) -> f32 {
        self.kept.as_ref().map_or(0.0, |(_, weight)| weight / self.weight_sum)
    }

    /// The sum of all weights.
    pub fn weight_sum(&self) -> f32 {
        self.weight_sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Chi2;

    const WEIGHTS: [f32; 4] = [1.0, 0.0, 5.0, 2.0];

    fn check(run: impl Fn(u64) -> WeightedReservoir<usize>) {
        let mut counts = [0; 4];
        for seed in 0..20_000 {
            let reservoir = run(seed);
            let &index = reservoir.sample().unwrap();
            assert_eq!(reservoir.weight_sum(), 8.0);
            assert_eq!(reservoir.sample_probability(), WEIGHTS[index] / 8.0);
            counts[index] += 1;
        }
        let expected = WEIGHTS.map(|w| w as f64 / 8.0 * 20_000.0);
        Chi2 { tests: 2, ..Chi2::default() }.counts(&counts, &expected).unwrap();
    }

    fn filled(seed: u64, range: std::ops::Range<usize>) -> WeightedReservoir<usize> {
        let mut reservoir = WeightedReservoir::new(seed);
        for i in range {
            reservoir.add(i, WEIGHTS[i]);
        }
        reservoir
    }

    #[test]
    fn samples_are_kept_in_proportion_to_their_weights() {
        check(|seed| filled(seed, 0..4));
    }

    #[test]
    fn merged_reservoirs_are_one() {
        check(|seed| {
            let mut reservoir = filled(seed, 0..2);
            reservoir.merge(filled(seed + 1_000_000, 2..4));
            reservoir
        });
    }

    #[test]
    fn an_empty_reservoir_has_no_sample() {
        let reservoir = filled(0, 1..2);
        assert_eq!((reservoir.sample(), reservoir.sample_probability()), (None, 0.0));
    }
}
