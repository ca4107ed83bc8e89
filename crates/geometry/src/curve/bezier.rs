//! Cubic Bézier segments: conversion from other bases, and subdivision.
//!
//! Everything follows from the blossom b(r, s, t), which is symmetric, affine in each argument, and
//! has p(u) = b(u, u, u): the part of a segment between u₀ and u₁ has the control points
//! b(u₀,u₀,u₀), b(u₀,u₀,u₁), b(u₀,u₁,u₁), b(u₁,u₁,u₁) ([Ramshaw 1987]; [Pharr 2023 §6.7]).

use math::{DVec3, Point3};

/// The control points of a cubic Bézier segment.
pub(super) type Cubic = [DVec3; 4];

/// The basis of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SplineBasis {
    /// Bézier segments that share their ends: degree + 1 points, then degree more for every further
    /// segment.
    Bezier,
    /// A uniform B-spline: degree + 1 points, then one more for every further segment.
    BSpline,
}

/// The cubic Bézier segments of a curve of degree 2 or 3; points of an incomplete segment are
/// ignored.
pub fn bezier_segments(points: &[Point3], degree: usize, basis: SplineBasis) -> Vec<[Point3; 4]> {
    let step = match basis {
        SplineBasis::Bezier => degree,
        SplineBasis::BSpline => 1,
    };
    let cubic = |p: &[Point3]| {
        let p: Vec<DVec3> = p.iter().map(|p| p.as_dvec3()).collect();
        let cubic = match (&p[..], basis) {
            (&[a, b, c], SplineBasis::Bezier) => elevated([a, b, c]),
            (&[a, b, c], SplineBasis::BSpline) => elevated([a.midpoint(b), b, b.midpoint(c)]),
            (&[a, b, c, d], SplineBasis::BSpline) => from_b_spline([a, b, c, d]),
            _ => [p[0], p[1], p[2], p[3]],
        };
        cubic.map(|p| p.as_vec3().into())
    };
    points.windows(degree + 1).step_by(step).map(cubic).collect()
}

/// A quadratic segment as a cubic one.
fn elevated([a, b, c]: [DVec3; 3]) -> Cubic {
    [a, a.lerp(b, 2.0 / 3.0), b.lerp(c, 1.0 / 3.0), c]
}

/// One segment of a uniform cubic B-spline.
fn from_b_spline([a, b, c, d]: Cubic) -> Cubic {
    let (before, first) = (a.lerp(b, 2.0 / 3.0), b.lerp(c, 1.0 / 3.0));
    let (second, after) = (b.lerp(c, 2.0 / 3.0), c.lerp(d, 1.0 / 3.0));
    [before.midpoint(first), first, second, second.midpoint(after)]
}

/// The part between two parameters. Adjacent parts have the same end point, bit for bit.
pub(super) fn part(p: &Cubic, [u0, u1]: [f64; 2]) -> Cubic {
    [blossom(p, [u0; 3]), blossom(p, [u0, u0, u1]), blossom(p, [u0, u1, u1]), blossom(p, [u1; 3])]
}

fn blossom(p: &Cubic, [r, s, t]: [f64; 3]) -> DVec3 {
    let a = [p[0].lerp(p[1], r), p[1].lerp(p[2], r), p[2].lerp(p[3], r)];
    let b = [a[0].lerp(a[1], s), a[1].lerp(a[2], s)];
    b[0].lerp(b[1], t)
}

/// Both halves.
pub(super) fn halves(p: &Cubic) -> [Cubic; 2] {
    let [a, b, c] = [p[0].midpoint(p[1]), p[1].midpoint(p[2]), p[2].midpoint(p[3])];
    let (ab, bc) = (a.midpoint(b), b.midpoint(c));
    let middle = ab.midpoint(bc);
    [[p[0], a, ab, middle], [middle, bc, c, p[3]]]
}

