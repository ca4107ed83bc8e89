//! The region of a formula within a box: roots along rays, and the surface at a root.

use super::formula::Formula;
use super::jet::Jet;
use super::roots::Root;
use crate::placement::ROUNDING;
use crate::shape::extent::Extent;
use crate::shape::level::Level;
use math::{Bounds3, DVec3};

/// A bound of the error of the point at a root.
pub(in crate::shape) fn reach(o: DVec3, d: DVec3, root: Root) -> DVec3 {
    d.abs() * root.error + (o.abs() + d.abs() * root.t) * ROUNDING
}

/// A formula within a box, both in object space.
#[derive(Clone, Debug)]
pub(in crate::shape) struct Body {
    formula: Formula,
    pub extent: Extent,
}

impl Body {
    pub fn new(formula: Formula, bounds: &Bounds3) -> Self {
        Self { formula, extent: Extent { min: bounds.min.as_dvec3(), max: bounds.max.as_dvec3() } }
    }

    /// Whether a point is inside: F < 0.
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
        self.formula.first_root(o, d, range, wanted)
    }

    /// The root from which a distance was rounded to a float.
    pub fn refined(&self, o: DVec3, d: DVec3, t: f32) -> Root {
        let range = [t.next_down().into(), t.next_up().into()];
        let root = self.find(o, d, range, |_| true);
        // At higher resolution, a double root may be a near miss.
        root.unwrap_or(Root { t: t.into(), error: range[1] - range[0] })
    }

    /// The level set at a point hit by a ray along `d`.
    pub fn level(&self, p: DVec3, d: DVec3) -> Level {
        let Jet { gradient, hessian, .. } = self.formula.jet(p);
        Level { p, gradient, hessian, center: self.extent.center(), d }
    }
}
