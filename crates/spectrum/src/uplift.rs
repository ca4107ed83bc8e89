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
//! fine where the sigmoid is steep. So that archives of the program are small, the file has the
//! differences between neighbours along x, y and z, their signs in the lowest bits, and the low
//! bytes of all before the high ones: it packs to a quarter.
//!
//! Sources: [Jakob 2019], [Pharr 2023 §4.6.6].

use crate::wavelengths::{LAMBDA_MAX, LAMBDA_MIN};
use lanes::{Each, Int, Real};

/// A reflectance made from RGB, one for each lane: a sigmoid of a quadratic polynomial of
/// wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbSigmoidPolynomial<R = f32> {
    /// Coefficients of t², t and 1, with t = (λ − 540) / 100.
    pub coefficients: [R; 3],
}

impl<R: Real> RgbSigmoidPolynomial<R> {
    /// The same reflectance at all wavelengths.
    #[inline(always)]
    pub fn constant(reflectance: R) -> Self {
        let c2 = (reflectance - R::splat(0.5)) / (reflectance * (R::one() - reflectance)).sqrt();
        Self { coefficients: [R::zero(), R::zero(), c2] }
    }

    /// The reflectance at `lambda` nanometres, in [0, 1].
    #[inline(always)]
    pub fn at(&self, lambda: R) -> R {
        let [c0, c1, c2] = self.coefficients;
        let t = (lambda - R::splat(540.0)) / R::splat(100.0);
        sigmoid((c0 * t + c1) * t + c2)
    }
}

