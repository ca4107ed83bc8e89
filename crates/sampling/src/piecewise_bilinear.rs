//! Densities over the unit square that are bilinear between the points of a grid, sampled by
//! inverting their cumulative integrals: the density of y first, which is linear from row to row,
//! then that of x in the row between two of the grid ([Dupuy 2018 §4]; [Pharr 2023 §9.8.2]).
//!
//! Several densities over the same grid are layers of one table. What is sampled is a weighted mean
//! of layers: its integrals are the weighted means of theirs.

use crate::warp::{invert_linear, sample_linear};
use lanes::{Each, Int, Real};
use math::{Point2, Vec2, lerp};

/// Layers of densities over a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseBilinear2d {
    width: usize,
    height: usize,
    /// The density at each point, per cell of the grid, by layer, row and column.
    values: Vec<f32>,
    /// Its integral over the row from x = 0 to each point.
    rows: Vec<f32>,
    /// The integral over all of the square from y = 0 to each row, by layer.
    columns: Vec<f32>,
}

/// Up to four layers with their weights, of the sum 1, for each lane.
#[derive(Clone, Copy, Debug)]
pub struct LayerWeights<R: Real = f32> {
    /// The layers.
    pub layers: [R::Int; 4],
    /// Their weights.
    pub weights: [R; 4],
    /// How many of them count.
    pub count: usize,
}

/// A cell of the grid and a position in it.
struct Cell<R: Real> {
    column: R::Int,
    row: R::Int,
    x: R,
    y: R,
}

impl PiecewiseBilinear2d {
    /// The densities proportional to `values`, layers of `height` rows, from y = 0 on, of `width`
    /// values each, from x = 0 to 1. Values below 0 count as 0; a layer without any above 0 is
    /// uniform.
    ///
    /// # Panics
    /// If there are less than two rows or columns, or the last layer is not complete.
    pub fn new([width, height]: [usize; 2], values: &[f32]) -> Self {
        assert!(width >= 2 && height >= 2, "a grid has at least one cell");
        let points = width * height;
        assert!(values.len().is_multiple_of(points), "layers have a value at each point");
        let layers = values.len() / points;
        let mut table = Self {
            width,
            height,
            values: Vec::with_capacity(layers * points),
            rows: Vec::with_capacity(layers * points),
            columns: Vec::with_capacity(layers * height),
        };
        values.chunks_exact(points).for_each(|layer| table.push(layer));
        table
    }

    /// The points along x and y.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The densities per cell at all points, their integrals over each row from x = 0 to each
    /// point, and from y = 0 to each row: all by layer.
    pub fn numbers(&self) -> [&[f32]; 3] {
        [&self.values, &self.rows, &self.columns]
    }

    fn push(&mut self, layer: &[f32]) {
        let positive = layer.iter().map(|&value| f64::from(value.max(0.0)));
        let mut values: Vec<f64> = positive.collect();
        if values.iter().all(|&value| value == 0.0) {
            values.fill(1.0);
        }
        let mut rows = Vec::with_capacity(values.len());
        let mut columns = Vec::with_capacity(self.height);
        let (mut total, mut row_before) = (0.0, None);
        for row in values.chunks_exact(self.width) {
            let mut sum = 0.0;
            rows.push(0.0);
            for pair in row.windows(2) {
                sum += 0.5 * (pair[0] + pair[1]);
                rows.push(sum);
            }
            total += row_before.replace(sum).map_or(0.0, |before| 0.5 * (before + sum));
            columns.push(total);
        }
        let normalized = |values: Vec<f64>| values.into_iter().map(move |value| (value / total) as f32);
        self.values.extend(normalized(values));
        self.rows.extend(normalized(rows));
        self.columns.extend(normalized(columns));
    }

    /// A point of the square for `u` in [0, 1)², and its density per area.
    #[inline(always)]
    pub fn sample<R: Real>(&self, u: Vec2<R>, layers: &LayerWeights<R>) -> (Point2<R>, R) {
        // Binary searches for the last row and the last column that begin before the number.
        let (mut row, mut step) = (R::Int::splat(0), first_step(self.height - 1));
        while step > 0 {
            let next = row.wrapping_add(R::Int::splat(step));
            let is_cell = next.lt(R::Int::splat(self.height as u32 - 1));
            let next = R::Int::select(is_cell, next, row);
            row = R::Int::select(self.below(next, layers).le(u.y), next, row);
            step /= 2;
        }
        let [first, last] = self.ends(row, layers);
        let left = u.y - self.below(row, layers);
        let y = sample_linear(fraction(left, R::splat(0.5) * (first + last)), first, last);
        let wanted = u.x * lerp(y, first, last);
        let (mut column, mut step) = (R::Int::splat(0), first_step(self.width - 1));
        while step > 0 {
            let next = column.wrapping_add(R::Int::splat(step));
            let is_cell = next.lt(R::Int::splat(self.width as u32 - 1));
            let next = R::Int::select(is_cell, next, column);
            column = R::Int::select(self.left_of(next, row, y, layers).le(wanted), next, column);
            step /= 2;
        }
        let [a, b] = self.across(column, row, y, layers);
        let left = wanted - self.left_of(column, row, y, layers);
        let x = sample_linear(fraction(left, R::splat(0.5) * (a + b)), a, b);
        let [columns, rows] = self.cells();
        let p = Vec2::new((column.to_real() + x) / columns, (row.to_real() + y) / rows);
        (p, lerp(x, a, b) * (columns * rows))
    }

