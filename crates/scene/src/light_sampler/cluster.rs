//! Clusters of lights: what the importance of the lights to a point is computed from.
//!
//! Emission leaves within θ_e of normals that lie within θ_o of the axis w. The importance of a
//! cluster to a point at distance d is Φ·cos θ′ / d², where θ′ is the smallest possible angle
//! between an emission direction and the point, given that the box subtends θ_b
//! ([Conty Estevez & Kulla 2018]; [Pharr 2023 §12.6.3]).

use crate::light::LightBounds;
use lanes::{Int, Mask, Real};
use math::{Normal3, Point3, Vec3, Vector3, safe_sqrt};

/// [`LightBounds`] with what does not depend on the point computed once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cluster<R: Real = f32> {
    centroid: Point3<R>,
    /// Square of the radius of the box's bounding sphere.
    radius2: R,
    w: Vector3<R>,
    phi: R,
    cos_theta_o: R,
    sin_theta_o: R,
    cos_theta_e: R,
    two_sided: R::Mask,
}

/// Numbers of a cluster in a table: centroid, radius², w, Φ, cos θ_o, sin θ_o, cos θ_e, and whether
/// it is two-sided.
pub(super) const NUMBERS: usize = 12;

/// cos(max(0, a − b)) of angles in [0, π] given by their sines and cosines.
#[inline(always)]
fn cos_sub_clamped<R: Real>(sin_a: R, cos_a: R, sin_b: R, cos_b: R) -> R {
    R::select(cos_a.gt(cos_b), R::one(), cos_a * cos_b + sin_a * sin_b)
}

/// sin(max(0, a − b)).
#[inline(always)]
fn sin_sub_clamped<R: Real>(sin_a: R, cos_a: R, sin_b: R, cos_b: R) -> R {
    R::select(cos_a.gt(cos_b), R::zero(), sin_a * cos_b - cos_a * sin_b)
}

impl Cluster {
    /// The row of the table for lights with these bounds.
    pub fn row(lights: &LightBounds) -> [f32; NUMBERS] {
        let &LightBounds { bounds, w, phi, cos_theta_o, cos_theta_e, two_sided } = lights;
        let c = bounds.centroid();
        let radius2 = bounds.diagonal().length_squared() / 4.0;
        let sin_theta_o = safe_sqrt(1.0 - cos_theta_o * cos_theta_o);
        let two_sided = if two_sided { 1.0 } else { 0.0 };
        [c.x, c.y, c.z, radius2, w.x, w.y, w.z, phi, cos_theta_o, sin_theta_o, cos_theta_e, two_sided]
    }
}

impl<R: Real> Cluster<R> {
    /// The clusters of these rows of a table.
    #[inline(always)]
    pub fn gather(table: &[f32], rows: R::Int) -> Self {
        let first = rows.wrapping_mul(R::Int::splat(NUMBERS as u32));
        let four = |i: u32| R::gather_rows(table, first.wrapping_add(R::Int::splat(i)));
        let [x, y, z, radius2] = four(0);
        let [wx, wy, wz, phi] = four(4);
        let [cos_theta_o, sin_theta_o, cos_theta_e, two_sided] = four(8);
        Self {
            centroid: Vec3::new(x, y, z),
            radius2,
            w: Vec3::new(wx, wy, wz),
            phi,
            cos_theta_o,
            sin_theta_o,
            cos_theta_e,
            two_sided: two_sided.gt(R::zero()),
        }
    }

