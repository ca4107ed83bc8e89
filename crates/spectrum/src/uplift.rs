//! Smooth spectra from RGB values.
//!
//! An RGB reflectance becomes s(c₀t² + c₁t + c₂) with t = (λ − 540) / 100 and the sigmoid s(x) =
//! ½ + x / (2√(1 + x²)), which lies in [0, 1] whatever the coefficients. The coefficients come from
//! a table over the RGB cube, made by `cargo xtask rgb-table`: for each position i of the largest
//! component, over its value z and the ratios x, y of the two next components to it. Between nodes
//! the coefficients are trilinear in x, y and (z − ½) / √(z (1 − z)), in which those of grey are
//! linear, so that dark and bright colours are accurate too.
//!
//! In the file a node is three 16-bit numbers, asinh of the polynomial at 440, 540 and 640 nm over
//! ±10: what the eye sees of a spectrum depends on the polynomial there, and asinh makes the steps
//! fine where the sigmoid is steep.
//!
//! Sources: [Jakob 2019], [Pharr 2023 §4.6.6].

use crate::rgb::Rgb;
use crate::sampled::{LAMBDA_MAX, LAMBDA_MIN};
use lanes::{Each, Real};

/// A reflectance made from RGB: a sigmoid of a quadratic polynomial of wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbSigmoidPolynomial {
    /// Coefficients of t², t and 1, with t = (λ − 540) / 100.
    pub coefficients: [f32; 3],
}

impl RgbSigmoidPolynomial {
    /// The same reflectance at all wavelengths.
    pub fn constant(reflectance: f32) -> Self {
        let c2 = (reflectance - 0.5) / (reflectance * (1.0 - reflectance)).sqrt();
        Self { coefficients: [0.0, 0.0, c2] }
    }

    /// The reflectance at `lambda` nanometres, in [0, 1].
    #[inline(always)]
    pub fn at<R: Real>(&self, lambda: R) -> R {
        let [c0, c1, c2] = self.coefficients.each(R::splat);
        let t = (lambda - R::splat(540.0)) / R::splat(100.0);
        sigmoid((c0 * t + c1) * t + c2)
    }

    /// The largest reflectance over the range of wavelengths.
    pub fn max_value(&self) -> f32 {
        let [c0, c1, _] = self.coefficients;
        let ends = self.at(LAMBDA_MIN).max(self.at(LAMBDA_MAX));
        let peak = 540.0 - 100.0 * c1 / (2.0 * c0);
        if c0 < 0.0 && (LAMBDA_MIN..=LAMBDA_MAX).contains(&peak) { ends.max(self.at(peak)) } else { ends }
    }
}

/// s(x) = ½ + x / (2√(1 + x²)), right for infinite x too: beyond 10⁹ it is 0 or 1 to all digits.
#[inline(always)]
fn sigmoid<R: Real>(x: R) -> R {
    let x = x.clamp(R::splat(-1e9), R::splat(1e9));
    R::splat(0.5) + x / ((R::one() + x * x).sqrt() * R::splat(2.0))
}

/// Number of nodes over the largest component.
pub const VALUES: usize = 48;

/// Number of nodes over each ratio.
pub const RATIOS: usize = 42;

/// Number of nodes in a table.
pub const NODES: usize = 3 * VALUES * RATIOS * RATIOS;

/// Half the range of asinh that the file can express.
const ASINH_RANGE: f64 = 10.0;

/// The largest component at node `i` of [`VALUES`]: dense towards 0 and 1, where coefficients
/// change fast.
pub fn node_value(i: usize) -> f64 {
    let t = (0.015 + 0.985 * i as f64 / (VALUES - 1) as f64).powf(1.25);
    t * t * (3.0 - 2.0 * t)
}

/// The ratio at node `i` of [`RATIOS`]: denser towards 0, where colours are saturated.
pub fn node_ratio(i: usize) -> f64 {
    let t = i as f64 / (RATIOS - 1) as f64;
    t * (0.6 + 0.4 * t)
}

/// The position t in [0, 1] of a ratio among the nodes: the inverse of [`node_ratio`].
fn ratio_position(ratio: f32) -> f32 {
    ((0.36 + 1.6 * ratio).sqrt() - 0.6) / 0.8
}

/// The variable in which coefficients are about linear over the largest component z: (z − ½) / √(z
/// (1 − z)), kept finite at z = 1.
fn value_coordinate(z: f32) -> f32 {
    (z - 0.5) / (z * (1.05 - z)).sqrt()
}

/// Index of the node for largest component `largest`, its value node and the ratio nodes of the two
/// components after it.
pub fn node_index(largest: usize, value: usize, ratios: [usize; 2]) -> usize {
    ((largest * VALUES + value) * RATIOS + ratios[1]) * RATIOS + ratios[0]
}

/// Coefficients over the RGB cube of one colour space.
pub struct RgbToSpectrumTable {
    /// Three coefficients and a zero, so that a node is a vector.
    nodes: Box<[[f32; 4]]>,
    values: [f32; VALUES],
    /// The values by [`value_coordinate`].
    coordinates: [f32; VALUES],
    ratios: [f32; RATIOS],
}

impl RgbToSpectrumTable {
    /// From the coefficients at all nodes, in the order of [`node_index`].
    ///
    /// # Panics
    /// If there are not [`NODES`] of them.
    pub fn new(coefficients: impl IntoIterator<Item = [f32; 3]>) -> Self {
        let nodes: Box<[_]> = coefficients.into_iter().map(|[a, b, c]| [a, b, c, 0.0]).collect();
        assert_eq!(nodes.len(), NODES, "invariant: a table has all its nodes");
        let values = std::array::from_fn(|i| node_value(i) as f32);
        Self {
            nodes,
            values,
            coordinates: values.map(value_coordinate),
            ratios: std::array::from_fn(|i| node_ratio(i) as f32),
        }
    }

