//! Densities that are constant on equal cells of an interval or a rectangle, sampled by inverting
//! their cumulative sums [Pharr 2023 §A.4.7, §A.5.6].
//!
//! Values count by their magnitude; values that are not finite count as 0. If none is above 0 the
//! density is uniform, so that sampling and density still agree; [`PiecewiseConstant1d::integral`]
//! then is 0.

use math::{Bounds2, ONE_MINUS_EPSILON, Vec2};

/// A density over an interval.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant1d {
    values: Box<[f32]>,
    /// The cumulative distribution at the cells' edges, from 0 to 1.
    cdf: Box<[f32]>,
    /// The guide table: for each of as many equal parts of [0, 1) as there are cells, the first
    /// cell to search from.
    guide: Box<[u32]>,
    min: f32,
    max: f32,
    integral: f32,
    /// Densities per value.
    scale: f64,
}

impl PiecewiseConstant1d {
    /// The density proportional to `values` on equal cells of [`min`, `max`].
    ///
    /// # Panics
    /// If there is no value, or `min` is not below `max`.
    pub fn new(values: &[f32], [min, max]: [f32; 2]) -> PiecewiseConstant1d {
        assert!(!values.is_empty() && min < max, "a density needs at least one cell, and min < max");
        let mut values: Box<[f32]> =
            values.iter().map(|v| if v.is_finite() { v.abs() } else { 0.0 }).collect();
        let mut sum = 0.0f64;
        let mut sums = Vec::with_capacity(values.len() + 1);
        sums.push(0.0);
        for &value in &values {
            sum += value as f64;
            sums.push(sum);
        }
        let cell_width = (max as f64 - min as f64) / values.len() as f64;
        let integral = (sum * cell_width) as f32;
        if sum == 0.0 {
            values.fill(1.0);
            sums = (0..=values.len()).map(|i| i as f64).collect();
            sum = values.len() as f64;
        }
        let cdf: Box<[f32]> = sums.into_iter().map(|s| (s / sum) as f32).collect();
        let guide = guide(&cdf);
        PiecewiseConstant1d { values, cdf, guide, min, max, integral, scale: 1.0 / (sum * cell_width) }
    }

    /// The number of cells.
    #[expect(clippy::len_without_is_empty, reason = "a density has at least one cell")]
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// The integral of the given values over the interval.
    pub fn integral(&self) -> f32 {
        self.integral
    }

    /// A position, its density per length, and its cell.
    #[inline]
    pub fn sample(&self, u: f32) -> (f32, f32, usize) {
        let u = u.clamp(0.0, ONE_MINUS_EPSILON);
        let start = self.guide[part(u, self.len())] as usize;
        let last = self.len() - 1;
        let cell = (start..last).find(|&cell| u < self.cdf[cell + 1]).unwrap_or(last);
        let width = self.cdf[cell + 1] - self.cdf[cell];
        let within = if width > 0.0 { (u - self.cdf[cell]) / width } else { 0.5 };
        let t = (cell as f32 + within) / self.len() as f32;
        (math::lerp(t, self.min, self.max), self.cell_pdf(cell), cell)
    }

    /// The density at `x` per length; 0 outside of the interval.
    #[inline]
    pub fn pdf(&self, x: f32) -> f32 {
        if x < self.min || x > self.max { 0.0 } else { self.cell_pdf(self.cell(x)) }
    }

    /// The `u` that [`sample`](Self::sample) sends to `x`; `None` outside of the interval.
    pub fn invert(&self, x: f32) -> Option<f32> {
        if x < self.min || x > self.max {
            return None;
        }
        let cell = self.cell(x);
        let within = (x - self.min) / (self.max - self.min) * self.len() as f32 - cell as f32;
        Some(math::lerp(within.clamp(0.0, 1.0), self.cdf[cell], self.cdf[cell + 1]))
    }

    fn cell_pdf(&self, cell: usize) -> f32 {
        (self.values[cell] as f64 * self.scale) as f32
    }

    fn cell(&self, x: f32) -> usize {
        let t = (x - self.min) / (self.max - self.min);
        ((t * self.len() as f32) as usize).min(self.len() - 1)
    }
}

/// Which of `parts` equal parts of [0, 1) contains `u`.
#[inline]
fn part(u: f32, parts: usize) -> usize {
    ((u * parts as f32) as usize).min(parts - 1)
}

/// The guide table of a cumulative distribution: from its entry, a linear search takes two steps on
/// average, whatever the distribution [Chen 1974].
fn guide(cdf: &[f32]) -> Box<[u32]> {
    let parts = cdf.len() - 1;
    let mut cell = 0;
    (0..parts)
        .map(|i| {
            while cell + 1 < parts && part(cdf[cell + 1], parts) < i {
                cell += 1;
            }
            cell as u32
        })
        .collect()
}

/// A density over a rectangle: the marginal of the rows, then a row's conditional density.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant2d {
    domain: Bounds2,
    rows: Box<[PiecewiseConstant1d]>,
    marginal: PiecewiseConstant1d,
}

impl PiecewiseConstant2d {
    /// The density proportional to `values`, `columns` to a row and the row of least y first, on
    /// equal cells of `domain`.
    ///
    /// # Panics
    /// If `values` are not whole rows, or none, or the domain has no area.
    pub fn new(values: &[f32], columns: usize, domain: Bounds2) -> PiecewiseConstant2d {
        assert!(columns > 0 && values.len().is_multiple_of(columns), "values must be whole rows");
        let x_range = [domain.min.x, domain.max.x];
        let rows: Box<[_]> =
            values.chunks_exact(columns).map(|row| PiecewiseConstant1d::new(row, x_range)).collect();
        let integrals: Vec<f32> = rows.iter().map(PiecewiseConstant1d::integral).collect();
        let marginal = PiecewiseConstant1d::new(&integrals, [domain.min.y, domain.max.y]);
        PiecewiseConstant2d { domain, rows, marginal }
    }

