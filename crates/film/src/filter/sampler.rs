//! Importance sampling of a filter through a table: the filter's support is cut into 32 cells per
//! pixel of radius along each axis, the filter is taken to be constant in each, and offsets are
//! drawn in proportion to its magnitude there [Pharr 2023 §8.8]. As the weight divides the same
//! table by its own density, it is ±∫|f|: samples differ in sign only.

use lanes::{Int, Real};
use math::{Bounds2, Vec2};
use sampling::PiecewiseConstant2d;

use super::FilterSample;

/// A table of a filter.
#[derive(Clone, Debug)]
pub struct FilterSampler {
    columns: usize,
    values: Vec<f32>,
    distribution: PiecewiseConstant2d,
}

impl FilterSampler {
    /// Tabulates `f` over `[−radius, radius]`.
    pub(super) fn new(radius: Vec2, f: impl Fn(Vec2) -> f32) -> Self {
        let domain = Bounds2::new(-radius, radius);
        let [columns, rows] = (radius * 32.0).to_array().map(|cells| (cells as usize).max(1));
        let at = |x: usize, y: usize| {
            f(domain.lerp(Vec2::new((x as f32 + 0.5) / columns as f32, (y as f32 + 0.5) / rows as f32)))
        };
        let values: Vec<f32> =
            (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect();
        let distribution = PiecewiseConstant2d::new(&values, columns, domain);
        Self { columns, values, distribution }
    }

    /// The distribution of offsets.
    pub fn distribution(&self) -> &PiecewiseConstant2d {
        &self.distribution
    }

    /// An offset with the density of the table's magnitude, from `u` in [0, 1)².
    #[inline(always)]
    pub fn sample<R: Real>(&self, u: Vec2<R>) -> FilterSample<R> {
        let (offset, pdf, [x, y]) = self.distribution.sample(u);
        let cell = y.wrapping_mul(R::Int::splat(self.columns as u32)).wrapping_add(x);
        FilterSample { offset, weight: R::gather(&self.values, cell) / pdf }
    }
}
