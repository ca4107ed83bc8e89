//! A density that is constant on equal cells of the unit square, sampled within any window of it:
//! the sums of all cells below and left of each corner (a summed-area table, [Crow 1984]) give the
//! integral over any rectangle, and cumulative distributions are inverted by bisection
//! ([Bitterli 2015]; [Pharr 2023 §A.5.6]).

use math::{Bounds2, ONE_MINUS_EPSILON, Point2, Vec2};

/// A density over any window of the unit square, in proportion to the values of cells.
#[derive(Clone, Debug)]
pub struct WindowedPiecewiseConstant2d {
    values: Vec<f32>,
    /// Of corner (x, y): the sum of the values of the cells before column x and row y. The rows
    /// have `columns` + 1 corners.
    sums: Vec<f64>,
    columns: usize,
    rows: usize,
}

impl WindowedPiecewiseConstant2d {
    /// Bytes per cell that [`Self::new`] keeps.
    pub const BYTES_PER_CELL: usize = 12;

    /// The density proportional to `values`, `columns` to a row. Values that are not finite or not
    /// above 0 count as 0.
    ///
    /// # Panics
    /// If `values` are not whole rows, or none.
    pub fn new(mut values: Vec<f32>, columns: usize) -> Self {
        assert!(columns > 0 && !values.is_empty(), "a density needs at least one cell");
        assert!(values.len().is_multiple_of(columns), "values must be whole rows");
        let rows = values.len() / columns;
        values.iter_mut().for_each(|v| *v = if v.is_finite() { v.max(0.0) } else { 0.0 });
        let mut sums = vec![0.0; (columns + 1) * (rows + 1)];
        for (y, row) in values.chunks_exact(columns).enumerate() {
            let mut sum = 0.0;
            for (x, &value) in row.iter().enumerate() {
                sum += f64::from(value);
                let corner = (y + 1) * (columns + 1) + x + 1;
                sums[corner] = sums[corner - columns - 1] + sum;
            }
        }
        Self { values, sums, columns, rows }
    }

    /// The integral of the values over a window in the unit square.
    pub fn integral(&self, window: Bounds2) -> f64 {
        let [x, y] = ranges(window);
        let up_to = |x: f64| self.sum(x, y[1]) - self.sum(x, y[0]);
        (up_to(x[1]) - up_to(x[0])) / (self.columns * self.rows) as f64
    }

    /// A position in a window and its density per area; `None` if all values there are 0.
    pub fn sample(&self, u: Vec2, window: Bounds2) -> Option<(Point2, f32)> {
        let integral = self.integral(window);
        if integral <= 0.0 {
            return None;
        }
        let [xs, ys] = ranges(window);
        let (x, column) = invert(u.x, xs, self.columns, |x| self.sum(x, ys[1]) - self.sum(x, ys[0]))?;
        let (left, right) = (column as f64, (column + 1) as f64);
        let edge = |x: f64, y: f64| self.sum(x / self.columns as f64, y);
        let (y, row) = invert(u.y, ys, self.rows, |y| edge(right, y) - edge(left, y))?;
        let value = self.values[row * self.columns + column];
        let p = Vec2::new(x as f32, y as f32).clamp(window.min, window.max);
        (value > 0.0).then(|| (p, (f64::from(value) / integral) as f32))
    }

    /// The density per area with which [`sample`](Self::sample) chooses `p` in a window; 0 outside
    /// of the window.
    pub fn pdf(&self, p: Point2, window: Bounds2) -> f32 {
        let integral = self.integral(window);
        if integral <= 0.0 || !window.contains(p) {
            return 0.0;
        }
        let cell = |x: f32, cells: usize| ((x * cells as f32) as usize).min(cells - 1);
        let value = self.values[cell(p.y, self.rows) * self.columns + cell(p.x, self.columns)];
        (f64::from(value) / integral) as f32
    }

    /// The sum of the values below and left of a position, where a cell that it divides counts by
    /// its part there.
    fn sum(&self, x: f64, y: f64) -> f64 {
        let ((column, dx), (row, dy)) = (split(x, self.columns), split(y, self.rows));
        let corner = row * (self.columns + 1) + column;
        let along = |corner: usize| {
            let [a, b] = [self.sums[corner], self.sums[corner + 1]];
            a + dx * (b - a)
        };
        let [a, b] = [along(corner), along(corner + self.columns + 1)];
        a + dy * (b - a)
    }
}

