//! The surface F(x, y, z) = 0 of a formula, within a box.
//!
//! The nearest root along a ray is proved to be the nearest ([`roots`]). The normal is the
//! gradient, by automatic differentiation; the outside is where F > 0. The box clips the surface,
//! which is open there. (u, v) are the spherical angles around the centre of the box. Points cannot
//! be sampled uniformly on such a surface, so that its area counts as 0.

mod body;
mod formula;
mod interval;
mod jet;
mod model;
mod parser;
mod program;
mod roots;
#[cfg(test)]
mod tests;

pub(super) use body::{Body, reach};
pub use formula::Formula;
pub use parser::FormulaError;
pub(super) use roots::Root;

use super::extent::Crossing;
use super::quadric::Quadric;
use super::sample::{ShapeHit, ShapeSample};
use crate::surface::SurfacePoint;
use math::{Bounds3, Ray, Transform, Vec2};

/// A surface given by a formula.
#[derive(Clone, Debug)]
pub struct Implicit {
    quadric: Quadric,
    body: Body,
}

impl Implicit {
    /// Where the formula is zero inside of `bounds`, which are in the object's space.
    pub fn new(
        render_from_object: &Transform,
        reverse_orientation: bool,
        formula: Formula,
        bounds: &Bounds3,
    ) -> Self {
        Self {
            quadric: Quadric::new(render_from_object, reverse_orientation),
            body: Body::new(formula, bounds),
        }
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        Some(self.quadric.bounds(self.body.extent.min, self.body.extent.max))
    }

    pub(super) fn intersect(&self, ray: &Ray, [after, t_max]: [f32; 2]) -> Option<ShapeHit> {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let ends = [after.into(), t_max.into()].map(|t| Crossing { t, face: 0 });
        let range = self.body.extent.clip(o, d, ends, 0)?.map(|crossing| crossing.t);
        // A root that is not certainly ahead is the point where the ray starts.
        let is_ahead = |root: &Root| root.t - root.error > 0.0 && root.t as f32 > after;
        let root = self.body.find(o, d, range, is_ahead)?;
        let t = root.t as f32;
        (t > 0.0 && t < t_max).then(|| ShapeHit { t, uv: self.body.level(o + d * root.t, d).parameters() })
    }

    pub(super) fn surface(&self, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let root = self.body.refined(o, d, hit.t);
        let p = o + d * root.t;
        self.body.level(p, d).surface(&self.quadric, reach(o, d, root), ray)
    }

    pub(super) fn area(&self) -> f32 {
        0.0
    }

    pub(super) fn sample(&self, _: Vec2) -> Option<ShapeSample> {
        None
    }
}