/// The point at `u`, and ∂p/∂u there.
pub(super) fn evaluate(p: &Cubic, u: f64) -> (DVec3, DVec3) {
    let a = [p[0].lerp(p[1], u), p[1].lerp(p[2], u), p[2].lerp(p[3], u)];
    let b = [a[0].lerp(a[1], u), a[1].lerp(a[2], u)];
    (b[0].lerp(b[1], u), (b[1] - b[0]) * 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Vec3;

    fn points(n: usize) -> Vec<Vec3> {
        (0..n).map(|i| Vec3::new((i as f32 * 1.7).sin(), i as f32, (i as f32 * 0.9).cos())).collect()
    }

    fn at(p: &[Vec3; 4], u: f64) -> DVec3 {
        evaluate(&p.map(|p| p.as_dvec3()), u).0
    }

    /// The uniform B-spline basis functions, as [Pharr 2023 §6.7] has them by other means:
    /// piecewise polynomials.
    fn b_spline(p: &[Vec3], degree: usize, u: f64) -> DVec3 {
        let weights = match degree {
            2 => vec![0.5 * (1.0 - u) * (1.0 - u), 0.5 + u * (1.0 - u), 0.5 * u * u],
            _ => vec![
                (1.0 - u).powi(3) / 6.0,
                (3.0 * u.powi(3) - 6.0 * u * u + 4.0) / 6.0,
                (-3.0 * u.powi(3) + 3.0 * u * u + 3.0 * u + 1.0) / 6.0,
                u.powi(3) / 6.0,
            ],
        };
        p.iter().zip(weights).map(|(p, w)| p.as_dvec3() * w).sum()
    }

    #[test]
    fn all_bases_give_their_curves() {
        for degree in [2, 3] {
            let p = points(4 * degree + 1);
            let bezier = bezier_segments(&p, degree, SplineBasis::Bezier);
            assert_eq!(bezier.len(), 4);
            for (i, segment) in bezier.iter().enumerate() {
                assert_eq!(segment[0], p[i * degree]);
                assert_eq!(segment[3], p[(i + 1) * degree]);
            }
            let spline = bezier_segments(&p, degree, SplineBasis::BSpline);
            assert_eq!(spline.len(), p.len() - degree);
            for (i, segment) in spline.iter().enumerate() {
                for u in [0.0, 0.3, 0.8, 1.0] {
                    let expected = b_spline(&p[i..=i + degree], degree, u);
                    assert!(at(segment, u).distance(expected) < 1e-6, "degree {degree}, segment {i}, {u}");
                }
            }
        }
        let [a, b, c] = [Vec3::X, Vec3::Y, Vec3::Z];
        let parabola = bezier_segments(&[a, b, c], 2, SplineBasis::Bezier)[0];
        let expected = (a * 0.49 + b * 0.42 + c * 0.09).as_dvec3();
        assert!(at(&parabola, 0.3).distance(expected) < 1e-6);
    }

    #[test]
    fn too_few_points_are_no_segment() {
        for basis in [SplineBasis::Bezier, SplineBasis::BSpline] {
            assert!(bezier_segments(&points(3), 3, basis).is_empty());
            assert!(bezier_segments(&[], 2, basis).is_empty());
        }
    }

    #[test]
    fn parts_lie_on_the_whole() {
        let p: Cubic = [0.3, -0.8, 0.9, 0.1].map(|x| DVec3::new(x, x * x, 1.0 - x));
        let p = [p[0], p[1] + DVec3::Y, p[2] - DVec3::Z, p[3]];
        for [u0, u1] in [[0.0, 0.5], [0.5, 1.0], [0.25, 0.375]] {
            let part = part(&p, [u0, u1]);
            for w in [0.0, 0.4, 1.0] {
                let u = u0 + (u1 - u0) * w;
                let ((q, dq), (r, dr)) = (evaluate(&p, u), evaluate(&part, w));
                assert!(q.distance(r) < 1e-14 && (dq * (u1 - u0)).distance(dr) < 1e-13);
            }
        }
        let both = halves(&p);
        for (half, u) in both.iter().zip([[0.0, 0.5], [0.5, 1.0]]) {
            assert!(half.iter().zip(part(&p, u)).all(|(a, b)| a.distance(b) < 1e-14));
        }
    }
}
