//! Filters of unpacked vertices: directions, rotations and floats that were stored in fewer bits.

/// How vertices are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Filter {
    /// As they are.
    None,
    /// Unit vectors in the octahedral mapping, of 8 or 16 bits, and one number more.
    Octahedral,
    /// Unit quaternions without their largest component.
    Quaternion,
    /// Floats of a mantissa of 24 bits and an exponent of 8 bits.
    Exponential,
}

impl Filter {
    /// Replaces vertices of `stride` bytes by what they stand for.
    pub fn apply(self, vertices: &mut [u8], stride: usize) {
        match self {
            Self::None => (),
            Self::Octahedral if stride == 4 => {
                for [x, y, z, _] in vertices.as_chunks_mut().0 {
                    let v = direction([*x, *y, *z].map(|byte| f32::from(byte as i8)), 127.0);
                    [*x, *y, *z] = v.map(|v| v as i8 as u8);
                }
            }
            Self::Octahedral => {
                for vertex in vertices.as_chunks_mut::<8>().0 {
                    let [x, y, z, w] = shorts(vertex);
                    let [x, y, z] = direction([x, y, z].map(f32::from), 32767.0).map(|v| v as i16);
                    store(vertex, [x, y, z, w]);
                }
            }
            Self::Quaternion => {
                for vertex in vertices.as_chunks_mut::<8>().0 {
                    store(vertex, rotation(shorts(vertex)));
                }
            }
            Self::Exponential => {
                for word in vertices.as_chunks_mut::<4>().0 {
                    let bits = i32::from_le_bytes(*word);
                    let (mantissa, exponent) = (bits << 8 >> 8, bits >> 24);
                    *word = ((f64::from(mantissa) * 2_f64.powi(exponent)) as f32).to_le_bytes();
                }
            }
        }
    }
}

fn shorts(bytes: &[u8; 8]) -> [i16; 4] {
    std::array::from_fn(|i| i16::from_le_bytes([bytes[2 * i], bytes[2 * i + 1]]))
}

fn store(bytes: &mut [u8; 8], values: [i16; 4]) {
    for (pair, value) in bytes.as_chunks_mut::<2>().0.iter_mut().zip(values) {
        *pair = value.to_le_bytes();
    }
}

/// The unit vector times `most` of octahedral coordinates, of which 1 is stored as `one`.
fn direction([x, y, one]: [f32; 3], most: f32) -> [f32; 3] {
    let z = one - x.abs() - y.abs();
    let fold = z.min(0.0);
    let (x, y) = (x + fold.copysign(-x), y + fold.copysign(-y));
    let length = (x * x + y * y + z * z).sqrt().max(f32::MIN_POSITIVE);
    [x, y, z].map(|v| (v * (most / length)).round())
}

/// The unit quaternion of three components; the fourth number has their scale and, in its lowest
/// two bits, the place of the largest component.
fn rotation([x, y, z, scale]: [i16; 4]) -> [i16; 4] {
    let unit = std::f32::consts::FRAC_1_SQRT_2 / f32::from(scale | 3);
    let [x, y, z] = [x, y, z].map(|v| f32::from(v) * unit);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let largest = (scale & 3) as usize;
    let mut quaternion = [0; 4];
    for (place, v) in [w, x, y, z].into_iter().enumerate() {
        quaternion[(largest + place) % 4] = (v * 32767.0).round() as i16;
    }
    quaternion
}
