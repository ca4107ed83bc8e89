//! Numbers as text: the shortest decimals that are read back as the same numbers.

use std::fmt::{Display, LowerExp};

/// A number without exponent where that is not much longer.
pub(crate) fn decimal(number: impl Display + LowerExp) -> String {
    /// The longest form without exponent: all digits of a float, sign and point, and some zeros.
    const LONGEST: usize = 13;
    let plain = number.to_string();
    if plain.len() <= LONGEST {
        return plain;
    }
    let exponent = format!("{number:e}");
    if exponent.len() < plain.len() { exponent } else { plain }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    #[test]
    fn numbers_are_short() {
        let expected = [
            (0.0, "0"),
            (-0.0, "-0"),
            (0.1, "0.1"),
            (-2.5, "-2.5"),
            (1e6, "1000000"),
            (1e-7, "0.0000001"),
            (1.5e-20, "1.5e-20"),
            (f32::MAX, "3.4028235e38"),
            (f32::MIN_POSITIVE, "1.1754944e-38"),
        ];
        for (number, text) in expected {
            assert_eq!(decimal(number), text);
        }
        assert_eq!(decimal(1.0 / 3.0_f64), "0.3333333333333333");
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn every_number_is_read_back(bits: u32, more: u32) {
            let single = f32::from_bits(bits);
            prop_assume!(single.is_finite());
            prop_assert_eq!(decimal(single).parse::<f32>().map(f32::to_bits), Ok(bits));
            let bits = u64::from(bits) << 32 | u64::from(more);
            let double = f64::from_bits(bits);
            prop_assume!(double.is_finite());
            prop_assert_eq!(decimal(double).parse::<f64>().map(f64::to_bits), Ok(bits));
        }
    }
}
