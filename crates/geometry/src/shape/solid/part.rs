//! The parts of solids: bodies with a closed boundary, each in an object space of its own.
//!
//! A solid of revolution is a profile x² + y² ≤ ρ(z) between two heights: sphere, cylinder,
//! cone, paraboloid, hyperboloid, closed by flat caps. Without a profile it is the slab between the
//! heights. The body of a formula is where F < 0 in its box, closed by the sides of the box.

use crate::placement::ROUNDING;
use crate::shape::extent::{Crossing, Extent, Span};
use crate::shape::implicit::{Body, Formula, Root, reach};
use crate::shape::level::Level;
use crate::shape::quadric::{Quadric, revolved_roots, unrounded};
use crate::surface::SurfacePoint;
use math::{Bounds3, DMat3, DVec3, Ray, Transform};

/// A body and its placement.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub quadric: Quadric,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Revolved(Revolved),
    Formula(Body),
}

/// The number of the curved face; the sides of the box are numbered from [`FLAT`] on.
const CURVED: u32 = 0;
const FLAT: u32 = 1;

impl Part {
    /// The number of faces of a part.
    pub const FACES: u32 = 7;

    fn new(render_from_object: &Transform, kind: Kind) -> Self {
        // The gradient is along the outside whether or not the transform is a reflection.
        Self { quadric: Quadric::new(render_from_object, render_from_object.swaps_handedness()), kind }
    }

    /// A solid of revolution between two heights.
    pub fn revolved(render_from_object: &Transform, profile: Option<Profile>, z: [f64; 2]) -> Self {
        let far = f64::INFINITY;
        let extent = Extent { min: DVec3::new(-far, -far, z[0]), max: DVec3::new(far, far, z[1]) };
        Self::new(render_from_object, Kind::Revolved(Revolved { profile, extent }))
    }

    /// Where a formula is negative inside of a box.
    pub fn formula(render_from_object: &Transform, formula: Formula, bounds: &Bounds3) -> Self {
        Self::new(render_from_object, Kind::Formula(Body::new(formula, bounds)))
    }

    /// A box around it; `None` where it is unbounded.
    pub fn bounds(&self) -> Option<Bounds3> {
        let Extent { min, max } = match &self.kind {
            Kind::Revolved(revolved) => revolved.hull(),
            Kind::Formula(body) => body.extent,
        };
        (min.is_finite() && max.is_finite()).then(|| self.quadric.bounds(min, max))
    }

    /// Adds the spans of the ray inside of the body to `spans`, in order; its faces are numbered
    /// from `first`.
    pub fn spans(&self, ray: &Ray, range: Span, first: u32, spans: &mut Vec<Span>) {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        if d == DVec3::ZERO {
            return;
        }
        match &self.kind {
            Kind::Revolved(revolved) => {
                let Some(within) = revolved.extent.clip(o, d, range, first + FLAT) else { return };
                let Some(profile) = &revolved.profile else { return spans.push(within) };
                for [a, b] in revolved.inside(profile, o, d).into_iter().flatten() {
                    let [a, b] = [a, b].map(|t| Crossing { t, face: first + CURVED });
                    let enter = if a.t > within[0].t { a } else { within[0] };
                    let leave = if b.t < within[1].t { b } else { within[1] };
                    if enter.t < leave.t {
                        spans.push([enter, leave]);
                    }
                }
            }
            Kind::Formula(body) => {
                if let Some(within) = body.extent.clip(o, d, range, first + FLAT)
                    && within[1].t.is_finite()
                {
                    between_roots(body, o, d, within, first + CURVED, spans);
                }
            }
        }
    }

    /// The surface at a hit of a ray on a face at about `t`.
    pub fn surface(&self, ray: &Ray, t: f32, face: u32) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        match &self.kind {
            Kind::Revolved(revolved) => match &revolved.profile {
                Some(profile) if face == CURVED => {
                    let level = revolved.level(profile, o, d, t);
                    level.surface(&self.quadric, level.p.abs() * ROUNDING, ray)
                }
                _ => self.side(&revolved.extent, o, d, face, ray),
            },
            Kind::Formula(body) if face == CURVED => {
                let root = body.refined(o, d, t);
                body.level(o + d * root.t, d).surface(&self.quadric, reach(o, d, root), ray)
            }
            Kind::Formula(body) => self.side(&body.extent, o, d, face, ray),
        }
    }

    /// The surface at a hit of a ray on a side of the box.
    fn side(&self, extent: &Extent, o: DVec3, d: DVec3, face: u32, ray: &Ray) -> SurfacePoint {
        let (axis, is_high) = (((face - FLAT) / 2) as usize, (face - FLAT) % 2 == 1);
        let at = if is_high { extent.max[axis] } else { extent.min[axis] };
        let t = (at - o[axis]) / d[axis];
        let mut p = o + d * t;
        p[axis] = at;
        let gradient = if is_high { DVec3::AXES[axis] } else { -DVec3::AXES[axis] };
        let level = Level { p, gradient, hessian: DMat3::ZERO, center: extent.center(), d };
        level.surface(&self.quadric, reach(o, d, Root { t, error: 0.0 }), ray)
    }
}

