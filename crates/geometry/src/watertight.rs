//! Ray against triangle, without gaps between triangles that share an edge.
//!
//! The triangle is moved and sheared so that the ray becomes the +z axis from the origin. Its edge functions
//! there, e₀ = x₁y₂ − y₁x₂ and so on, are twice the areas that the origin makes with each edge; the ray
//! passes inside when none differs in sign from another. Two triangles compute the function of a shared edge
//! from the same numbers and get opposite signs, so that no ray slips between ([Woop et al. 2013]; [Pharr
//! 2023 §6.5.3]).
//!
//! What floats cannot tell is decided in doubles: on which side of an edge the ray passes when an edge
//! function vanishes, and whether a hit nearer than the rounding error of its distance lies before or behind
//! the origin. A hit is thus lost neither on edges nor in corners.

use math::{Ray, Vec2, Vec3, difference_of_products, gamma};

/// Edge functions below this may owe their sign to underflow.
const VANISHING: f32 = 1e-30;

/// A ray made ready for many triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheared {
    /// The axis that the ray mostly follows comes last.
    pub axes: [usize; 3],
    /// −d_x/d_z, −d_y/d_z and 1/d_z in permuted axes.
    pub shear: [f32; 3],
    pub o: Vec3,
    d: Vec3,
}

impl Sheared {
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        let size = ray.d.abs();
        let z = if size.x > size.y && size.x > size.z {
            0
        } else if size.y > size.z {
            1
        } else {
            2
        };
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let d = axes.map(|a| ray.d[a]);
        Self { axes, shear: [-d[0] / d[2], -d[1] / d[2], 1.0 / d[2]], o: ray.o, d: ray.d }
    }

    /// Where the ray meets the triangle at 0 < t < `t_max`: t, and the barycentric coordinates of corners 1
    /// and 2.
    #[inline]
    pub fn triangle(&self, corners: &[Vec3; 3], t_max: f32) -> Option<(f32, Vec2)> {
        let [ax, ay, az] = self.axes;
        let [sx, sy, sz] = self.shear;
        let sheared = |p: Vec3| {
            let v = p - self.o;
            [sx.mul_add(v[az], v[ax]), sy.mul_add(v[az], v[ay]), v[az] * sz]
        };
        let [a, b, c] = corners.map(sheared);
        let mut e = [edge(b, c), edge(c, a), edge(a, b)];
        if e.iter().any(|e| e.abs() < VANISHING) {
            e = [exact_edge(b, c), exact_edge(c, a), exact_edge(a, b)];
        }
        if e.iter().any(|&e| e < 0.0) && e.iter().any(|&e| e > 0.0) {
            return None;
        }
        let determinant = e[0] + e[1] + e[2];
        if determinant == 0.0 {
            return None;
        }
        let inverse = 1.0 / determinant;
        let mut t = weighted(e, [a[2], b[2], c[2]]) * inverse;
        if t >= t_max || t.is_nan() {
            return None;
        }
        if t <= distance_error([a, b, c], e, inverse) {
            t = self.exact_distance(corners).filter(|t| *t < t_max)?;
        }
        Some((t, Vec2::new(e[1] * inverse, e[2] * inverse)))
    }

    /// t > 0 where the ray meets the triangle's plane, in doubles.
    #[cold]
    fn exact_distance(&self, corners: &[Vec3; 3]) -> Option<f32> {
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let n = (b - a).cross(c - a);
        let t = n.dot(a - self.o.as_dvec3()) / n.dot(self.d.as_dvec3());
        (t > 0.0 && t.is_finite()).then_some(t as f32)
    }
}

/// e₀z₀ + e₁z₁ + e₂z₂: the distance before division by the determinant.
#[inline(always)]
pub(crate) fn weighted(e: [f32; 3], z: [f32; 3]) -> f32 {
    e[0].mul_add(z[0], e[1].mul_add(z[1], e[2] * z[2]))
}

