//! The footprint of a pixel on a surface, over which textures are averaged.
//!
//! It comes from the ray differentials, if the ray has them — the neighbouring rays hit the tangent
//! plane at p + ∂p/∂x — and otherwise from the camera's [minimum
//! differentials](crate::camera::Camera::approximate_dp_dxy); ∂(u,v)/∂(x,y) then follow by least
//! squares from ∂p/∂(u,v) ([Pharr 2023 §10.1]).

use crate::camera::differential_scale;
use crate::view::View;
use lanes::{Mask, Real};
use math::{Differentials, Normal3, Point3, Vec3, Vector3, balance, difference_of_products};

/// Derivatives of the surface point by film position, in pixels, for each lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint<R = f32> {
    /// ∂p/∂x.
    pub dpdx: Vector3<R>,
    /// ∂p/∂y.
    pub dpdy: Vector3<R>,
    /// ∂u/∂x.
    pub dudx: R,
    /// ∂u/∂y.
    pub dudy: R,
    /// ∂v/∂x.
    pub dvdx: R,
    /// ∂v/∂y.
    pub dvdy: R,
}

impl<R: Real> Footprint<R> {
    /// A point.
    #[inline(always)]
    pub fn point() -> Self {
        let (none, zero) = (Vec3::splat(R::zero()), R::zero());
        Self { dpdx: none, dpdy: none, dudx: zero, dudy: zero, dvdx: zero, dvdy: zero }
    }

    /// That of ∂p/∂x and ∂p/∂y, where the surface has the tangents ∂p/∂u and ∂p/∂v.
    #[inline(always)]
    pub fn new([dpdx, dpdy]: [Vector3<R>; 2], [dpdu, dpdv]: [Vector3<R>; 2]) -> Self {
        let [scale_u, scale_v] = [balance(dpdu.abs().max_element()), balance(dpdv.abs().max_element())];
        let (dpdu, dpdv) = (dpdu * scale_u, dpdv * scale_v);
        // Normal equations of [∂p/∂u ∂p/∂v]·[du dv]ᵀ = dp.
        let (a, b, c) = (dpdu.dot(dpdu), dpdu.dot(dpdv), dpdv.dot(dpdv));
        let inverse = or_zero(R::one() / difference_of_products(a, c, b, b));
        let (x, y) = (dpdu.dot(dpdx), dpdv.dot(dpdx));
        let dudx = bounded(difference_of_products(c, x, b, y) * inverse * scale_u);
        let dvdx = bounded(difference_of_products(a, y, b, x) * inverse * scale_v);
        let (x, y) = (dpdu.dot(dpdy), dpdv.dot(dpdy));
        let dudy = bounded(difference_of_products(c, x, b, y) * inverse * scale_u);
        let dvdy = bounded(difference_of_products(a, y, b, x) * inverse * scale_v);
        Self { dpdx, dpdy, dudx, dudy, dvdx, dvdy }
    }
}

#[inline(always)]
fn bounded<R: Real>(x: R) -> R {
    or_zero(x).clamp(R::splat(-1e8), R::splat(1e8))
}

/// Zero for infinities and NaN.
#[inline(always)]
fn or_zero<R: Real>(x: R) -> R {
    R::select(x.abs().le(R::splat(f32::MAX)), x, R::zero())
}

impl View {
    /// ∂p/∂x and ∂p/∂y of the planes through `p` with normal `n` that rays with these differentials
    /// hit, and of paths that have none any more: those outside of the mask.
    #[inline(always)]
    pub fn pixel_on_plane<R: Real>(
        &self,
        differentials: Option<(&Differentials<R>, R::Mask)>,
        p: Point3<R>,
        n: Normal3<R>,
        time: R,
    ) -> [Vector3<R>; 2] {
        let mut seen = [Vec3::splat(R::zero()); 2];
        let mut is_seen = R::Mask::splat(false);
        if let Some((d, mask)) = differentials {
            let (dpdx, meets_x) = on_plane(d.rx_origin, d.rx_direction, p, n);
            let (dpdy, meets_y) = on_plane(d.ry_origin, d.ry_direction, p, n);
            (seen, is_seen) = ([dpdx, dpdy], mask & meets_x & meets_y);
        }
        if is_seen.all() {
            return seen;
        }
        // Without jitter, all samples of a pixel have the same position, and each covers the whole
        // pixel.
        let samples = if self.options.disable_pixel_jitter { 1 } else { self.samples_per_pixel };
        let [x, y] = self.camera.approximate_dp_dxy(p, n, time, differential_scale(samples));
        [Vec3::select(is_seen, seen[0], x), Vec3::select(is_seen, seen[1], y)]
    }
}

/// From `p` to the point of a ray on the plane through `p` with normal `n`, where there is one.
#[inline(always)]
fn on_plane<R: Real>(o: Point3<R>, d: Vector3<R>, p: Point3<R>, n: Normal3<R>) -> (Vector3<R>, R::Mask) {
    let t = n.dot(p - o) / n.dot(d);
    (o + d * t - p, t.abs().le(R::splat(f32::MAX)))
}
