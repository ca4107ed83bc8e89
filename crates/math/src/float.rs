//! Accurate single-precision arithmetic, and bounds of rounding errors.
//!
//! Sources: [Higham 2002 §3.1] for γ(n); [Kahan 2004] for the difference of products.

use lanes::Real;

/// Half of the distance from 1 to the next float: the largest relative rounding error of one
/// operation.
pub const MACHINE_EPSILON: f32 = f32::EPSILON * 0.5;
/// The largest float below 1.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - MACHINE_EPSILON;

/// The bound (1 ± ε)ⁿ ⊂ 1 ± γ(n) on the relative error of `n` rounded operations.
#[inline]
pub const fn gamma(n: u32) -> f32 {
    let ne = n as f32 * MACHINE_EPSILON;
    ne / (1.0 - ne)
}

/// `x²`.
#[inline(always)]
pub fn sqr<R: Real>(x: R) -> R {
    x * x
}

/// Square root; values below zero, which are due to rounding, count as zero.
#[inline(always)]
pub fn safe_sqrt<R: Real>(x: R) -> R {
    x.max(R::zero()).sqrt()
}

/// Arc cosine of a value that rounding may have pushed out of [−1, 1].
#[inline]
pub fn safe_acos(x: f32) -> f32 {
    lanes::acos(x.clamp(-1.0, 1.0))
}

/// Arc sine of a value that rounding may have pushed out of [−1, 1].
#[inline]
pub fn safe_asin(x: f32) -> f32 {
    lanes::asin(x.clamp(-1.0, 1.0))
}

/// `(1 − t)·a + t·b`.
#[inline(always)]
pub fn lerp<R: Real>(t: R, a: R, b: R) -> R {
    (R::one() - t) * a + t * b
}

/// Hermite step: 0 below `a`, 1 above `b`, smooth between.
#[inline]
pub fn smooth_step(x: f32, a: f32, b: f32) -> f32 {
    if a == b {
        return if x < a { 0.0 } else { 1.0 };
    }
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// `a·b − c·d`, correct to about one unit in the last place even when the products nearly cancel.
#[inline(always)]
pub fn difference_of_products<R: Real>(a: R, b: R, c: R, d: R) -> R {
    let cd = c * d;
    let difference = a.mul_add(b, -cd);
    let error = (-c).mul_add(d, cd);
    difference + error
}

/// `a·b + c·d`, correct to about one unit in the last place.
#[inline(always)]
pub fn sum_of_products<R: Real>(a: R, b: R, c: R, d: R) -> R {
    difference_of_products(a, b, -c, d)
}

/// Cross product without the cancellation of the naive formula.
#[inline(always)]
pub fn cross<R: Real>(a: crate::Vec3<R>, b: crate::Vec3<R>) -> crate::Vec3<R> {
    crate::Vec3::new(
        difference_of_products(a.y, b.z, a.z, b.y),
        difference_of_products(a.z, b.x, a.x, b.z),
        difference_of_products(a.x, b.y, a.y, b.x),
    )
}

/// The index i of the last of `size` ascending values for which `predicate(i)` holds, kept in
/// [0, size − 2], so that i and i + 1 are both valid.
#[inline]
pub fn find_interval(size: usize, predicate: impl Fn(usize) -> bool) -> usize {
    let (mut first, mut count) = (1usize, size.saturating_sub(2));
    while count > 0 {
        let half = count >> 1;
        let middle = first + half;
        if predicate(middle) {
            first = middle + 1;
            count -= half + 1;
        } else {
            count = half;
        }
    }
    (first - 1).min(size.saturating_sub(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_keep_digits_under_cancellation() {
        let (a, b, c, d) = (33962.035f32, -30438.8, 41563.4, -24871.969);
        let exact = (a as f64 * b as f64 - c as f64 * d as f64) as f32;
        assert!((difference_of_products(a, b, c, d) - exact).abs() <= exact.abs() * 2.0 * f32::EPSILON);
    }

    #[test]
    fn interval_search_brackets() {
        let nodes = [0.0, 1.0, 2.0, 5.0, 9.0];
        for (x, i) in [(-1.0, 0), (0.5, 0), (1.0, 1), (4.9, 2), (7.0, 3), (20.0, 3)] {
            assert_eq!(find_interval(nodes.len(), |k| nodes[k] <= x), i, "x = {x}");
        }
    }
}
