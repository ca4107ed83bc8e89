//! Sampling a discrete distribution in constant time: Walker's alias method, with the table built
//! as by [Vose 1991].
//!
//! Each of n equally likely bins is shared by at most two outcomes: its own, up to a threshold, and
//! an alias beyond it.

use crate::DiscreteSample;
use math::ONE_MINUS_EPSILON;

#[derive(Clone, Copy, Debug)]
struct Bin {
    /// The fraction of the bin that is its own outcome's.
    threshold: f32,
    /// The probability of the bin's own outcome, over all bins.
    pmf: f32,
    alias: u32,
}

/// Indices with fixed probabilities.
#[derive(Clone, Debug)]
pub struct AliasTable {
    bins: Box<[Bin]>,
}

impl AliasTable {
    /// The table of probabilities proportional to the weights; `None` unless all are finite and at
    /// least 0, with a finite sum above 0.
    pub fn new(weights: &[f32]) -> Option<AliasTable> {
        let total: f64 = weights.iter().map(|&w| w as f64).sum();
        if !total.is_finite() || total <= 0.0 || weights.iter().any(|&w| w < 0.0) {
            return None;
        }
        let scale = weights.len() as f64 / total;
        let mut bins: Box<[Bin]> = weights
            .iter()
            .map(|&w| Bin { threshold: 1.0, pmf: (w as f64 / total) as f32, alias: 0 })
            .collect();
        // Each outcome's share of a bin: shares below 1 are filled up from those above.
        let shares = weights.iter().map(|&w| w as f64 * scale).enumerate();
        let (mut small, mut large): (Vec<_>, Vec<_>) = shares.partition(|&(_, share)| share < 1.0);
        while let (Some(&(low, share)), Some((high, rest))) = (small.last(), large.pop()) {
            small.pop();
            bins[low].threshold = share as f32;
            bins[low].alias = high as u32;
            let rest = rest + share - 1.0;
            if rest < 1.0 { &mut small } else { &mut large }.push((high, rest));
        }
        // The rest differs from 1 by rounding alone.
        Some(AliasTable { bins })
    }

    /// The number of indices.
    #[expect(clippy::len_without_is_empty, reason = "a table is never empty")]
    pub fn len(&self) -> usize {
        self.bins.len()
    }

    /// The bins: the share of a bin below which it stands for its own index, the probability of
    /// that index, and the index that it stands for otherwise.
    pub fn bins(&self) -> impl ExactSizeIterator<Item = (f32, f32, u32)> {
        self.bins.iter().map(|bin| (bin.threshold, bin.pmf, bin.alias))
    }

    /// The probability of an index.
    #[inline]
    pub fn pmf(&self, index: usize) -> f32 {
        self.bins[index].pmf
    }

    /// Draws an index.
    #[inline]
    pub fn sample(&self, u: f32) -> DiscreteSample {
        // In double precision, as a large table leaves few bits of `u` for the position within a
        // bin.
        let scaled = u as f64 * self.bins.len() as f64;
        let bin = (scaled as usize).min(self.bins.len() - 1);
        let within = (scaled - bin as f64) as f32;
        let Bin { threshold, alias, .. } = self.bins[bin];
        let (index, u_remapped) = if within < threshold {
            (bin, within / threshold)
        } else {
            (alias as usize, (within - threshold) / (1.0 - threshold))
        };
        DiscreteSample {
            index,
            pmf: self.bins[index].pmf,
            u_remapped: u_remapped.clamp(0.0, ONE_MINUS_EPSILON),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::{Chi2, Random};

    #[test]
    fn frequencies_follow_the_weights() {
        let weights = [3.0, 0.0, 1.0, 8.0, 0.5, 0.0, 2.5];
        let table = AliasTable::new(&weights).unwrap();
        let mut random = Random::new(1);
        let mut counts = [0; 7];
        let mut remapped = Vec::new();
        for _ in 0..100_000 {
            let sample = table.sample(random.get_1d());
            assert_eq!(sample.pmf, table.pmf(sample.index));
            counts[sample.index] += 1;
            remapped.push(sample.u_remapped);
        }
        let expected = weights.map(|w| w as f64 / 15.0 * 1e5);
        let test = Chi2 { tests: 2, samples: remapped.len(), bins: [8, 8], ..Chi2::default() };
        test.counts(&counts, &expected).unwrap();
        test.interval([0.0, 1.0], |_| remapped.pop(), |_| 1.0).unwrap();
    }

    #[test]
    fn weights_without_a_distribution_are_rejected() {
        for weights in [&[][..], &[0.0, 0.0], &[1.0, -1.0, 2.0], &[f32::NAN, 1.0], &[f32::INFINITY, 1.0]] {
            assert!(AliasTable::new(weights).is_none(), "{weights:?}");
        }
    }

    #[test]
    fn a_single_index_is_certain() {
        let table = AliasTable::new(&[0.3]).unwrap();
        assert_eq!(table.len(), 1);
        assert_eq!(table.sample(0.7).index, 0);
        assert_eq!(table.pmf(0), 1.0);
    }
}
