//! The values of grids by their types.

use super::bytes::Bytes;

/// The types of values that are read, all of them as 32-bit floats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Values {
    Float,
    Double,
    /// 2ⁿ bits for each voxel of a leaf, which interpolate between a least and a greatest value.
    Quantized(u32),
    /// The same with its own n for each leaf.
    Variable,
}

/// Where the values of a leaf begin, but for 64-bit floats.
const LEAF_VALUES: usize = 96;

impl Values {
    /// The type of a number.
    pub(super) fn numbered(number: u32) -> Result<Self, String> {
        const NAMES: [&str; 27] = [
            "unknown type",
            "32-bit float",
            "64-bit float",
            "16-bit integer",
            "32-bit integer",
            "64-bit integer",
            "vector of 32-bit floats",
            "vector of 64-bit floats",
            "mask",
            "16-bit float",
            "32-bit unsigned integer",
            "Boolean",
            "8-bit colour",
            "4-bit quantised float",
            "8-bit quantised float",
            "16-bit quantised float",
            "quantised float",
            "vector of four 32-bit floats",
            "vector of four 64-bit floats",
            "index",
            "index of active voxels",
            "masked index",
            "masked index of active voxels",
            "point index",
            "vector of 8-bit integers",
            "vector of 16-bit integers",
            "8-bit integer",
        ];
        match number {
            1 => Ok(Self::Float),
            2 => Ok(Self::Double),
            13..=15 => Ok(Self::Quantized(number - 11)),
            16 => Ok(Self::Variable),
            _ => {
                let name = NAMES.get(number as usize).unwrap_or(&NAMES[0]);
                Err(format!(
                    "its values are of the type “{name}”; floats of 32 and 64 bits and quantised ones are supported"
                ))
            }
        }
    }

    /// Where a value is that follows a number of bytes: aligned by its size.
    pub(super) fn place(self, at: usize) -> usize {
        if self == Self::Double { at.next_multiple_of(8) } else { at }
    }

    /// The number of bytes of the head of a root node.
    pub(super) fn root_bytes(self) -> usize {
        if self == Self::Double { 96 } else { 64 }
    }

    /// The least number of bytes of a leaf.
    pub(super) fn leaf_bytes(self) -> usize {
        match self {
            Self::Float => LEAF_VALUES + 512 * 4,
            Self::Double => 128 + 512 * 8,
            Self::Quantized(log_bits) => LEAF_VALUES + (64 << log_bits),
            Self::Variable => LEAF_VALUES + 64,
        }
    }

    /// A value outside of leaves.
    pub(super) fn value(self, bytes: Bytes, at: usize) -> Result<f32, String> {
        let value = if self == Self::Double { bytes.f64(at)? as f32 } else { bytes.f32(at)? };
        if value.is_finite() {
            return Ok(value);
        }
        Err(format!("it is damaged: a value is {value}"))
    }

    /// The values of a leaf, x fastest.
    pub(super) fn leaf(self, bytes: Bytes, at: usize, values: &mut [f32]) -> Result<(), String> {
        // In the file z is the fastest.
        let mut put = |i: usize, value: f32| values[i >> 6 | i & 0o70 | (i & 7) << 6] = value;
        match self {
            Self::Float => {
                let (numbers, _) = bytes.part(at + LEAF_VALUES, 512 * 4)?.as_chunks();
                numbers.iter().enumerate().for_each(|(i, &number)| put(i, f32::from_le_bytes(number)));
            }
            Self::Double => {
                let (numbers, _) = bytes.part(at + 128, 512 * 8)?.as_chunks();
                numbers.iter().enumerate().for_each(|(i, &number)| put(i, f64::from_le_bytes(number) as f32));
            }
            Self::Quantized(_) | Self::Variable => {
                let log_bits = match self {
                    Self::Quantized(log_bits) => log_bits,
                    _ => bytes.u32(at + 12)? >> 29,
                };
                if log_bits > 4 {
                    return Err(format!("it is damaged: a leaf has 2^{log_bits} bits for a value"));
                }
                let [least, step] = [bytes.f32(at + 80)?, bytes.f32(at + 84)?];
                let codes = bytes.part(at + LEAF_VALUES, 64 << log_bits)?;
                let bits = 1_usize << log_bits;
                for i in 0..512 {
                    let byte = codes[i * bits / 8];
                    let code = match log_bits {
                        4 => u16::from_le_bytes([codes[2 * i], codes[2 * i + 1]]),
                        3 => byte.into(),
                        _ => (byte >> (i * bits % 8) & ((1 << bits) - 1)).into(),
                    };
                    put(i, f32::from(code) * step + least);
                }
            }
        }
        match values.iter().find(|value| !value.is_finite()) {
            Some(value) => Err(format!("it is damaged: a value is {value}")),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values of a leaf whose numbers take 2ⁿ bits, with 0.5 and 0.25 as least value and step.
    fn leaf(values: Values, log_bits: u32, numbers: &[u8]) -> Result<Vec<f32>, String> {
        let before = if values == Values::Double { 128 } else { 96 };
        let mut bytes = vec![0; before];
        bytes[80..84].copy_from_slice(&0.5_f32.to_le_bytes());
        bytes[84..88].copy_from_slice(&0.25_f32.to_le_bytes());
        bytes[15] = (log_bits << 5) as u8;
        bytes.extend(numbers);
        let mut leaf = vec![0.0; 512];
        values.leaf(Bytes(&bytes), 0, &mut leaf).map(|()| leaf)
    }

    /// Where the file's i-th value is.
    fn place(i: usize) -> usize {
        let [x, y, z] = [i / 64, i / 8 % 8, i % 8];
        x + 8 * y + 64 * z
    }

    #[test]
    fn floats_are_read_with_x_fastest() {
        let singles: Vec<u8> = (0..512).flat_map(|i| (i as f32).to_le_bytes()).collect();
        let doubles: Vec<u8> = (0..512).flat_map(|i| f64::from(i).to_le_bytes()).collect();
        for (values, numbers) in [(Values::Float, singles), (Values::Double, doubles)] {
            let read = leaf(values, 0, &numbers).unwrap();
            assert!((0..512).all(|i| read[place(i)] == i as f32), "{values:?}");
            assert!(leaf(values, 0, &numbers[1..]).is_err());
        }
        let large: Vec<u8> = [1e300_f64; 512].iter().flat_map(|value| value.to_le_bytes()).collect();
        assert_eq!(leaf(Values::Double, 0, &large).unwrap_err(), "it is damaged: a value is inf");
    }

    #[test]
    fn quantised_floats_are_read_with_every_number_of_bits() {
        for log_bits in 0..=4 {
            let bits = 1 << log_bits;
            let code = |i: usize| ((i * 40503) >> 7) & ((1 << bits) - 1);
            let mut numbers = vec![0_u8; 64 * bits];
            for bit in 0..512 * bits {
                numbers[bit / 8] |= ((code(bit / bits) >> (bit % bits) & 1) as u8) << (bit % 8);
            }
            let mut types = vec![Values::Variable];
            if log_bits >= 2 {
                types.push(Values::numbered(11 + log_bits).unwrap());
            }
            for values in types {
                let read = leaf(values, log_bits, &numbers).unwrap();
                for i in 0..512 {
                    assert_eq!(read[place(i)], code(i) as f32 * 0.25 + 0.5, "{values:?} {i}");
                }
                assert!(leaf(values, log_bits, &numbers[1..]).is_err());
            }
        }
        assert!(leaf(Values::Variable, 5, &[0; 64 * 32]).unwrap_err().contains("2^5 bits"));
    }
}