/// Whether the sign of an edge function is beyond doubt.
#[inline(always)]
pub(crate) fn is_vanishing(e: f32) -> bool {
    e.abs() < VANISHING
}

#[inline]
fn edge(a: [f32; 3], b: [f32; 3]) -> f32 {
    difference_of_products(a[0], b[1], a[1], b[0])
}

#[cold]
fn exact_edge(a: [f32; 3], b: [f32; 3]) -> f32 {
    let e = a[0] as f64 * b[1] as f64 - a[1] as f64 * b[0] as f64;
    // Rounding to floats must not make nothing of a sign.
    if e != 0.0 && e as f32 == 0.0 { f32::MIN_POSITIVE.copysign(e as f32) } else { e as f32 }
}

/// A bound of the error of t ([Pharr 2023 §6.8.7]).
#[inline]
fn distance_error(corners: [[f32; 3]; 3], e: [f32; 3], inverse: f32) -> f32 {
    let largest = |v: [f32; 3]| v[0].abs().max(v[1].abs()).max(v[2].abs());
    let [x, y, z] = [0, 1, 2].map(|axis| largest(corners.map(|c| c[axis])));
    let dx = gamma(5) * (x + z);
    let dy = gamma(5) * (y + z);
    let dz = gamma(3) * z;
    let de = 2.0 * (gamma(2) * x * y + dy * x + dx * y);
    let e = largest(e);
    3.0 * (gamma(3) * e * z + de * z + dz * e) * inverse.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

    fn meet(o: Vec3, d: Vec3, t_max: f32) -> Option<(f32, Vec2)> {
        Sheared::new(&Ray::new(o, d, 0.0)).triangle(&TRIANGLE, t_max)
    }

    #[test]
    fn the_middle_edges_and_corners_are_met() {
        let (t, b) = meet(Vec3::new(0.25, 0.5, 2.0), -2.0 * Vec3::Z, 9.0).expect("hit");
        assert_eq!((t, b), (1.0, Vec2::new(0.25, 0.5)));
        for p in [Vec3::new(0.5, 0.0, 1.0), Vec3::new(0.5, 0.5, 1.0), Vec3::Z, Vec3::new(1.0, 0.0, 1.0)] {
            assert!(meet(p, -Vec3::Z, 2.0).is_some(), "{p}");
        }
    }

    #[test]
    fn misses() {
        let o = Vec3::new(0.25, 0.25, 1.0);
        assert!(meet(o, -Vec3::Z, 1.0).is_none(), "the end does not count");
        assert!(meet(o, Vec3::Z, 9.0).is_none(), "behind");
        assert!(meet(o, Vec3::X, 9.0).is_none(), "along the plane");
        assert!(meet(o, Vec3::ZERO, 9.0).is_none(), "no direction");
        assert!(meet(Vec3::NAN, Vec3::X, 9.0).is_none());
        assert!(meet(Vec3::new(0.6, 0.6, 1.0), -Vec3::Z, 9.0).is_none());
    }

    #[test]
    fn degenerate_triangles_are_never_met() {
        let s = Sheared::new(&Ray::new(Vec3::new(0.0, 0.0, 1.0), -Vec3::Z, 0.0));
        assert!(s.triangle(&[Vec3::ZERO; 3], 9.0).is_none());
        assert!(s.triangle(&[-Vec3::X, Vec3::ZERO, Vec3::X], 9.0).is_none());
        assert!(s.triangle(&[Vec3::NAN, Vec3::ZERO, Vec3::X], 9.0).is_none());
        assert!(s.triangle(&[Vec3::INFINITY, Vec3::ZERO, Vec3::X], 9.0).is_none());
    }

    #[test]
    fn very_near_hits_are_told_from_those_behind() {
        let o = Vec3::new(0.25, 0.25, 1e-9);
        let d = Vec3::new(0.3, 0.1, -1.0);
        assert!(meet(o, d, 9.0).is_some_and(|(t, _)| (t - 1e-9).abs() < 1e-15));
        assert!(meet(-o, d, 9.0).is_none());
    }
}
