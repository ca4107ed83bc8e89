//! Adaptive quadrature over a rectangle.
//!
//! A cell is integrated by Simpson's rule, once whole and once in quarters; where these differ by
//! more than the tolerance, the quarters are refined recursively. The rule has nodes on the
//! boundary of each cell, so that no straight discontinuity lies between them unnoticed;
//! discontinuities are resolved to a fine width.

/// The least and greatest number of subdivisions.
const MIN_DEPTH: u32 = 1;
const MAX_DEPTH: u32 = 9;
/// The least number of subdivisions where all nodes of the usual grid have missed the support of
/// the density.
const SEARCH_DEPTH: u32 = 6;

/// The values of `f` at three nodes along each coordinate.
type Nodes = [[f64; 3]; 3];

/// ∬ `f` over `[x0, x1] × [y0, y1]`, given as `[[x0, x1], [y0, y1]]`, to about `tolerance`.
pub fn integrate(f: &impl Fn(f64, f64) -> f64, cell: [[f64; 2]; 2], tolerance: f64) -> f64 {
    refine(f, cell, &nodes(f, cell), 0.1 * tolerance, [MIN_DEPTH, MAX_DEPTH])
}

/// As [`integrate`], for a cell where `f` is known not to be 0 everywhere.
pub(crate) fn search(f: &impl Fn(f64, f64) -> f64, cell: [[f64; 2]; 2], tolerance: f64) -> f64 {
    refine(f, cell, &nodes(f, cell), 0.1 * tolerance, [SEARCH_DEPTH, MAX_DEPTH])
}

/// The integral over a cell by its quarters, whose nodes include those of the cell.
fn refine(
    f: &impl Fn(f64, f64) -> f64,
    cell: [[f64; 2]; 2],
    coarse: &Nodes,
    tolerance: f64,
    depths: [u32; 2],
) -> f64 {
    let mut fine = [[0.0; 5]; 5];
    for (i, row) in fine.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            let is_known = i % 2 == 0 && j % 2 == 0;
            *value = if is_known { coarse[i / 2][j / 2] } else { at(f, cell, [i, j], 4) };
        }
    }
    let parts = quarters(cell).map(|([i, j], part)| {
        let nodes: Nodes = std::array::from_fn(|k| std::array::from_fn(|l| fine[2 * i + k][2 * j + l]));
        (part, nodes)
    });
    let sum: f64 = parts.iter().map(|(part, nodes)| simpson(nodes, *part)).sum();
    let converged = depths[0] == 0 && (sum - simpson(coarse, cell)).abs() <= tolerance;
    if converged || depths[1] == 0 || !sum.is_finite() {
        return sum;
    }
    let depths = depths.map(|depth| depth.saturating_sub(1));
    parts.iter().map(|(part, nodes)| refine(f, *part, nodes, tolerance, depths)).sum()
}

/// The quarters of a cell, with their places along each coordinate.
fn quarters([x, y]: [[f64; 2]; 2]) -> [([usize; 2], [[f64; 2]; 2]); 4] {
    let halves = |[low, high]: [f64; 2]| {
        let middle = 0.5 * (low + high);
        [[low, middle], [middle, high]]
    };
    let (x, y) = (halves(x), halves(y));
    [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| ([i, j], [x[i], y[j]]))
}

/// `f` at a node of a grid over the cell with `count` intervals along each coordinate.
fn at(f: &impl Fn(f64, f64) -> f64, [x, y]: [[f64; 2]; 2], [i, j]: [usize; 2], count: usize) -> f64 {
    let place = |[low, high]: [f64; 2], i: usize| low + (high - low) * (i as f64 / count as f64);
    f(place(x, i), place(y, j))
}

fn nodes(f: &impl Fn(f64, f64) -> f64, cell: [[f64; 2]; 2]) -> Nodes {
    std::array::from_fn(|i| std::array::from_fn(|j| at(f, cell, [i, j], 2)))
}

/// Simpson's rule.
fn simpson(nodes: &Nodes, [x, y]: [[f64; 2]; 2]) -> f64 {
    const WEIGHTS: [f64; 3] = [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0];
    let mut sum = 0.0;
    for (row, a) in nodes.iter().zip(WEIGHTS) {
        for (value, b) in row.iter().zip(WEIGHTS) {
            sum += a * b * value;
        }
    }
    sum * (x[1] - x[0]) * (y[1] - y[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn smooth_functions_are_integrated_precisely() {
        let value = integrate(&|x, y| x.powi(3) * y.powi(4), [[0.0, 1.0], [0.0, 2.0]], 1e-9);
        assert!((value - 32.0 / 20.0).abs() < 1e-7);
    }

    #[test]
    fn edges_are_resolved() {
        let disk = |x: f64, y: f64| if x * x + y * y < 1.0 { 1.0 } else { 0.0 };
        let value = integrate(&disk, [[0.0, 1.0], [0.0, 1.0]], 1e-7);
        assert!((value - PI / 4.0).abs() < 1e-3, "{value}");
    }

    #[test]
    fn corners_between_nodes_are_found() {
        let corner = |x: f64, y: f64| if x + y < 0.03 { 1.0 } else { 0.0 };
        let value = search(&corner, [[0.0, 1.0], [0.0, 1.0]], 1e-7);
        assert!((value / 0.00045 - 1.0).abs() < 0.01, "{value}");
    }

    #[test]
    fn axis_aligned_edges_are_resolved() {
        let half = |x: f64, _: f64| if x < 0.337 { 1.0 } else { 0.0 };
        let value = integrate(&half, [[0.0, 1.0], [0.0, 1.0]], 1e-7);
        assert!((value - 0.337).abs() < 3e-4, "{value}");
    }

    #[test]
    fn peaks_are_found() {
        let peak =
            |x: f64, y: f64| (-((x - 0.3).powi(2) + (y - 0.6).powi(2)) / (2.0 * 0.02f64.powi(2))).exp();
        let value = integrate(&peak, [[0.0, 1.0], [0.0, 1.0]], 1e-9);
        let exact = 2.0 * PI * 0.02f64.powi(2);
        assert!((value / exact - 1.0).abs() < 1e-5, "{value} {exact}");
    }
}
