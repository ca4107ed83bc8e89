//! The surface F(x, y, z) = 0 of a formula, within a box.
//!
//! The nearest place along a ray is proved to be that ([`roots`]). The normal is the gradient,
//! found by automatic differentiation; the outside is where F > 0. What lies outside of the box is
//! cut off and leaves the surface open there. (u, v) are the spherical angles around the middle of
//! the box. There is no way to choose a point evenly on such a surface, so that it has no area to
//! be sampled by.

mod formula;
mod interval;
mod jet;
mod model;
mod program;
mod roots;
#[cfg(test)]
mod tests;

pub use formula::FormulaError;
pub(super) use roots::Root;

use super::level::Level;
use super::quadric::Quadric;
use super::solid::{Crossing, Extent};
use super::{ShapeHit, ShapeSample};
use crate::placement::ROUNDING;
use crate::surface::SurfacePoint;
use interval::Interval;
use jet::Jet;
use math::{Bounds3, DVec3, Ray, Transform, Vec2};
use program::Program;
use roots::Roots;
use std::sync::Arc;

/// A formula F(x, y, z): numbers, x, y, z, pi, e, + − * / ^, parentheses, and the functions sqrt,
/// abs, sin, cos, tan, exp, log, min, max and pow.
#[derive(Clone, Debug)]
pub struct Formula {
    program: Arc<Program>,
    order: Order,
}

/// How many coefficients describe the formula along a ray.
#[derive(Clone, Copy, Debug)]
enum Order {
    Four,
    Eight,
    Sixteen,
}

impl Formula {
    /// Reads a formula of x, y and z, such as `x^2 + y^2 + z^2 - 1`.
    ///
    /// ```
    /// use alhazen_geometry::Formula;
    ///
    /// let sphere = Formula::parse("x^2 + y^2 + z^2 - 1").expect("a formula");
    /// assert_eq!(sphere.value([1.0, 2.0, 2.0]), 8.0);
    /// let error = Formula::parse("x^2 + siin(y)").expect_err("no formula");
    /// assert_eq!(error.place, 6..10);
    /// ```
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        let program = formula::parse(text)?;
        let order = match program.degree() {
            Some(..=3) => Order::Four,
            None | Some(..=7) => Order::Eight,
            Some(_) => Order::Sixteen,
        };
        Ok(Self { program: Arc::new(program), order })
    }

    /// F at a point; not a number where it is not defined.
    pub fn value(&self, p: [f64; 3]) -> f64 {
        self.program.evaluate(p, &mut Vec::new())
    }

    /// Whether F is surely zero nowhere in a box.
    pub fn has_no_zero(&self, bounds: &Bounds3) -> bool {
        let axis = |i: usize| Interval::new(bounds.min[i].into(), bounds.max[i].into());
        !self.program.evaluate([axis(0), axis(1), axis(2)], &mut Vec::new()).contains(0.0)
    }

    fn jet(&self, p: DVec3) -> Jet {
        self.program.evaluate([0, 1, 2].map(|axis| Jet::coordinate(p, axis)), &mut Vec::new())
    }
}

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

    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<ShapeHit> {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let ends = [0.0, t_max.into()].map(|t| Crossing { t, face: 0 });
        let range = self.body.extent.clip(o, d, ends, 0)?.map(|crossing| crossing.t);
        // A root whose place is not known to be ahead is where the ray started.
        let root = self.body.find(o, d, range, |root| root.t - root.error > 0.0)?;
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

/// How far the point at a root may be from the surface.
pub(super) fn reach(o: DVec3, d: DVec3, root: Root) -> DVec3 {
    d.abs() * root.error + (o.abs() + d.abs() * root.t) * ROUNDING
}

/// A formula within a box, both in object space.
#[derive(Clone, Debug)]
pub(super) struct Body {
    formula: Formula,
    pub extent: Extent,
}

impl Body {
    pub fn new(formula: Formula, bounds: &Bounds3) -> Self {
        Self { formula, extent: Extent { min: bounds.min.as_dvec3(), max: bounds.max.as_dvec3() } }
    }

    /// Whether a point counts as inside: F < 0.
    pub fn contains(&self, p: DVec3) -> bool {
        self.formula.value(p.to_array()) < 0.0
    }

    /// The first root in a range for which `wanted` holds.
    pub fn find(
        &self,
        o: DVec3,
        d: DVec3,
        range: [f64; 2],
        wanted: impl FnMut(&Root) -> bool,
    ) -> Option<Root> {
        if d == DVec3::ZERO || !range[1].is_finite() {
            return None;
        }
        // Counted from the start of the range, where the numbers are small.
        let start = range[0];
        let o = o + d * start;
        let range = [0.0, range[1] - start];
        let moved = |root: Root| Root { t: root.t + start, ..root };
        let program = &self.formula.program;
        match self.formula.order {
            Order::Four => Roots::<4>::new(program, o, d, range).map(moved).find(wanted),
            Order::Eight => Roots::<8>::new(program, o, d, range).map(moved).find(wanted),
            Order::Sixteen => Roots::<16>::new(program, o, d, range).map(moved).find(wanted),
        }
    }

    /// The root from which a distance was rounded to a float.
    pub fn refined(&self, o: DVec3, d: DVec3, t: f32) -> Root {
        let range = [t.next_down().into(), t.next_up().into()];
        let root = self.find(o, d, range, |_| true);
        // A root that only touches may be seen to miss when looked at more closely.
        root.unwrap_or(Root { t: t.into(), error: range[1] - range[0] })
    }

    /// What the formula is around a point that a ray along `d` came to.
    pub fn level(&self, p: DVec3, d: DVec3) -> Level {
        let Jet { gradient, hessian, .. } = self.formula.jet(p);
        Level { p, gradient, hessian, center: self.extent.center(), d }
    }
}