    /// An estimate ≥ 0 of the unoccluded contribution to `p`. A nonzero `n` is the surface normal
    /// there, and includes the cosine of incidence.
    #[inline(always)]
    pub fn importance(&self, p: Point3<R>, n: Normal3<R>) -> R {
        let [zero, one] = [R::zero(), R::one()];
        let to = p - self.centroid;
        let distance2 = to.length_squared();
        let (wi, is_apart) = to.normalize_masked();
        let wi = Vec3::select(is_apart, wi, Vec3::new(zero, zero, one));
        let cos_w = self.w.dot(wi);
        let cos_w = R::select(self.two_sided, cos_w.abs(), cos_w);
        let sin_w = safe_sqrt(one - cos_w * cos_w);
        // The cone around the box is the whole sphere of directions for points in the box's
        // bounding sphere.
        let sin2_b = self.radius2 / distance2;
        let is_outside = sin2_b.lt(one);
        let sin_b = R::select(is_outside, sin2_b.sqrt(), zero);
        let cos_b = R::select(is_outside, (one - sin2_b).sqrt(), -one);
        let cos_x = cos_sub_clamped(sin_w, cos_w, self.sin_theta_o, self.cos_theta_o);
        let sin_x = sin_sub_clamped(sin_w, cos_w, self.sin_theta_o, self.cos_theta_o);
        let cos_p = cos_sub_clamped(sin_x, cos_x, sin_b, cos_b);
        let is_dark = cos_p.le(self.cos_theta_e);
        if is_dark.all() {
            return zero;
        }
        // The distance is clamped to half of the box's diagonal, as 1/d² diverges near a cluster.
        let mut importance = self.phi * cos_p / distance2.max(self.radius2);
        let has_normal = n.x.ne(zero) | n.y.ne(zero) | n.z.ne(zero);
        if has_normal.any() {
            let cos_i = wi.dot(n).abs();
            let sin_i = safe_sqrt(one - cos_i * cos_i);
            let cosine = cos_sub_clamped(sin_i, cos_i, sin_b, cos_b);
            importance = R::select(has_normal, importance * cosine, importance);
        }
        // Finite even at the position of a point light, so that importances can be compared.
        let importance = importance.clamp(zero, R::splat(f32::MAX / 4.0));
        R::select(is_dark, zero, importance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Bounds3;

    fn importance(lights: LightBounds, p: Point3, n: Normal3) -> f32 {
        Cluster::<f32>::gather(&Cluster::row(&lights), 0).importance(p, n)
    }

    fn lamp() -> LightBounds {
        LightBounds {
            bounds: Bounds3::new(Vec3::splat(-0.1), Vec3::splat(0.1)),
            w: Vec3::Z,
            phi: 2.0,
            cos_theta_o: 1.0,
            cos_theta_e: 0.0,
            two_sided: false,
        }
    }

    #[test]
    fn importance_behind_a_light_is_zero() {
        assert_eq!(importance(lamp(), Vec3::new(0.0, 0.0, -5.0), Vec3::ZERO), 0.0);
        assert!(importance(lamp(), Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO) > 0.0);
        let both = LightBounds { two_sided: true, ..lamp() };
        assert!(importance(both, Vec3::new(0.0, 0.0, -5.0), Vec3::ZERO) > 0.0);
    }

    #[test]
    fn importance_grows_with_power_and_proximity() {
        let near = importance(lamp(), Vec3::new(0.0, 0.0, 2.0), Vec3::Z);
        assert!(near > importance(lamp(), Vec3::new(0.0, 0.0, 4.0), Vec3::Z));
        assert!(near < importance(LightBounds { phi: 3.0, ..lamp() }, Vec3::new(0.0, 0.0, 2.0), Vec3::Z));
    }

    #[test]
    fn a_union_has_importance_wherever_its_parts_have() {
        let other = LightBounds { w: Vec3::X, bounds: Bounds3::new(Vec3::ONE, Vec3::splat(1.2)), ..lamp() };
        let both = lamp().union(other);
        for p in [Vec3::new(0.0, 0.0, 5.0), Vec3::new(5.0, 1.0, 1.0), Vec3::new(3.0, 3.0, 3.0)] {
            if importance(lamp(), p, Vec3::ZERO) > 0.0 || importance(other, p, Vec3::ZERO) > 0.0 {
                assert!(importance(both, p, Vec3::ZERO) > 0.0);
            }
        }
    }
}