/// The spans of a ray where a formula is negative, between its roots within the box.
fn between_roots(body: &Body, o: DVec3, d: DVec3, [enter, leave]: Span, face: u32, spans: &mut Vec<Span>) {
    let mut inside: Option<Crossing> = None;
    let mut last = enter;
    let mut piece = |next: Crossing| {
        let is_inside = body.contains(o + d * (0.5 * (last.t + next.t)));
        match inside {
            None if is_inside => inside = Some(last),
            Some(start) if !is_inside => {
                spans.push([start, last]);
                inside = None;
            }
            _ => (),
        }
        last = next;
        inside
    };
    // Visits every root and accepts none.
    body.find(o, d, [enter.t, leave.t], |root| {
        piece(Crossing { t: root.t, face });
        false
    });
    if let Some(start) = piece(leave) {
        spans.push([start, leave]);
    }
}

/// x² + y² ≤ ρ₀ + ρ₁ζ + ρ₂ζ² with ζ = z − z₀: a profile revolved around the z axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Profile {
    /// ρ by ascending powers.
    pub rho: [f64; 3],
    /// z₀: where the profile is narrowest, so that it is most accurate there.
    pub origin: f64,
}

impl Profile {
    /// ρ(z).
    fn at(&self, z: f64) -> f64 {
        let ([r0, r1, r2], z) = (self.rho, z - self.origin);
        r0 + z * (r1 + z * r2)
    }

    /// x² + y² − ρ at a point, its gradient and its second derivatives.
    fn jet(&self, p: DVec3) -> (f64, DVec3, DMat3) {
        let [_, r1, r2] = self.rho;
        let gradient = DVec3::new(2.0 * p.x, 2.0 * p.y, -r1 - 2.0 * r2 * (p.z - self.origin));
        let hessian = DMat3::from_diagonal(DVec3::new(2.0, 2.0, -2.0 * r2));
        (p.x * p.x + p.y * p.y - self.at(p.z), gradient, hessian)
    }
}

/// A solid of revolution around the z axis.
#[derive(Clone, Debug)]
struct Revolved {
    /// Bounds it across the axis, if at all.
    profile: Option<Profile>,
    /// The slab between its heights.
    extent: Extent,
}

impl Revolved {
    /// A box around the body.
    fn hull(&self) -> Extent {
        let Extent { min, max } = self.extent;
        let Some(profile) = self.profile else { return self.extent };
        let top = profile.origin - 0.5 * profile.rho[1] / profile.rho[2];
        let widest = [min.z, max.z, if top.is_finite() { top.clamp(min.z, max.z) } else { max.z }];
        let r = widest.into_iter().map(|z| profile.at(z)).fold(0.0, f64::max).sqrt();
        Extent { min: DVec3::new(-r, -r, min.z), max: DVec3::new(r, r, max.z) }
    }

    /// Where a ray meets the profile, regardless of heights.
    fn roots(&self, profile: &Profile, o: DVec3, d: DVec3) -> Option<[f64; 2]> {
        let origin = DVec3::Z * profile.origin;
        revolved_roots(profile.rho, o - origin, d, self.extent.center() - origin)
    }

    /// Where a ray is inside of the profile, regardless of heights: on up to two spans.
    fn inside(&self, profile: &Profile, o: DVec3, d: DVec3) -> [Option<[f64; 2]>; 2] {
        const FAR: f64 = f64::INFINITY;
        // The sign of x² + y² − ρ at infinity; along an asymptote that of a point of the span in
        // question.
        let curvature = d.x * d.x + d.y * d.y - profile.rho[2] * d.z * d.z;
        let is_positive =
            |t: f64| if curvature == 0.0 { profile.jet(o + d * t).0 > 0.0 } else { curvature > 0.0 };
        match self.roots(profile, o, d) {
            Some([first, last]) if first < last => {
                let is_inside = match (first.is_finite(), last.is_finite()) {
                    (true, true) => curvature > 0.0,
                    (true, false) => !is_positive(first + 1.0),
                    _ => !is_positive(last - 1.0),
                };
                if is_inside { [Some([first, last]), None] } else { [Some([-FAR, first]), Some([last, FAR])] }
            }
            // A tangent ray is inside nowhere, or everywhere.
            _ => [(!is_positive(0.0)).then_some([-FAR, FAR]), None],
        }
    }

    /// The curved face at the root nearest to `t`, with the point refined onto the surface.
    fn level(&self, profile: &Profile, o: DVec3, d: DVec3, t: f32) -> Level {
        let mut p = o + d * unrounded(self.roots(profile, o, d), t);
        for _ in 0..2 {
            let (height, gradient, _) = profile.jet(p);
            let step = gradient * (height / gradient.length_squared());
            if step.is_finite() {
                p -= step;
            }
        }
        let (_, gradient, hessian) = profile.jet(p);
        Level { p, gradient, hessian, center: self.extent.center(), d }
    }
}
