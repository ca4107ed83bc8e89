//! Densities that are constant on equal cells of an interval or a rectangle, sampled by inverting
//! their cumulative sums [Pharr 2023 §A.4.7, §A.5.6].
//!
//! Values count by their magnitude; values that are not finite count as 0. If none is above 0 the
//! density is uniform, so that sampling and density still agree; [`PiecewiseConstant1d::integral`]
//! then is 0.

use lanes::{Each, Int, Mask, Real};
use math::{Bounds2, ONE_MINUS_EPSILON, Vec2};

/// A density over an interval.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant1d {
    table: Tables,
    integral: f32,
}

impl PiecewiseConstant1d {
    /// The density proportional to `values` on equal cells of [`min`, `max`].
    ///
    /// # Panics
    /// If there is no value, or `min` is not below `max`.
    pub fn new(values: &[f32], range: [f32; 2]) -> PiecewiseConstant1d {
        let mut table = Tables::new(values.len(), 1, range);
        let integral = table.push(values);
        PiecewiseConstant1d { table, integral }
    }

    /// The number of cells.
    #[expect(clippy::len_without_is_empty, reason = "a density has at least one cell")]
    pub fn len(&self) -> usize {
        self.table.cells
    }

    /// The integral of the given values over the interval.
    pub fn integral(&self) -> f32 {
        self.integral
    }

    /// A position, its density per length, and its cell.
    #[inline(always)]
    pub fn sample<R: Real>(&self, u: R) -> (R, R, R::Int) {
        self.table.sample(R::Int::splat(0), u)
    }

    /// The density at `x` per length; 0 outside of the interval.
    #[inline(always)]
    pub fn pdf<R: Real>(&self, x: R) -> R {
        self.table.pdf(R::Int::splat(0), x)
    }

    /// The `u` that [`sample`](Self::sample) sends to `x`; `None` outside of the interval.
    pub fn invert(&self, x: f32) -> Option<f32> {
        self.table.invert(0, x)
    }
}

/// Densities over the same interval, each with as many cells: the rows of tables.
#[derive(Clone, Debug)]
struct Tables {
    cells: usize,
    min: f32,
    max: f32,
    /// The density of each cell.
    densities: Vec<f32>,
    /// The cumulative distribution at the cells' edges, from 0 to 1: one more than cells.
    cdf: Vec<f32>,
    /// The guide table: for each of as many equal parts of [0, 1) as there are cells, the first
    /// cell to search from.
    guide: Vec<u32>,
}

impl Tables {
    /// No rows yet, but memory for `rows`.
    fn new(cells: usize, rows: usize, [min, max]: [f32; 2]) -> Self {
        assert!(cells > 0 && min < max, "a density needs at least one cell, and min < max");
        let [densities, cdf] = [cells, cells + 1].map(|numbers| Vec::with_capacity(numbers * rows));
        Self { cells, min, max, densities, cdf, guide: Vec::with_capacity(cells * rows) }
    }

    /// Appends the density proportional to `values`, and gives their integral.
    fn push(&mut self, values: &[f32]) -> f32 {
        let magnitude = |v: f32| if v.is_finite() { f64::from(v.abs()) } else { 0.0 };
        let cell_width = (self.max as f64 - self.min as f64) / self.cells as f64;
        let mut sum: f64 = values.iter().copied().map(magnitude).sum();
        let integral = (sum * cell_width) as f32;
        let is_uniform = sum == 0.0;
        if is_uniform {
            sum = self.cells as f64;
        }
        let value = |v: f32| if is_uniform { 1.0 } else { magnitude(v) };
        let scale = 1.0 / (sum * cell_width);
        self.densities.extend(values.iter().map(|&v| (value(v) * scale) as f32));
        let first = self.cdf.len();
        let mut up_to = 0.0;
        self.cdf.push(0.0);
        self.cdf.extend(values.iter().map(|&v| {
            up_to += value(v);
            (up_to / sum) as f32
        }));
        self.guide.extend(guide(&self.cdf[first..]));
        integral
    }

    /// A position, its density per length, and its cell in a row.
    #[inline(always)]
    fn sample<R: Real>(&self, row: R::Int, u: R) -> (R, R, R::Int) {
        let u = u.clamp(R::zero(), R::splat(ONE_MINUS_EPSILON));
        let [cells, last, one] = [self.cells, self.cells - 1, 1].each(|n| R::Int::splat(n as u32));
        let part = (u * R::splat(self.cells as f32)).to_int();
        let part = R::Int::select(part.lt(last), part, last);
        let first = row.wrapping_mul(cells);
        // A row of the cumulative distribution has one number more.
        let first_edge = first.wrapping_add(row);
        let mut cell = R::Int::gather(&self.guide, first.wrapping_add(part));
        let mut below = R::gather(&self.cdf, first_edge.wrapping_add(cell));
        let mut above = R::gather(&self.cdf, first_edge.wrapping_add(cell).wrapping_add(one));
        loop {
            let goes_on = u.ge(above) & cell.lt(last);
            if !goes_on.any() {
                break;
            }
            cell = R::Int::select(goes_on, cell.wrapping_add(one), cell);
            below = R::select(goes_on, above, below);
            above = R::gather(&self.cdf, first_edge.wrapping_add(cell).wrapping_add(one));
        }
        let width = above - below;
        let within = R::select(width.gt(R::zero()), (u - below) / width, R::splat(0.5));
        let t = (cell.to_real() + within) / R::splat(self.cells as f32);
        let density = R::gather(&self.densities, first.wrapping_add(cell));
        (math::lerp(t, R::splat(self.min), R::splat(self.max)), density, cell)
    }