    /// The rectangle.
    pub fn domain(&self) -> Bounds2 {
        self.domain
    }

    /// Columns and rows.
    pub fn resolution(&self) -> [usize; 2] {
        [self.rows[0].len(), self.rows.len()]
    }

    /// The integral of the given values over the rectangle.
    pub fn integral(&self) -> f32 {
        self.marginal.integral()
    }

    /// A position, its density per area, and its cell as column and row.
    #[inline]
    pub fn sample(&self, u: Vec2) -> (Vec2, f32, [usize; 2]) {
        let (y, pdf_y, row) = self.marginal.sample(u.y);
        let (x, pdf_x, column) = self.rows[row].sample(u.x);
        (Vec2::new(x, y), pdf_x * pdf_y, [column, row])
    }

    /// The density at `p` per area; 0 outside of the rectangle.
    #[inline]
    pub fn pdf(&self, p: Vec2) -> f32 {
        if !self.domain.contains(p) {
            return 0.0;
        }
        let row = self.marginal.cell(p.y);
        self.marginal.cell_pdf(row) * self.rows[row].pdf(p.x)
    }

    /// The `u` that [`sample`](Self::sample) sends to `p`; `None` outside of the rectangle.
    pub fn invert(&self, p: Vec2) -> Option<Vec2> {
        let y = self.marginal.invert(p.y)?;
        let x = self.rows[self.marginal.cell(p.y)].invert(p.x)?;
        Some(Vec2::new(x, y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::{Chi2, Random};

    #[test]
    fn samples_of_an_interval_have_the_density() {
        let density = PiecewiseConstant1d::new(&[0.0, 2.0, 0.0, -1.0, 4.0, 0.0], [-1.0, 2.0]);
        assert!((density.integral() - 3.5).abs() < 1e-6);
        Chi2 { bins: [12, 5], ..Chi2::default() }
            .interval([-1.0, 2.0], |u| Some(density.sample(u).0), |x| density.pdf(x) as f64)
            .unwrap();
        let mut random = Random::new(3);
        for u in (0..1000).map(|_| random.get_1d()).chain([0.0, ONE_MINUS_EPSILON]) {
            let (x, pdf, cell) = density.sample(u);
            assert!(pdf > 0.0 && [1, 3, 4].contains(&cell), "u = {u}");
            assert!((density.invert(x).unwrap() - u).abs() < 1e-5);
        }
        assert_eq!((density.pdf(-1.1), density.pdf(2.1), density.invert(2.1)), (0.0, 0.0, None));
    }

    fn grid() -> PiecewiseConstant2d {
        #[rustfmt::skip]
        let values = [
            0.0, 0.0, 0.0, 0.0,
            1.0, 0.0, 3.0, 0.5,
            0.0, 0.0, 0.0, 0.0,
            0.0, 6.0, 0.0, 0.0,
            f32::NAN, 0.0, 2.0, 0.0,
        ];
        PiecewiseConstant2d::new(&values, 4, Bounds2::new(Vec2::new(1.0, -1.0), Vec2::new(3.0, 0.0)))
    }

    #[test]
    fn samples_of_a_rectangle_have_the_density() {
        let density = grid();
        assert!((density.integral() - 12.5 * 0.1).abs() < 1e-6);
        let sample = |u: [f32; 2]| Some(density.sample(Vec2::from(u)).0.to_array());
        Chi2 { bins: [16, 20], ..Chi2::default() }
            .rectangle([[1.0, 3.0], [-1.0, 0.0]], sample, |p| density.pdf(Vec2::from(p)) as f64)
            .unwrap();
        let mut random = Random::new(4);
        for _ in 0..1000 {
            let u = Vec2::from(random.get_2d());
            let (p, pdf, [column, row]) = density.sample(u);
            assert!(pdf > 0.0 && column < 4 && [1, 3, 4].contains(&row));
            assert!((density.invert(p).unwrap() - u).abs().max_element() < 1e-5);
        }
    }

    #[test]
    fn zeros_are_sampled_uniformly() {
        let density = PiecewiseConstant2d::new(&[0.0; 6], 3, Bounds2::UNIT);
        assert_eq!(density.integral(), 0.0);
        let (p, pdf, cell) = density.sample(Vec2::new(0.25, 0.75));
        assert!((p - Vec2::new(0.25, 0.75)).length() < 1e-6);
        assert_eq!((pdf, density.pdf(p), cell), (1.0, 1.0, [0, 1]));
    }

    #[test]
    fn values_too_small_for_their_integral_keep_their_density() {
        let density = PiecewiseConstant1d::new(&[1e-40, 3e-40], [0.0, 1e-9]);
        assert!((density.pdf(0.9e-9) / 1.5e9 - 1.0).abs() < 1e-3);
        assert!((density.sample(0.125).0 - 0.25e-9).abs() < 1e-12);
    }

    #[test]
    fn many_small_cells_are_all_reached() {
        let density = PiecewiseConstant1d::new(&vec![1e-30; 100_000], [0.0, 1.0]);
        assert!((density.sample(0.5).0 - 0.5).abs() < 1e-5);
        assert!((density.pdf(0.3) - 1.0).abs() < 1e-4);
    }
}
