//! Adaptive quadrature over a rectangle.
//!
//! A cell is measured by 3 × 3 Gauss–Legendre points, once whole and once in quarters; where the two disagree by more than
//! the tolerance, each quarter is treated alike. Edges inside a cell are so followed to a fine width.

/// How often a cell is quartered at most.
const MAX_DEPTH: u32 = 6;

/// ∬ `f` over `[x0, x1] × [y0, y1]`, given as `[[x0, x1], [y0, y1]]`, to about `tolerance`.
pub fn integrate(f: &impl Fn(f64, f64) -> f64, [x, y]: [[f64; 2]; 2], tolerance: f64) -> f64 {
    quarters([x, y]).map(|quarter| refine(f, quarter, gauss(f, quarter), 0.1 * tolerance, 1)).iter().sum()
}

fn refine(f: &impl Fn(f64, f64) -> f64, cell: [[f64; 2]; 2], coarse: f64, tolerance: f64, depth: u32) -> f64 {
    let parts = quarters(cell);
    let fine = parts.map(|part| gauss(f, part));
    let sum: f64 = fine.iter().sum();
    if depth >= MAX_DEPTH || (sum - coarse).abs() <= tolerance {
        return sum;
    }
    parts.iter().zip(fine).map(|(&part, value)| refine(f, part, value, tolerance, depth + 1)).sum()
}

fn quarters([x, y]: [[f64; 2]; 2]) -> [[[f64; 2]; 2]; 4] {
    let (mx, my) = (0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
    [[[x[0], mx], [y[0], my]], [[mx, x[1]], [y[0], my]], [[x[0], mx], [my, y[1]]], [[mx, x[1]], [my, y[1]]]]
}

fn gauss(f: &impl Fn(f64, f64) -> f64, [x, y]: [[f64; 2]; 2]) -> f64 {
    /// √(3/5), 0 and weights 5/18, 8/18, 5/18 of the unit interval.
    const POINTS: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.774_596_669_241_483_4, 5.0 / 18.0)];
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
    fn smooth_functions_are_exact() {
        let value = integrate(&|x, y| x.powi(3) * y.powi(4), [[0.0, 1.0], [0.0, 2.0]], 1e-9);
        assert!((value - 32.0 / 20.0).abs() < 1e-9);
    }

    #[test]
    fn an_edge_is_followed() {
        let disk = |x: f64, y: f64| if x * x + y * y < 1.0 { 1.0 } else { 0.0 };
        let value = integrate(&disk, [[0.0, 1.0], [0.0, 1.0]], 1e-7);
        assert!((value - PI / 4.0).abs() < 1e-3, "{value}");
    }

    #[test]
    fn a_peak_is_found() {
        let peak =
            |x: f64, y: f64| (-((x - 0.3).powi(2) + (y - 0.6).powi(2)) / (2.0 * 0.02f64.powi(2))).exp();
        let value = integrate(&peak, [[0.0, 1.0], [0.0, 1.0]], 1e-9);
        let exact = 2.0 * PI * 0.02f64.powi(2);
        assert!((value / exact - 1.0).abs() < 1e-5, "{value} {exact}");
    }
}