    #[inline(always)]
    fn pdf<R: Real>(&self, row: R::Int, x: R) -> R {
        let is_inside = x.ge(R::splat(self.min)) & x.le(R::splat(self.max));
        let cell = row.wrapping_mul(R::Int::splat(self.cells as u32)).wrapping_add(self.cell(x));
        R::select(is_inside, R::gather(&self.densities, cell), R::zero())
    }

    fn invert(&self, row: usize, x: f32) -> Option<f32> {
        if x < self.min || x > self.max {
            return None;
        }
        let cell = self.cell(x) as usize;
        let within = (x - self.min) / (self.max - self.min) * self.cells as f32 - cell as f32;
        let edges = &self.cdf[row * (self.cells + 1) + cell..][..2];
        Some(math::lerp(within.clamp(0.0, 1.0), edges[0], edges[1]))
    }

    #[inline(always)]
    fn cell<R: Real>(&self, x: R) -> R::Int {
        part((x - R::splat(self.min)) / R::splat(self.max - self.min), self.cells)
    }
}

/// Which of `parts` equal parts of [0, 1) contains `u`.
#[inline(always)]
fn part<R: Real>(u: R, parts: usize) -> R::Int {
    let last = R::Int::splat(parts as u32 - 1);
    let part = (u * R::splat(parts as f32)).clamp(R::zero(), R::splat(parts as f32)).to_int();
    R::Int::select(part.lt(last), part, last)
}

/// The guide table of a cumulative distribution: from its entry, a linear search takes two steps on
/// average, whatever the distribution [Chen 1974].
fn guide(cdf: &[f32]) -> impl Iterator<Item = u32> {
    let parts = cdf.len() - 1;
    let mut cell = 0;
    (0..parts).map(move |i| {
        while cell + 1 < parts && (part(cdf[cell + 1], parts) as usize) < i {
            cell += 1;
        }
        cell as u32
    })
}

/// A density over a rectangle: the marginal of the rows, then a row's conditional density.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant2d {
    domain: Bounds2,
    rows: Tables,
    marginal: PiecewiseConstant1d,
}

impl PiecewiseConstant2d {
    /// The density proportional to `values`, `columns` to a row and the row of least y first, on
    /// equal cells of `domain`.
    ///
    /// # Panics
    /// If `values` are not whole rows, or none or 2³¹, or the domain has no area.
    pub fn new(values: &[f32], columns: usize, domain: Bounds2) -> PiecewiseConstant2d {
        assert!(columns > 0 && values.len().is_multiple_of(columns), "values must be whole rows");
        assert!(values.len() + values.len() / columns < 1 << 31, "values have indices of 31 bits");
        let mut rows = Tables::new(columns, values.len() / columns, [domain.min.x, domain.max.x]);
        let integrals: Vec<f32> = values.chunks_exact(columns).map(|row| rows.push(row)).collect();
        let marginal = PiecewiseConstant1d::new(&integrals, [domain.min.y, domain.max.y]);
        PiecewiseConstant2d { domain, rows, marginal }
    }

    /// The rectangle.
    pub fn domain(&self) -> Bounds2 {
        self.domain
    }

    /// Columns and rows.
    pub fn resolution(&self) -> [usize; 2] {
        [self.rows.cells, self.marginal.len()]
    }

    /// Cells, densities, and the cumulative distribution with one edge more, of the marginal of the
    /// rows and then of all rows, which come one after another.
    pub fn tables(&self) -> [(usize, &[f32], &[f32]); 2] {
        [&self.marginal.table, &self.rows].map(|table| (table.cells, &*table.densities, &*table.cdf))
    }

    /// The integral of the given values over the rectangle.
    pub fn integral(&self) -> f32 {
        self.marginal.integral()
    }

    /// A position, its density per area, and its cell as column and row.
    #[inline(always)]
    pub fn sample<R: Real>(&self, u: Vec2<R>) -> (Vec2<R>, R, [R::Int; 2]) {
        let (y, pdf_y, row) = self.marginal.sample(u.y);
        let (x, pdf_x, column) = self.rows.sample(row, u.x);
        (Vec2::new(x, y), pdf_x * pdf_y, [column, row])
    }

    /// The density at `p` per area; 0 outside of the rectangle.
    #[inline(always)]
    pub fn pdf<R: Real>(&self, p: Vec2<R>) -> R {
        self.marginal.pdf(p.y) * self.rows.pdf(self.marginal.table.cell(p.y), p.x)
    }

    /// The `u` that [`sample`](Self::sample) sends to `p`; `None` outside of the rectangle.
    pub fn invert(&self, p: Vec2) -> Option<Vec2> {
        let y = self.marginal.invert(p.y)?;
        let x = self.rows.invert(self.marginal.table.cell(p.y) as usize, p.x)?;
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