    /// Decodes the bytes of [`encode`](Self::encode).
    ///
    /// # Panics
    /// If `data` has another length than a table.
    pub fn decode(data: &[u8]) -> Self {
        let coefficients = data.chunks_exact(6).map(|node| {
            let [blue, green, red] = std::array::from_fn(|i| {
                let step = f64::from(u16::from_le_bytes([node[2 * i], node[2 * i + 1]]));
                (ASINH_RANGE * (step / 32767.5 - 1.0)).sinh()
            });
            [(0.5 * (blue + red) - green) as f32, (0.5 * (red - blue)) as f32, green as f32]
        });
        Self::new(coefficients)
    }

    /// The table as bytes, six a node.
    pub fn encode(&self) -> Vec<u8> {
        let node = |&[c0, c1, c2, _]: &[f32; 4]| {
            [c0 - c1 + c2, c2, c0 + c1 + c2].map(|x| {
                let step = (f64::from(x).asinh() / ASINH_RANGE + 1.0) * 32767.5;
                step.round().clamp(0.0, 65535.0) as u16
            })
        };
        self.nodes.iter().flat_map(node).flat_map(u16::to_le_bytes).collect()
    }

    /// The reflectance for `rgb`, its components clamped to [0, 1].
    pub fn polynomial(&self, rgb: Rgb) -> RgbSigmoidPolynomial {
        let rgb = rgb.to_array().map(|v| if v > 0.0 { v.min(1.0) } else { 0.0 });
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            return RgbSigmoidPolynomial::constant(rgb[0]);
        }
        let largest = (1..3).fold(0, |best, i| if rgb[i] >= rgb[best] { i } else { best });
        let largest_value = rgb[largest];
        let (x0, tx) = self.ratio_cell(rgb[(largest + 1) % 3] / largest_value);
        let (y0, ty) = self.ratio_cell(rgb[(largest + 2) % 3] / largest_value);

        let (darkest, z) = (self.values[0], largest_value.max(self.values[0]));
        let z0 = self.values.partition_point(|&v| v <= z).clamp(1, VALUES - 1) - 1;
        let [a, b] = [self.coordinates[z0], self.coordinates[z0 + 1]];
        let tz = (value_coordinate(z) - a) / (b - a);

        let mut sums = [0.0; 4];
        for (dz, wz) in [(0, 1.0 - tz), (1, tz)] {
            for (dy, wy) in [(0, 1.0 - ty), (1, ty)] {
                for (dx, wx) in [(0, 1.0 - tx), (1, tx)] {
                    let node = self.nodes[node_index(largest, z0 + dz, [x0 + dx, y0 + dy])];
                    let weight = wz * wy * wx;
                    for (sum, c) in sums.iter_mut().zip(node) {
                        *sum += weight * c;
                    }
                }
            }
        }
        let [c0, c1, mut c2, _] = sums;
        if largest_value < darkest {
            // All wavelengths get darker together; scaling the whole polynomial would lighten where
            // it is positive.
            c2 *= (darkest / largest_value).sqrt();
        }
        RgbSigmoidPolynomial { coefficients: [c0, c1, c2] }
    }

    /// The node below a ratio, and how far the ratio is from it to the next.
    fn ratio_cell(&self, ratio: f32) -> (usize, f32) {
        let below = ((ratio_position(ratio) * (RATIOS - 1) as f32) as usize).min(RATIOS - 2);
        (below, (ratio - self.ratios[below]) / (self.ratios[below + 1] - self.ratios[below]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_reflectance_is_exact() {
        for reflectance in [0.0, 0.01, 0.18, 0.5, 0.9, 1.0] {
            let spectrum = RgbSigmoidPolynomial::constant(reflectance);
            for lambda in [360.0, 555.0, 830.0] {
                assert!((spectrum.at(lambda) - reflectance).abs() < 1e-6, "{reflectance}");
            }
            assert!((spectrum.max_value() - reflectance).abs() < 1e-6);
        }
    }

    #[test]
    fn the_maximum_is_found_inside_and_at_the_ends() {
        for coefficients in
            [[-1.0, 0.5, 0.2], [1.0, 0.5, -0.2], [-0.1, 3.0, 0.0], [0.0, -1.0, 0.5], [0.0, 0.0, 0.3]]
        {
            let spectrum = RgbSigmoidPolynomial { coefficients };
            let searched = (0..=4700).map(|i| spectrum.at(360.0 + 0.1 * i as f32)).fold(0.0, f32::max);
            assert!((spectrum.max_value() - searched).abs() < 1e-4, "{coefficients:?}");
        }
    }

    #[test]
    fn encoding_preserves_the_polynomial() {
        let mut nodes = vec![[0.0; 3]; NODES];
        nodes[5] = [-1.5, 0.25, 3.0];
        nodes[6] = [40.0, -7.0, -90.0];
        let table = RgbToSpectrumTable::new(nodes);
        let again = RgbToSpectrumTable::decode(&table.encode());
        for i in [4, 5, 6] {
            for (a, b) in table.nodes[i].iter().zip(again.nodes[i]) {
                assert!((a - b).abs() <= 4e-4 * (1.0 + a.abs().max(90.0 * f32::from(i == 6))), "{a} {b}");
            }
        }
    }

    #[test]
    fn nodes_increase_to_one() {
        assert!((1..VALUES).all(|i| node_value(i) > node_value(i - 1)));
        assert_eq!((node_value(VALUES - 1), node_ratio(RATIOS - 1)), (1.0, 1.0));
        assert_eq!(node_index(2, VALUES - 1, [RATIOS - 1; 2]), NODES - 1);
    }
}