    /// The density of a point of the square per area.
    #[inline(always)]
    pub fn pdf<R: Real>(&self, p: Point2<R>, layers: &LayerWeights<R>) -> R {
        let Cell { column, row, x, y } = self.cell(p);
        let [a, b] = self.across(column, row, y, layers);
        let [columns, rows] = self.cells::<R>();
        lerp(x, a, b) * (columns * rows)
    }

    /// The `u` that [`sample`](Self::sample) sends to a point of the square, and its density.
    #[inline(always)]
    pub fn invert<R: Real>(&self, p: Point2<R>, layers: &LayerWeights<R>) -> (Vec2<R>, R) {
        let Cell { column, row, x, y } = self.cell(p);
        let [a, b] = self.across(column, row, y, layers);
        let [first, last] = self.ends(row, layers);
        let half = R::splat(0.5);
        let left = self.left_of(column, row, y, layers) + half * (a + b) * invert_linear(x, a, b);
        let below = self.below(row, layers) + half * (first + last) * invert_linear(y, first, last);
        let u = Vec2::new(fraction(left, lerp(y, first, last)), below.clamp(R::zero(), R::one()));
        let [columns, rows] = self.cells::<R>();
        (u, lerp(x, a, b) * (columns * rows))
    }

    /// The number of cells along x and y.
    #[inline(always)]
    fn cells<R: Real>(&self) -> [R; 2] {
        [R::splat((self.width - 1) as f32), R::splat((self.height - 1) as f32)]
    }

    #[inline(always)]
    fn cell<R: Real>(&self, p: Point2<R>) -> Cell<R> {
        let [columns, rows] = self.cells();
        let (x, y) = (p.x * columns, p.y * rows);
        let column = x.floor().clamp(R::zero(), columns - R::one());
        let row = y.floor().clamp(R::zero(), rows - R::one());
        Cell { column: column.to_int(), row: row.to_int(), x: x - column, y: y - row }
    }

    /// The integral over all rows below one.
    #[inline(always)]
    fn below<R: Real>(&self, row: R::Int, layers: &LayerWeights<R>) -> R {
        let height = R::Int::splat(self.height as u32);
        let mut sum = R::zero();
        for i in 0..layers.count {
            let (layer, weight) = (layers.layers[i], layers.weights[i]);
            sum += weight * R::gather(&self.columns, layer.wrapping_mul(height).wrapping_add(row));
        }
        sum
    }

    /// The integral left of a column over the line at `y` between two rows.
    #[inline(always)]
    fn left_of<R: Real>(&self, column: R::Int, row: R::Int, y: R, layers: &LayerWeights<R>) -> R {
        let [low, high] = self.pair(&self.rows, column, row, layers);
        lerp(y, low, high)
    }

    /// The integrals over the rows at both sides of a cell.
    #[inline(always)]
    fn ends<R: Real>(&self, row: R::Int, layers: &LayerWeights<R>) -> [R; 2] {
        self.pair(&self.rows, R::Int::splat(self.width as u32 - 1), row, layers)
    }

    /// Numbers of a column in a row and in the next one.
    #[inline(always)]
    fn pair<R: Real>(
        &self,
        numbers: &[f32],
        column: R::Int,
        row: R::Int,
        layers: &LayerWeights<R>,
    ) -> [R; 2] {
        let width = R::Int::splat(self.width as u32);
        let (mut low, mut high) = (R::zero(), R::zero());
        for i in 0..layers.count {
            let (layer, weight) = (layers.layers[i], layers.weights[i]);
            let index = self.index(layer, row).wrapping_add(column);
            low += weight * R::gather(numbers, index);
            high += weight * R::gather(numbers, index.wrapping_add(width));
        }
        [low, high]
    }

    /// The density at both sides of a cell, between its rows.
    #[inline(always)]
    fn across<R: Real>(&self, column: R::Int, row: R::Int, y: R, layers: &LayerWeights<R>) -> [R; 2] {
        let width = R::Int::splat(self.width as u32);
        let mut sums = [[R::zero(); 2]; 2];
        for i in 0..layers.count {
            let (layer, weight) = (layers.layers[i], layers.weights[i]);
            let index = self.index(layer, row).wrapping_add(column);
            let low = R::gather_rows::<2>(&self.values, index);
            let high = R::gather_rows::<2>(&self.values, index.wrapping_add(width));
            for side in 0..2 {
                sums[0][side] += weight * low[side];
                sums[1][side] += weight * high[side];
            }
        }
        [lerp(y, sums[0][0], sums[1][0]), lerp(y, sums[0][1], sums[1][1])]
    }

