//! Roots of a·t² + b·t + c without cancellation.
//!
//! Of the two textbook roots one subtracts nearly equal numbers when 4ac ≪ b². With q = −½(b +
//! sign(b)·√Δ) the roots are q/a and c/q, both stable ([Pharr 2023 §B.2.10]).

use crate::difference_of_products;

/// The real roots in ascending order; `None` when there are none. A double root, or the root of a
/// linear equation (a = 0), is returned twice; a constant (a = b = 0) gives `None`.
pub fn solve_quadratic(a: f32, b: f32, c: f32) -> Option<(f32, f32)> {
    if a == 0.0 {
        return (b != 0.0).then(|| (-c / b, -c / b));
    }
    let discriminant = difference_of_products(b, b, 4.0 * a, c);
    if discriminant < 0.0 {
        return None;
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let (t0, t1) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    Some(if t0 <= t1 { (t0, t1) } else { (t1, t0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn none_one_and_two_roots() {
        assert_eq!(solve_quadratic(1.0, 0.0, 1.0), None);
        assert_eq!(solve_quadratic(1.0, -2.0, 1.0), Some((1.0, 1.0)));
        assert_eq!(solve_quadratic(1.0, 0.0, -4.0), Some((-2.0, 2.0)));
        assert_eq!(solve_quadratic(0.0, 2.0, -4.0), Some((2.0, 2.0)));
        assert_eq!(solve_quadratic(0.0, 0.0, 1.0), None);
    }

    #[test]
    fn the_small_root_keeps_its_digits() {
        let (t0, t1) = solve_quadratic(1.0, -1e4, 1.0).expect("two roots");
        assert!((t0 as f64 - 1.000_000_01e-4).abs() < 1e-11);
        assert!((t1 - 1e4).abs() < 1e-2);
    }
}
