//! The encoding of linear values as the codes of integer images.
//!
//! sRGB [IEC 61966-2-1]: linear = c / 12.92 for c ≤ 0.04045, else ((c + 0.055) / 1.055)^2.4. Gamma
//! x: linear = c^x. Codes and linear values both run over [0, 1].

use std::fmt;

/// The encoding of linear values as integer codes; floating-point images are always linear.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ColorEncoding {
    /// The code is the value.
    Linear,
    /// The sRGB transfer function.
    #[default]
    Srgb,
    /// linear = code^γ.
    Gamma(f32),
}

impl ColorEncoding {
    /// The encoding of a name as scene files write it: `sRGB`, `linear` or `gamma 2.2`; `None` if
    /// it is none of these.
    pub fn from_name(name: &str) -> Option<Self> {
        match name.split_whitespace().collect::<Vec<_>>()[..] {
            ["sRGB"] => Some(Self::Srgb),
            ["linear"] => Some(Self::Linear),
            ["gamma", exponent] => {
                exponent.parse().ok().filter(|gamma: &f32| gamma.is_finite() && *gamma > 0.0).map(Self::Gamma)
            }
            _ => None,
        }
    }

    /// The linear value of a code in [0, 1].
    pub fn to_linear(self, code: f32) -> f32 {
        match self {
            Self::Linear => code,
            Self::Srgb => linear_from_srgb(code),
            Self::Gamma(gamma) => power(code.max(0.0), gamma),
        }
    }

    /// The code in [0, 1] of a linear value, clamped; NaN becomes 0.
    pub fn from_linear(self, linear: f32) -> f32 {
        let value = at_most(linear, 1.0);
        match self {
            Self::Linear => value,
            Self::Srgb => srgb_from_linear(value),
            Self::Gamma(gamma) => power(value, 1.0 / gamma),
        }
    }

    /// The nearest 8-bit code of a linear value.
    pub fn quantize(self, linear: f32) -> u8 {
        (self.from_linear(linear) * 255.0 + 0.5) as u8
    }

    /// The linear values of all 8-bit codes.
    pub fn table(self) -> [f32; 256] {
        std::array::from_fn(|code| self.to_linear(code as f32 / 255.0))
    }
}

/// [`ColorEncoding::quantize`] for many values: codes are found in a table instead of computed by a
/// power for each value.
pub(crate) struct Quantizer {
    /// The smallest value of each code, and beyond the last code infinity. Codes do not decrease
    /// with the value.
    least: [f32; 257],
    /// For values in [0, 1) by the leading bits of their representation: the code of the smallest
    /// value with these bits.
    first: Vec<u8>,
}

impl Quantizer {
    /// Bits of a value that are not looked up: 128 entries for each power of two.
    const SHIFT: u32 = f32::MANTISSA_DIGITS - 1 - 7;

    pub fn new(encoding: ColorEncoding) -> Self {
        let one = 1.0_f32.to_bits();
        let mut least = [f32::INFINITY; 257];
        for (code, least) in (0..=255).zip(&mut least) {
            // Floats that are not negative are in the order of their bits.
            let (mut low, mut high) = (0, one);
            while low < high {
                let middle = low + (high - low) / 2;
                if encoding.quantize(f32::from_bits(middle)) >= code {
                    high = middle
                } else {
                    low = middle + 1
                }
            }
            *least = f32::from_bits(low);
        }
        let entries = (0..one >> Self::SHIFT).map(|entry| f32::from_bits(entry << Self::SHIFT));
        // The least value of code 0 is 0, so that every value has a code.
        let first = entries.map(|value| (least.partition_point(|least| *least <= value) - 1) as u8);
        Self { first: first.collect(), least }
    }

    /// The nearest code of a linear value.
    #[inline]
    pub fn code(&self, linear: f32) -> u8 {
        let value = at_most(linear, 1.0);
        let Some(&first) = self.first.get((value.to_bits() >> Self::SHIFT) as usize) else { return u8::MAX };
        let mut code = usize::from(first);
        // The codes of an entry are rarely more than two: one addition instead of a branch.
        code += usize::from(value >= self.least[code + 1]);
        while value >= self.least[code + 1] {
            code += 1;
        }
        code as u8
    }
}

impl fmt::Display for ColorEncoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Linear => f.write_str("linear"),
            Self::Srgb => f.write_str("sRGB"),
            Self::Gamma(gamma) => write!(f, "gamma {gamma}"),
        }
    }
}

/// The value clamped to [0, `max`]; NaN becomes 0.
pub(crate) fn at_most(value: f32, max: f32) -> f32 {
    if value > 0.0 { value.min(max) } else { 0.0 }
}

/// A power that is rounded once, so that it never falls where it should rise.
fn power(base: f32, exponent: f32) -> f32 {
    libm::pow(base.into(), exponent.into()) as f32
}

/// The linear value of an sRGB code; values outside [0, 1] follow the same curve.
pub fn linear_from_srgb(code: f32) -> f32 {
    if code <= 0.04045 { code / 12.92 } else { power((code + 0.055) / 1.055, 2.4) }
}

/// The sRGB code of a linear value; values outside [0, 1] follow the same curve.
pub fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * power(linear, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_survives_decoding_and_quantizing() {
        for encoding in [ColorEncoding::Linear, ColorEncoding::Srgb, ColorEncoding::Gamma(2.2)] {
            for (code, linear) in encoding.table().into_iter().enumerate() {
                assert_eq!(encoding.quantize(linear) as usize, code, "{encoding}");
            }
        }
    }

    #[test]
    fn codes_in_the_table_are_those_of_the_formula() {
        for encoding in [
            ColorEncoding::Linear,
            ColorEncoding::Srgb,
            ColorEncoding::Gamma(2.2),
            ColorEncoding::Gamma(0.1),
            ColorEncoding::Gamma(20.0),
        ] {
            let quantizer = Quantizer::new(encoding);
            let near = |value: f32| {
                let bits = value.to_bits();
                (bits.saturating_sub(9)..bits + 9).map(f32::from_bits)
            };
            let special = [-1.0, 1.5, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
            let spread = (0..20_000).map(|i| i as f32 / 19_999.0);
            for value in quantizer.least[..256].iter().flat_map(|v| near(*v)).chain(special).chain(spread) {
                assert_eq!(quantizer.code(value), encoding.quantize(value), "{encoding} {value}");
            }
        }
    }

    #[test]
    fn names_parse_as_they_print() {
        for encoding in [ColorEncoding::Linear, ColorEncoding::Srgb, ColorEncoding::Gamma(1.8)] {
            assert_eq!(ColorEncoding::from_name(&encoding.to_string()), Some(encoding));
        }
        for wrong in ["", "srgb2", "gamma", "gamma x", "gamma -1", "gamma inf"] {
            assert_eq!(ColorEncoding::from_name(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn quantizing_clamps_and_survives_nan() {
        assert_eq!(ColorEncoding::Srgb.quantize(-1.0), 0);
        assert_eq!(ColorEncoding::Srgb.quantize(7.0), 255);
        assert_eq!(ColorEncoding::Srgb.quantize(f32::NAN), 0);
        assert_eq!(ColorEncoding::Srgb.quantize(f32::INFINITY), 255);
    }
}