impl RgbSigmoidPolynomial {
    /// The same reflectance in all lanes.
    #[inline(always)]
    pub fn splat<R: Real>(&self) -> RgbSigmoidPolynomial<R> {
        RgbSigmoidPolynomial { coefficients: self.coefficients.each(R::splat) }
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

/// The next power of two, for a binary search.
const PADDED_VALUES: usize = VALUES.next_power_of_two();

/// Half the range of asinh that the file can express.
const ASINH_RANGE: f64 = 10.0;

/// The axes x, y and z of a file: the distance between neighbours in its numbers, and how many
/// there are.
const AXES: [(usize, usize); 3] = [(3, RATIOS), (3 * RATIOS, RATIOS), (3 * RATIOS * RATIOS, VALUES)];

/// The largest component at node `i` of [`VALUES`]: dense towards 0 and 1, where coefficients
/// change fast.
pub fn node_value(i: usize) -> f64 {
    let t = libm::pow(0.015 + 0.985 * i as f64 / (VALUES - 1) as f64, 1.25);
    t * t * (3.0 - 2.0 * t)
}

/// The ratio at node `i` of [`RATIOS`]: denser towards 0, where colours are saturated.
pub fn node_ratio(i: usize) -> f64 {
    let t = i as f64 / (RATIOS - 1) as f64;
    t * (0.6 + 0.4 * t)
}

/// The position t in [0, 1] of a ratio among the nodes: the inverse of [`node_ratio`].
#[inline(always)]
fn ratio_position<R: Real>(ratio: R) -> R {
    ((R::splat(0.36) + R::splat(1.6) * ratio).sqrt() - R::splat(0.6)) / R::splat(0.8)
}

/// The variable in which coefficients are about linear over the largest component z: (z − ½) / √(z
/// (1 − z)), kept finite at z = 1.
#[inline(always)]
fn value_coordinate<R: Real>(z: R) -> R {
    (z - R::splat(0.5)) / (z * (R::splat(1.05) - z)).sqrt()
}

/// Index of the node for largest component `largest`, its value node and the ratio nodes of the two
/// components after it.
pub fn node_index(largest: usize, value: usize, ratios: [usize; 2]) -> usize {
    ((largest * VALUES + value) * RATIOS + ratios[1]) * RATIOS + ratios[0]
}

/// Coefficients over the RGB cube of one colour space.
pub struct RgbToSpectrumTable {
    /// Three coefficients and a zero, so that a node lies in one cache line.
    nodes: Box<[[f32; 4]]>,
    /// The values, and after them infinities.
    values: [f32; PADDED_VALUES],
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
        let value = |i| node_value(i) as f32;
        Self {
            nodes,
            values: std::array::from_fn(|i| if i < VALUES { value(i) } else { f32::INFINITY }),
            coordinates: std::array::from_fn(|i| value_coordinate(value(i))),
            ratios: std::array::from_fn(|i| node_ratio(i) as f32),
        }
    }

    /// What a lookup reads: of each node three coefficients and a zero, nodes in the order of
    /// [`node_index`]; the values of nodes, and after them infinities up to a power of two; their
    /// coordinates; the ratios of nodes.
    pub fn numbers(&self) -> [&[f32]; 4] {
        [self.nodes.as_flattened(), &self.values, &self.coordinates, &self.ratios]
    }

    /// Decodes the bytes of [`encode`](Self::encode).
    ///
    /// # Panics
    /// If `data` has another length than a table.
    pub fn decode(data: &[u8]) -> Self {
        let (low, high) = data.split_at(data.len() / 2);
        let bytes = low.iter().zip(high);
        let unfold = |code: u16| code >> 1 ^ (code & 1).wrapping_neg();
        let mut steps: Vec<u16> =
            bytes.map(|(&low, &high)| unfold(u16::from_le_bytes([low, high]))).collect();
        for (distance, count) in AXES {
            for i in distance..steps.len() {
                if !(i / distance).is_multiple_of(count) {
                    steps[i] = steps[i].wrapping_add(steps[i - distance]);
                }
            }
        }
        let coefficients = steps.as_chunks().0.iter().map(|node: &[u16; 3]| {
            let [blue, green, red] =
                node.map(|step| libm::sinh(ASINH_RANGE * (f64::from(step) / 32767.5 - 1.0)));
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
        let mut steps: Vec<u16> = self.nodes.iter().flat_map(node).collect();
        for (distance, count) in AXES {
            for i in (distance..steps.len()).rev() {
                if !(i / distance).is_multiple_of(count) {
                    steps[i] = steps[i].wrapping_sub(steps[i - distance]);
                }
            }
        }
        let fold = |difference: u16| difference << 1 ^ (difference >> 15).wrapping_neg();
        let codes: Vec<[u8; 2]> = steps.into_iter().map(|step| fold(step).to_le_bytes()).collect();
        [0, 1].into_iter().flat_map(|byte| codes.iter().map(move |code| code[byte])).collect()
    }

    /// The reflectance for `rgb`, its components clamped to [0, 1].
    #[inline(always)]
    pub fn polynomial<R: Real>(&self, rgb: [R; 3]) -> RgbSigmoidPolynomial<R> {
        let int = |i: usize| R::Int::splat(i as u32);
        let [r, g, b] = rgb.each(|v| v.clamp(R::zero(), R::one()));
        let is_grey = r.eq(g) & g.eq(b);

        // Of equal components the last one counts as the largest.
        let (green_leads, blue_leads) = (g.ge(r), b.ge(r.max(g)));
        let of_largest = |[r, g, b]: [R; 3]| R::select(blue_leads, b, R::select(green_leads, g, r));
        let largest_value = of_largest([r, g, b]);
        let largest = R::Int::select(green_leads, int(1), int(0));
        let largest = R::Int::select(blue_leads, int(2), largest);
        let (x0, tx) = self.ratio_cell(of_largest([g, b, r]) / largest_value);
        let (y0, ty) = self.ratio_cell(of_largest([b, r, g]) / largest_value);

        let darkest = R::splat(self.values[0]);
        let z = largest_value.max(darkest);
        let z0 = self.value_below(z);
        let [a, b] = [z0, z0.wrapping_add(int(1))].each(|i| R::gather(&self.coordinates, i));
        let tz = (value_coordinate(z) - a) / (b - a);

        let row = largest.wrapping_mul(int(VALUES)).wrapping_add(z0).wrapping_mul(int(RATIOS));
        let first = row.wrapping_add(y0).wrapping_mul(int(RATIOS)).wrapping_add(x0);
        let mut sums = [R::zero(); 3];
        for corner in 0..8 {
            let [dx, dy, dz] = [corner & 1, corner >> 1 & 1, corner >> 2];
            let wx = if dx == 0 { R::one() - tx } else { tx };
            let wy = if dy == 0 { R::one() - ty } else { ty };
            let wz = if dz == 0 { R::one() - tz } else { tz };
            let weight = wz * wy * wx;
            let node = first.wrapping_add(int(dx + RATIOS * (dy + RATIOS * dz))).shl(2);
            for (c, sum) in sums.iter_mut().enumerate() {
                *sum += weight * R::gather(self.nodes.as_flattened(), node.wrapping_add(int(c)));
            }
        }
        let [c0, c1, c2] = sums;
        // All wavelengths get darker together; scaling the whole polynomial would lighten where it
        // is positive.
        let is_dark = largest_value.lt(darkest);
        let c2 = R::select(is_dark, c2 * (darkest / largest_value).sqrt(), c2);

        let constant = RgbSigmoidPolynomial::constant(r).coefficients;
        let select = |c: usize, sum| R::select(is_grey, constant[c], sum);
        RgbSigmoidPolynomial { coefficients: [select(0, c0), select(1, c1), select(2, c2)] }
    }

    /// The last value node that is at most `z`, which is at least that of the first one.
    #[inline(always)]
    fn value_below<R: Real>(&self, z: R) -> R::Int {
        let int = |i: usize| R::Int::splat(i as u32);
        let mut below = int(0);
        let mut step = PADDED_VALUES / 2;
        while step > 0 {
            let next = below.wrapping_add(int(step));
            below = R::Int::select(R::gather(&self.values, next).le(z), next, below);
            step /= 2;
        }
        R::Int::select(below.lt(int(VALUES - 2)), below, int(VALUES - 2))
    }

    /// The node below a ratio, and how far the ratio is from it to the next.
    #[inline(always)]
    fn ratio_cell<R: Real>(&self, ratio: R) -> (R::Int, R) {
        let position = ratio_position(ratio) * R::splat((RATIOS - 1) as f32);
        let below = position.clamp(R::zero(), R::splat((RATIOS - 2) as f32)).to_int();
        let above = below.wrapping_add(R::Int::splat(1));
        let [from, to] = [below, above].each(|i| R::gather(&self.ratios, i));
        (below, (ratio - from) / (to - from))
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
