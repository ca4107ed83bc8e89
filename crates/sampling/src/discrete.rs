//! Sampling a small discrete distribution by a linear search.

use math::ONE_MINUS_EPSILON;

/// A sample of a discrete distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscreteSample {
    /// The index.
    pub index: usize,
    /// The probability with which it is drawn.
    pub pmf: f32,
    /// `u` remapped: uniform in [0, 1) and independent of the index.
    pub u_remapped: f32,
}

/// Draws an index with probability proportional to its weight (at least 0); `None` if no weight is
/// above 0.
pub fn sample_discrete(weights: &[f32], u: f32) -> Option<DiscreteSample> {
    let total: f32 = weights.iter().sum();
    let target = u * total;
    let mut below = 0.0;
    let mut chosen = None;
    for (index, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
        // Rounding may leave the target above all sums: then the last weight above 0 is chosen.
        let u_remapped = ((target - below) / weight).clamp(0.0, ONE_MINUS_EPSILON);
        chosen = Some(DiscreteSample { index, pmf: weight / total, u_remapped });
        below += weight;
        if target < below {
            break;
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_follow_the_weights() {
        let sample = |u| sample_discrete(&[1.0, 0.0, 3.0, 0.0], u).unwrap();
        assert_eq!(sample(0.0), DiscreteSample { index: 0, pmf: 0.25, u_remapped: 0.0 });
        assert_eq!(sample(0.125), DiscreteSample { index: 0, pmf: 0.25, u_remapped: 0.5 });
        assert_eq!(sample(0.25), DiscreteSample { index: 2, pmf: 0.75, u_remapped: 0.0 });
        assert_eq!(sample(0.625), DiscreteSample { index: 2, pmf: 0.75, u_remapped: 0.5 });
        assert_eq!(sample(ONE_MINUS_EPSILON).index, 2);
    }

    #[test]
    fn zero_weights_have_no_sample() {
        assert_eq!(sample_discrete(&[], 0.5), None);
        assert_eq!(sample_discrete(&[0.0, 0.0], 0.5), None);
    }
}
