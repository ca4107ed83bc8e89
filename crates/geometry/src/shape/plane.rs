//! The infinite plane z = 0; hit at t = −o_z/d_z, and not at all when d_z = 0.
//!
//! p(u, v) = (u, v, 0). It has neither bounds nor a finite area, so that it cannot be sampled.

use super::plain::{PlainShape, RevolvedKind};
use super::quadric::{Local, Quadric};
use super::sample::{ShapeHit, ShapeSample};
use crate::surface::SurfacePoint;
use math::{Bounds3, DVec3, Normal3, Ray, Transform, Vec2};

/// An infinite plane.
#[derive(Clone, Debug)]
pub struct Plane {
    quadric: Quadric,
}

impl Plane {
    /// The object's xy plane.
    pub fn new(render_from_object: &Transform, reverse_orientation: bool) -> Self {
        Self { quadric: Quadric::new(render_from_object, reverse_orientation) }
    }

    pub(super) fn plain(&self) -> PlainShape {
        self.quadric.plain(RevolvedKind::Plane, [0.0; 4])
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        None
    }

    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<ShapeHit> {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let t = -o.z / d.z;
        let p = o + d * t;
        // NaN fails.
        (t > 0.0 && (t as f32) < t_max).then(|| ShapeHit { t: t as f32, uv: parameters(p) })
    }

    pub(super) fn surface(&self, ray: &Ray) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let mut p = o + d * (-o.z / d.z);
        p.z = 0.0;
        let local = Local {
            p,
            n: DVec3::Z,
            uv: parameters(p),
            dpdu: DVec3::X,
            dpdv: DVec3::Y,
            second: [DVec3::ZERO; 3],
        };
        self.quadric.surface(&local, ray)
    }

    pub(super) fn area(&self) -> f32 {
        f32::INFINITY
    }

    pub(super) fn sample(&self, _: Vec2) -> Option<ShapeSample> {
        None
    }

    pub(super) fn normal(&self) -> Normal3 {
        self.quadric.normal(DVec3::Z)
    }
}

fn parameters(p: DVec3) -> Vec2 {
    Vec2::new(p.x as f32, p.y as f32)
}
