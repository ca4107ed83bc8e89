//! Densities over the unit square that are bilinear between the points of a grid, sampled by
//! inverting their cumulative integrals: the density of y first, which is linear from row to row,
//! then that of x in the row between two of the grid ([Dupuy 2018 §4]; [Pharr 2023 §9.8.2]).
//!
//! Several densities over the same grid are layers of one table. What is sampled is a weighted mean
//! of layers: its integrals are the weighted means of theirs.

use crate::warp::{invert_linear, sample_linear};
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

/// Layers with their weights, of the sum 1.
pub type LayerWeights<'a> = &'a [(usize, f32)];

/// A cell of the grid and a position in it.
struct Cell {
    column: usize,
    row: usize,
    x: f32,
    y: f32,
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
    pub fn sample(&self, u: Vec2, layers: LayerWeights) -> (Point2, f32) {
        let row = last(self.height - 1, |row| self.below(row, layers) <= u.y);
        let y = {
            let [a, b] = self.ends(row, layers);
            let left = u.y - self.below(row, layers);
            sample_linear(fraction(left, 0.5 * (a + b)), a, b)
        };
        let left_of = |column| lerp(y, self.row(row, column, layers), self.row(row + 1, column, layers));
        let wanted = u.x * left_of(self.width - 1);
        let column = last(self.width - 1, |column| left_of(column) <= wanted);
        let [a, b] = self.across(column, row, y, layers);
        let x = sample_linear(fraction(wanted - left_of(column), 0.5 * (a + b)), a, b);
        let p = Vec2::new(column as f32 + x, row as f32 + y) / self.cells();
        (p, lerp(x, a, b) * self.density_per_cell())
    }

    /// The density of a point of the square per area.
    pub fn pdf(&self, p: Point2, layers: LayerWeights) -> f32 {
        let Cell { column, row, x, y } = self.cell(p);
        let [a, b] = self.across(column, row, y, layers);
        lerp(x, a, b) * self.density_per_cell()
    }

    /// The `u` that [`sample`](Self::sample) sends to a point of the square, and its density.
    pub fn invert(&self, p: Point2, layers: LayerWeights) -> (Vec2, f32) {
        let Cell { column, row, x, y } = self.cell(p);
        let [a, b] = self.across(column, row, y, layers);
        let [first, last] = self.ends(row, layers);
        let left_of = lerp(y, self.row(row, column, layers), self.row(row + 1, column, layers));
        let u = Vec2::new(
            fraction(left_of + 0.5 * (a + b) * invert_linear(x, a, b), lerp(y, first, last)),
            self.below(row, layers) + 0.5 * (first + last) * invert_linear(y, first, last),
        );
        (u.clamp(Vec2::splat(0.0), Vec2::splat(1.0)), lerp(x, a, b) * self.density_per_cell())
    }

    /// The number of cells along x and y.
    fn cells(&self) -> Vec2 {
        Vec2::new((self.width - 1) as f32, (self.height - 1) as f32)
    }

    fn density_per_cell(&self) -> f32 {
        self.cells().x * self.cells().y
    }

    fn cell(&self, p: Point2) -> Cell {
        let at = p * self.cells();
        let (column, row) = ((at.x as usize).min(self.width - 2), (at.y as usize).min(self.height - 2));
        Cell { column, row, x: at.x - column as f32, y: at.y - row as f32 }
    }

    /// The integral over all rows below one.
    fn below(&self, row: usize, layers: LayerWeights) -> f32 {
        layers.iter().map(|&(layer, weight)| weight * self.columns[layer * self.height + row]).sum()
    }

    /// The integral over a row left of a column.
    fn row(&self, row: usize, column: usize, layers: LayerWeights) -> f32 {
        let index = |layer: usize| (layer * self.height + row) * self.width + column;
        layers.iter().map(|&(layer, weight)| weight * self.rows[index(layer)]).sum()
    }

    /// The integrals over the rows at both sides of a cell.
    fn ends(&self, row: usize, layers: LayerWeights) -> [f32; 2] {
        [row, row + 1].map(|row| self.row(row, self.width - 1, layers))
    }

    /// The density at both sides of a cell, between its rows.
    fn across(&self, column: usize, row: usize, y: f32, layers: LayerWeights) -> [f32; 2] {
        let value = |row: usize, column: usize| -> f32 {
            let index = |layer: usize| (layer * self.height + row) * self.width + column;
            layers.iter().map(|&(layer, weight)| weight * self.values[index(layer)]).sum()
        };
        [column, column + 1].map(|column| lerp(y, value(row, column), value(row + 1, column)))
    }
}

/// The last index below `count` for which an ascending property holds; 0 if there is none.
fn last(count: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, count);
    while high - low > 1 {
        let middle = low.midpoint(high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

/// A part of a whole, in [0, 1]; 0 of nothing.
fn fraction(part: f32, whole: f32) -> f32 {
    if whole > 0.0 { (part / whole).clamp(0.0, 1.0) } else { 0.0 }
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

    const MEANS: [LayerWeights; 5] =
        [&[(0, 1.0)], &[(1, 1.0)], &[(2, 1.0)], &[(0, 0.3), (1, 0.7)], &[(0, 0.2), (1, 0.5), (2, 0.3)]];

    #[test]
    fn samples_have_their_density() {
        let table = table();
        let test = Chi2 { bins: [18, 9], samples: 100_000, tests: MEANS.len(), ..Chi2::default() };
        for layers in MEANS {
            let sample = |u: [f32; 2]| Some(table.sample(u.into(), layers).0.to_array());
            let pdf = |p: [f32; 2]| f64::from(table.pdf(p.into(), layers));
            test.rectangle([[0.0, 1.0]; 2], sample, pdf).unwrap();
        }
    }

    #[test]
    fn densities_are_bilinear_with_the_integral_one() {
        let table = table();
        for layers in MEANS {
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
        for layers in MEANS {
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
        for layers in MEANS {
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