/// The cell that contains a position, and how far the position lies across it.
fn split(x: f64, cells: usize) -> (usize, f64) {
    let x = x.clamp(0.0, 1.0) * cells as f64;
    let cell = (x as usize).min(cells - 1);
    (cell, x - cell as f64)
}

fn ranges(window: Bounds2) -> [[f64; 2]; 2] {
    let (min, max) = (window.min.as_dvec2(), window.max.as_dvec2());
    [[min.x, max.x], [min.y, max.y]]
}

/// The position in a range below which lies the part `u` of the mass there, and its cell. `mass` is
/// linear within cells. `None` if there is no mass.
fn invert(u: f32, range: [f64; 2], cells: usize, mass: impl Fn(f64) -> f64) -> Option<(f64, usize)> {
    let (before, after) = (mass(range[0]), mass(range[1]));
    let u = f64::from(u.clamp(0.0, ONE_MINUS_EPSILON));
    let target = before + u * (after - before);
    let [mut first, mut last] = range.map(|x| split(x, cells).0);
    let edge = |cell: usize| (cell as f64 / cells as f64).clamp(range[0], range[1]);
    while first < last {
        let middle = (first + last) / 2;
        if mass(edge(middle + 1)) > target {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    let [low, high] = [edge(first), edge(first + 1)];
    let [below, above] = [low, high].map(mass);
    let within = ((target - below) / (above - below)).clamp(0.0, 1.0);
    (above > below).then_some((low + (high - low) * within, first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::{Chi2, Random};

    fn grid() -> WindowedPiecewiseConstant2d {
        #[rustfmt::skip]
        let values = vec![
            0.0, 1.0, 0.0, 2.0,
            1.0, 0.0, 3.0, 0.5,
            0.0, -1.0, f32::NAN, 0.0,
            4.0, 6.0, 0.0, 0.25,
        ];
        WindowedPiecewiseConstant2d::new(values, 4)
    }

    fn window(x: [f32; 2], y: [f32; 2]) -> Bounds2 {
        Bounds2::new(Vec2::new(x[0], y[0]), Vec2::new(x[1], y[1]))
    }

    #[test]
    fn samples_of_windows_have_the_density() {
        let density = grid();
        // The whole square, a window within a cell, windows along edges and across cells.
        let ranges = [[0.0, 1.0], [0.05, 0.2], [0.25, 0.75], [0.1, 0.9], [0.7, 1.0]];
        for (i, x) in ranges.into_iter().enumerate() {
            for y in [ranges[i], [0.0, 0.4], [0.3, 0.9], [0.8, 0.95]] {
                let window = window(x, y);
                if density.integral(window) == 0.0 {
                    assert_eq!(density.sample(Vec2::splat(0.5), window), None);
                    assert_eq!(density.pdf(window.min, window), 0.0);
                    continue;
                }
                let sample = |u: [f32; 2]| Some(density.sample(Vec2::from(u), window)?.0.to_array());
                Chi2 { bins: [10, 10], tests: 20, ..Chi2::default() }
                    .rectangle([x, y], sample, |p| density.pdf(Vec2::from(p), window).into())
                    .unwrap();
            }
        }
    }

    #[test]
    fn samples_agree_with_their_pdf() {
        let (density, mut random) = (grid(), Random::new(5));
        for _ in 0..2000 {
            let [a, b, u] = [(); 3].map(|()| Vec2::from(random.get_2d()));
            let window = Bounds2::new(a, b);
            let Some((p, pdf)) = density.sample(u, window) else { continue };
            assert!(window.contains(p) && pdf > 0.0);
            let expected = density.pdf(p, window);
            // At the edge of a cell, rounding decides which one it is.
            assert!(expected == pdf || (p * 4.0 - (p * 4.0).map(f32::round)).abs().min_element() < 1e-4);
            let outside = window.max + Vec2::splat(0.01);
            assert_eq!(density.pdf(outside, window), 0.0);
        }
    }

    #[test]
    fn small_windows_beside_a_bright_cell_keep_their_precision() {
        let mut values = vec![1e-3; 256 * 256];
        values[0] = 1e6;
        let density = WindowedPiecewiseConstant2d::new(values, 256);
        let window = window([0.7, 0.7001], [0.6, 0.6001]);
        let expected = 1e-3 * f64::from(window.max.x - window.min.x) * f64::from(window.max.y - window.min.y);
        assert!((density.integral(window) / expected - 1.0).abs() < 0.01, "{}", density.integral(window));
    }
}
