//! The nodes of tables of microfacets: roughnesses √α evenly from 0 to 1, and cosines that are
//! squares, as everything is steep at grazing angles.

use crate::TrowbridgeReitz;
use lanes::{Int, Real};
use math::{Vec3, Vector3, safe_sqrt, sqr};

/// Cosines, the squares of 0, 1/18, … 1.
const COSINES: usize = 19;
/// Roughnesses.
const ROUGHNESSES: usize = 21;

/// A value for each roughness and cosine.
#[derive(Clone, Debug)]
pub(crate) struct Grid<T>(Vec<T>);

impl<T> Grid<T> {
    /// The values of a function of roughness and cosine.
    pub fn new(value: impl Fn(f32, f32) -> T) -> Self {
        let part = |i: usize, len: usize| i as f32 / (len - 1) as f32;
        let node = |i: usize| value(part(i / COSINES, ROUGHNESSES), sqr(part(i % COSINES, COSINES)));
        Self((0..ROUGHNESSES * COSINES).map(node).collect())
    }

    /// All values, a row for each roughness.
    pub fn values(&self) -> &[T] {
        &self.0
    }

    /// The four nodes around a roughness and a cosine, with their weights.
    pub fn around(&self, roughness: f32, cosine: f32) -> [(f32, &T); 4] {
        let [r, c] = [Place::new(roughness, ROUGHNESSES), Place::new(safe_sqrt(cosine), COSINES)];
        let node = |i: usize, j: usize| {
            let weight = r.weights()[i] * c.weights()[j];
            (weight, &self.0[(r.index as usize + i) * COSINES + c.index as usize + j])
        };
        [node(0, 0), node(0, 1), node(1, 0), node(1, 1)]
    }
}

/// An interval between nodes, and where in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<R: Real = f32> {
    /// Its first node.
    pub index: R::Int,
    /// The weight of the second node.
    pub t: R,
}

impl<R: Real> Place<R> {
    /// Of `x` in [0, 1] among `len` nodes.
    #[inline(always)]
    pub fn new(x: R, len: usize) -> Self {
        Self::among(x.clamp(R::zero(), R::one()) * R::splat((len - 1) as f32), len)
    }

    /// Of a place given in nodes, of which there are `len`.
    #[inline(always)]
    pub fn among(x: R, len: usize) -> Self {
        let lower = x.floor().min(R::splat((len - 2) as f32));
        Self { index: lower.to_int(), t: x - lower }
    }

    /// The first node, or the next one, and its weight.
    #[inline(always)]
    pub fn node(self, is_second: bool) -> (R::Int, R) {
        match is_second {
            true => (self.index.wrapping_add(R::Int::splat(1)), self.t),
            false => (self.index, R::one() - self.t),
        }
    }

    /// The weights of both nodes.
    #[inline(always)]
    pub fn weights(self) -> [R; 2] {
        [R::one() - self.t, self.t]
    }
}

/// The nodes x and weights w of ∫ 2μ f(μ) dμ from 0 to 1 by six nodes of Gauss in √μ, the mean of f
/// over the directions of a hemisphere by their cosine.
pub(crate) fn nodes() -> [(f32, f32); 6] {
    const GAUSS: [(f32, f32); 3] =
        [(0.238_619_2, 0.467_913_93), (0.661_209_4, 0.360_761_57), (0.932_469_5, 0.171_324_49)];
    std::array::from_fn(|i| {
        let (x, weight) = GAUSS[i / 2];
        let root = 0.5 * (1.0 + if i % 2 == 0 { x } else { -x });
        (sqr(root), 2.0 * root * sqr(root) * weight)
    })
}

/// Facets of a roughness that are alike both ways.
pub(crate) fn round(roughness: f32) -> TrowbridgeReitz {
    TrowbridgeReitz::new(sqr(roughness), sqr(roughness))
}

/// A direction of a cosine.
pub(crate) fn from(cosine: f32) -> Vector3 {
    let cosine = cosine.max(1e-4);
    Vec3::new(safe_sqrt(1.0 - sqr(cosine)), 0.0, cosine)
}
