//! Adaptive quadrature over a rectangle.
//!
//! A cell is integrated by Simpson's rule, once whole and once in quarters; where these differ by
//! more than the tolerance, the quarters are refined recursively. The rule has nodes on the
//! boundary of each cell, so that no straight discontinuity lies between them unnoticed;
//! discontinuities are resolved to a fine width.

/// The least and greatest number of subdivisions.
const MIN_DEPTH: u32 = 2;
const MAX_DEPTH: u32 = 9;
/// The least number of subdivisions where all nodes of the usual grid have missed the support of
/// the density.
const SEARCH_DEPTH: u32 = 6;

/// ∬ `f` over `[x0, x1] × [y0, y1]`, given as `[[x0, x1], [y0, y1]]`, to about `tolerance`.
pub fn integrate(f: &impl Fn(f64, f64) -> f64, cell: [[f64; 2]; 2], tolerance: f64) -> f64 {
    refine(f, cell, simpson(f, cell), 0.1 * tolerance, [MIN_DEPTH, MAX_DEPTH])
}

/// As [`integrate`], for a cell where `f` is known not to be 0 everywhere.
pub(crate) fn search(f: &impl Fn(f64, f64) -> f64, cell: [[f64; 2]; 2], tolerance: f64) -> f64 {
    refine(f, cell, simpson(f, cell), 0.1 * tolerance, [SEARCH_DEPTH, MAX_DEPTH])
}

fn refine(
    f: &impl Fn(f64, f64) -> f64,
    cell: [[f64; 2]; 2],
    coarse: f64,
    tolerance: f64,
    depths: [u32; 2],
) -> f64 {
    let parts = quarters(cell);
    let fine = parts.map(|part| simpson(f, part));
    let sum: f64 = fine.iter().sum();
    let converged = depths[0] == 0 && (sum - coarse).abs() <= tolerance;
    if converged || depths[1] == 0 || !sum.is_finite() {
        return sum;
    }
    let depths = depths.map(|depth| depth.saturating_sub(1));
    parts.iter().zip(fine).map(|(&part, value)| refine(f, part, value, tolerance, depths)).sum()
}

fn quarters([x, y]: [[f64; 2]; 2]) -> [[[f64; 2]; 2]; 4] {
    let (mx, my) = (0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
    [[[x[0], mx], [y[0], my]], [[mx, x[1]], [y[0], my]], [[x[0], mx], [my, y[1]]], [[mx, x[1]], [my, y[1]]]]
}

fn simpson(f: &impl Fn(f64, f64) -> f64, [x, y]: [[f64; 2]; 2]) -> f64 {
    const POINTS: [(f64, f64); 3] = [(-1.0, 1.0 / 6.0), (0.0, 4.0 / 6.0), (1.0, 1.0 / 6.0)];
    let at = |range: [f64; 2], t: f64| 0.5 * (range[0] + range[1] + t * (range[1] - range[0]));
    let mut sum = 0.0;
    for (s, ws) in POINTS {
        for (t, wt) in POINTS {
            sum += ws * wt * f(at(x, s), at(y, t));
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
