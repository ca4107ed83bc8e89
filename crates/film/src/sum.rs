//! Sums that do not depend on the order of addition.
//!
//! Floating-point addition rounds after each term, so its result depends on the order. Here each
//! term is rounded once, to a multiple of 2⁻⁶⁴, and terms are added as integers of 128 bits, which
//! is exact: any order, any grouping and any number of threads give the same bits.
//!
//! Range: a term may be as large as [`ExactSum::MAX_TERM`] = 2⁴⁰ ≈ 10¹², of which 2²³ fit into a
//! sum; beyond that a sum stays at its largest value. A term is off by 2⁻⁶⁵ ≈ 3·10⁻²⁰ at most.

/// A sum of numbers, independent of their order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExactSum(i128);

impl ExactSum {
    /// The largest magnitude that a term may have.
    pub const MAX_TERM: f64 = (1_u64 << 40) as f64;

    const UNITS_PER_ONE: f64 = 18_446_744_073_709_551_616.0;

    /// Whether `term` can be added: it is a number and not larger than [`Self::MAX_TERM`].
    #[inline]
    pub fn can_add(term: f64) -> bool {
        term.abs() <= Self::MAX_TERM
    }

    /// Adds a term that [`Self::can_add`].
    #[inline]
    pub fn add(&mut self, term: f64) {
        debug_assert!(Self::can_add(term));
        self.0 = self.0.saturating_add((term * Self::UNITS_PER_ONE).round_ties_even() as i128);
    }

    /// Adds all terms of another sum.
    #[inline]
    pub fn merge(&mut self, other: Self) {
        self.0 = self.0.saturating_add(other.0);
    }

    /// The sum in units of 2⁻⁶⁴.
    pub(crate) fn units(self) -> i128 {
        self.0
    }

    /// The sum of so many units of 2⁻⁶⁴.
    pub(crate) fn from_units(units: i128) -> Self {
        Self(units)
    }

    /// The number nearest to the sum.
    #[inline]
    pub fn value(self) -> f64 {
        self.0 as f64 / Self::UNITS_PER_ONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Random;

    fn sum(terms: &[f64]) -> ExactSum {
        let mut sum = ExactSum::default();
        terms.iter().for_each(|&term| sum.add(term));
        sum
    }

    #[test]
    fn small_terms_survive_large_ones() {
        let tiny = 2f64.powi(-60);
        assert_eq!(sum(&[ExactSum::MAX_TERM, tiny, -ExactSum::MAX_TERM]).value(), tiny);
        assert_eq!(
            sum(&[0.1, 0.2, -0.3]).value().abs(),
            2f64.powi(-55),
            "the error of the decimal fractions"
        );
        assert_eq!(sum(&[2f64.powi(-66); 100]).value(), 0.0, "below the grid");
    }

    #[test]
    fn terms_that_are_not_numbers_or_too_large_cannot_be_added() {
        for term in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 2.0 * ExactSum::MAX_TERM] {
            assert!(!ExactSum::can_add(term));
        }
        assert!(ExactSum::can_add(-ExactSum::MAX_TERM));
    }

    #[test]
    fn any_order_and_grouping_gives_the_same_sum() {
        let mut random = Random::new(1);
        for count in 1..200 {
            // Magnitudes over sixty powers of two, where a floating-point sum would depend on the
            // order.
            let mut term =
                || f64::from(random.get_1d() - 0.5) * 2f64.powi((60.0 * random.get_1d()) as i32 - 30);
            let terms: Vec<f64> = (0..count).map(|_| term()).collect();
            let whole = sum(&terms);
            let reversed: Vec<f64> = terms.iter().rev().copied().collect();
            assert_eq!(sum(&reversed), whole);
            let (first, second) = terms.split_at((random.get_1d() * count as f32) as usize);
            let mut merged = sum(second);
            merged.merge(sum(first));
            assert_eq!(merged, whole);
            let magnitude: f64 = terms.iter().map(|x| x.abs()).sum();
            let error = (whole.value() - terms.iter().sum::<f64>()).abs();
            assert!(error <= 1e-14 * magnitude + count as f64 * 2f64.powi(-65));
        }
    }
}