    /// Where a row of a layer begins.
    #[inline(always)]
    fn index<I: Int>(&self, layer: I, row: I) -> I {
        let [width, height] = [self.width, self.height].each(|size| I::splat(size as u32));
        layer.wrapping_mul(height).wrapping_add(row).wrapping_mul(width)
    }
}

/// The first step of a binary search among so many: the largest power of two below, or 0.
fn first_step(count: usize) -> u32 {
    (count as u32).next_power_of_two() / 2
}

/// A part of a whole, in [0, 1]; 0 of nothing.
#[inline(always)]
fn fraction<R: Real>(part: R, whole: R) -> R {
    let part = (part / whole).clamp(R::zero(), R::one());
    R::select(whole.gt(R::zero()), part, R::zero())
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::{Chi2, Random, integrate};

    const SIZE: [usize; 2] = [7, 4];

    /// Three layers, of which the second has rows and columns of zeros, and the third nothing.
    fn table() -> PiecewiseBilinear2d {
        let mut random = Random::new(3);
        let mut values: Vec<f32> = (0..3 * 28).map(|_| random.get_1d() * 4.0).collect();
        values[28..42].fill(0.0);
        (28..56).step_by(7).for_each(|i| values[i + 3..i + 5].fill(0.0));
        values[56..].fill(-1.0);
        PiecewiseBilinear2d::new(SIZE, &values)
    }

    const MEANS: [LayerWeights; 5] = [
        LayerWeights { layers: [0; 4], weights: [1.0, 0.0, 0.0, 0.0], count: 1 },
        LayerWeights { layers: [1; 4], weights: [1.0, 0.0, 0.0, 0.0], count: 1 },
        LayerWeights { layers: [2; 4], weights: [1.0, 0.0, 0.0, 0.0], count: 1 },
        LayerWeights { layers: [0, 1, 0, 0], weights: [0.3, 0.7, 0.0, 0.0], count: 2 },
        LayerWeights { layers: [0, 1, 2, 0], weights: [0.2, 0.5, 0.3, 0.0], count: 3 },
    ];

    #[test]
    fn samples_have_their_density() {
        let table = table();
        let test = Chi2 { bins: [18, 9], samples: 100_000, tests: MEANS.len(), ..Chi2::default() };
        for layers in &MEANS {
            let sample = |u: [f32; 2]| Some(table.sample(u.into(), layers).0.to_array());
            let pdf = |p: [f32; 2]| f64::from(table.pdf(p.into(), layers));
            test.rectangle([[0.0, 1.0]; 2], sample, pdf).unwrap();
        }
    }

    #[test]
    fn densities_are_bilinear_with_the_integral_one() {
        let table = table();
        for layers in &MEANS {
            let pdf = |x: f64, y: f64| f64::from(table.pdf(Vec2::new(x as f32, y as f32), layers));
            let mut total = 0.0;
            for cell in 0..18 {
                let (x, y) = (f64::from(cell % 6), f64::from(cell / 6));
                let cell = [[x / 6.0, (x + 1.0) / 6.0], [y / 3.0, (y + 1.0) / 3.0]];
                let corners = cell[0].iter().flat_map(|&x| cell[1].map(|y| pdf(x, y)));
                let mean = corners.sum::<f64>() / 4.0;
                let found = integrate(&pdf, cell, 1e-4) * 18.0;
                assert!((found - mean).abs() < 1e-3, "{found} {mean}");
                total += found / 18.0;
            }
            assert!((total - 1.0).abs() < 1e-4, "{layers:?}: {total}");
        }
    }

    #[test]
    fn the_inverse_finds_the_sample() {
        let table = table();
        let mut random = Random::new(4);
        for layers in &MEANS {
            for _ in 0..2000 {
                let u = Vec2::from(random.get_2d());
                let (p, density) = table.sample(u, layers);
                let (again, same) = table.invert(p, layers);
                // Where the density is low, places differ by rounding.
                assert!((again - u).length() < 1e-5, "{u} {again}");
                assert!((density - same).abs() < 1e-3 * (1.0 + density), "{density} {same}");
                assert!((table.pdf(p, layers) - same).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn borders_of_the_square_are_sampled() {
        let table = table();
        for layers in &MEANS {
            for u in [Vec2::new(0.0, 0.0), Vec2::splat(math::ONE_MINUS_EPSILON)] {
                let (p, density) = table.sample(u, layers);
                assert!(p.min_element() >= 0.0 && p.max_element() <= 1.0 && density.is_finite(), "{p}");
            }
            for p in [Vec2::new(0.0, 0.0), Vec2::splat(1.0)] {
                let (u, density) = table.invert(p, layers);
                assert!((u - p).length() < 1e-6 && density.is_finite(), "{u} {p}");
            }
        }
    }
}
