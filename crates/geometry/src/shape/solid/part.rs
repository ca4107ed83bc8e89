//! What solids are made of: bodies with a closed boundary, each in a space of its own.
//!
//! A solid of revolution is x² + y² ≤ ρ(z) with ρ(z) = ρ₀ + ρ₁z + ρ₂z² between two heights: ball, cylinder, cone, paraboloid,
//! hyperboloid, closed by flat ends. Along a ray x² + y² − ρ is a quadratic in t, whose roots are found from the point of the
//! ray that is nearest to the body. Without ρ there is only what lies between the heights. The body of a formula is where F <
//! 0 in its box, closed by the sides of the box.

use super::super::implicit::{Body, Formula, Root, reach};
use super::super::level::Level;
use super::super::quadric::Quadric;
use super::extent::{Crossing, Extent, Span};
use crate::placement::ROUNDING;
use crate::surface::SurfacePoint;
use math::{Bounds3, DMat3, DVec3, Ray, Transform};

/// A body and where it stands.
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

/// The curved face; the sides of the box are those from [`FLAT`] on.
const CURVED: u32 = 0;
const FLAT: u32 = 1;

impl Part {
    /// Numbers of faces that a part has.
    pub const FACES: u32 = 7;

    fn new(render_from_object: &Transform, kind: Kind) -> Self {
        // The gradient is along the outside whether or not the transform is a mirror.
        Self { quadric: Quadric::new(render_from_object, render_from_object.swaps_handedness()), kind }
    }

    /// x² + y² ≤ ρ(z) between two heights.
    pub fn revolved(render_from_object: &Transform, rho: Option<[f64; 3]>, z: [f64; 2]) -> Self {
        let far = f64::INFINITY;
        let extent = Extent { min: DVec3::new(-far, -far, z[0]), max: DVec3::new(far, far, z[1]) };
        Self::new(render_from_object, Kind::Revolved(Revolved { rho, extent }))
    }

    /// Where a formula is negative inside of a box.
    pub fn formula(render_from_object: &Transform, formula: Formula, bounds: &Bounds3) -> Self {
        Self::new(render_from_object, Kind::Formula(Body::new(formula, bounds)))
    }

    /// A box around it; `None` where it has no end.
    pub fn bounds(&self) -> Option<Bounds3> {
        let Extent { min, max } = match &self.kind {
            Kind::Revolved(revolved) => revolved.hull(),
            Kind::Formula(body) => body.extent,
        };
        (min.is_finite() && max.is_finite()).then(|| self.quadric.bounds(min, max))
    }

    /// Adds the spans of the ray inside of the body to `spans`, in order; its faces are numbered from `first`.
    pub fn spans(&self, ray: &Ray, range: Span, first: u32, spans: &mut Vec<Span>) {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        if d == DVec3::ZERO {
            return;
        }
        match &self.kind {
            Kind::Revolved(revolved) => {
                let Some(within) = revolved.extent.clip(o, d, range, first + FLAT) else { return };
                match revolved.rho {
                    None => spans.push(within),
                    Some(rho) => spans.extend(revolved.inside(rho, o, d).into_iter().filter_map(|[a, b]| {
                        let [a, b] = [a, b].map(|t| Crossing { t, face: first + CURVED });
                        let enter = if a.t > within[0].t { a } else { within[0] };
                        let leave = if b.t < within[1].t { b } else { within[1] };
                        (enter.t < leave.t).then_some([enter, leave])
                    })),
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

    /// What is known of the surface where the ray met a face at about `t`.
    pub fn surface(&self, ray: &Ray, t: f32, face: u32) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        if face >= FLAT {
            let axis = ((face - FLAT) / 2) as usize;
            let is_high = (face - FLAT) % 2 == 1;
            let extent = self.extent();
            let at = if is_high { extent.max[axis] } else { extent.min[axis] };
            let mut p = o + d * ((at - o[axis]) / d[axis]);
            p[axis] = at;
            let gradient = if is_high { DVec3::AXES[axis] } else { -DVec3::AXES[axis] };
            let level = Level { p, gradient, hessian: DMat3::ZERO, center: extent.center(), d };
            return level.surface(&self.quadric, reach(o, d, Root { t: t.into(), error: 0.0 }), ray);
        }
        match &self.kind {
            Kind::Revolved(revolved) => {
                let level = revolved.level(o, d, t);
                let error = level.p.abs() * ROUNDING;
                level.surface(&self.quadric, error, ray)
            }
            Kind::Formula(body) => {
                let root = body.refined(o, d, t);
                body.level(o + d * root.t, d).surface(&self.quadric, reach(o, d, root), ray)
            }
        }
    }

    fn extent(&self) -> Extent {
        match &self.kind {
            Kind::Revolved(revolved) => revolved.extent,
            Kind::Formula(body) => body.extent,
        }
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
    // Looks at every root and wants none.
    body.find(o, d, [enter.t, leave.t], |root| {
        piece(Crossing { t: root.t, face });
        false
    });
    if let Some(start) = piece(leave) {
        spans.push([start, leave]);
    }
}

/// A solid of revolution around the z axis.
#[derive(Clone, Debug)]
struct Revolved {
    /// ρ(z) by ascending powers; everything where there is none.
    rho: Option<[f64; 3]>,
    /// Between its heights.
    extent: Extent,
}

impl Revolved {
    /// A box around the body.
    fn hull(&self) -> Extent {
        let Extent { min, max } = self.extent;
        let Some(rho @ [_, b, c]) = self.rho else { return self.extent };
        let at = |z: f64| rho_at(rho, z);
        let top = (-0.5 * b / c).clamp(min.z, max.z);
        let widest = [min.z, max.z, if top.is_finite() { top } else { max.z }];
        let r = widest.into_iter().map(at).fold(0.0, f64::max).sqrt();
        Extent { min: DVec3::new(-r, -r, min.z), max: DVec3::new(r, r, max.z) }
    }

    /// Where a ray is inside of x² + y² ≤ ρ(z), regardless of heights: one or two stretches.
    fn inside(&self, [r0, r1, r2]: [f64; 3], o: DVec3, d: DVec3) -> impl IntoIterator<Item = [f64; 2]> {
        const FAR: f64 = f64::INFINITY;
        let nearest = (self.extent.center() - o).dot(d) / d.dot(d);
        let o = o + d * nearest;
        // a·t² + 2b·t + c ≤ 0.
        let a = d.x * d.x + d.y * d.y - r2 * d.z * d.z;
        let b = o.x * d.x + o.y * d.y - (r2 * o.z + 0.5 * r1) * d.z;
        let c = o.x * o.x + o.y * o.y - rho_at([r0, r1, r2], o.z);
        let stretches: [Option<[f64; 2]>; 2] = if a == 0.0 {
            let root = -0.5 * c / b;
            match (b, c) {
                (b, _) if b > 0.0 => [Some([-FAR, root]), None],
                (b, _) if b < 0.0 => [Some([root, FAR]), None],
                (_, c) if c <= 0.0 => [Some([-FAR, FAR]), None],
                _ => [None, None],
            }
        } else {
            let discriminant = b * b - a * c;
            // A ray that only touches is inside nowhere, or everywhere.
            if discriminant <= 0.0 {
                [(a < 0.0).then_some([-FAR, FAR]), None]
            } else {
                let q = -(b + discriminant.sqrt().copysign(b));
                let (s, t) = (q / a, c / q);
                let [first, last] = if s < t { [s, t] } else { [t, s] };
                if a > 0.0 { [Some([first, last]), None] } else { [Some([-FAR, first]), Some([last, FAR])] }
            }
        };
        stretches.into_iter().flatten().map(move |ends| ends.map(|t| t + nearest))
    }

    /// The curved face at the crossing nearest to `t`, put back on the surface.
    fn level(&self, o: DVec3, d: DVec3, t: f32) -> Level {
        let rho = self.rho.unwrap_or_default();
        let rounded = f64::from(t);
        let roots = self.inside(rho, o, d).into_iter().flatten();
        let t = roots.min_by(|a, b| (a - rounded).abs().total_cmp(&(b - rounded).abs())).unwrap_or(rounded);
        let gradient = |p: DVec3| DVec3::new(2.0 * p.x, 2.0 * p.y, -rho[1] - 2.0 * rho[2] * p.z);
        let mut p = o + d * t;
        for _ in 0..2 {
            let slope = gradient(p);
            let height = p.x * p.x + p.y * p.y - rho_at(rho, p.z);
            let step = slope * (height / slope.length_squared());
            if step.is_finite() {
                p -= step;
            }
        }
        let hessian = DMat3::from_diagonal(DVec3::new(2.0, 2.0, -2.0 * rho[2]));
        Level { p, gradient: gradient(p), hessian, center: self.extent.center(), d }
    }
}

fn rho_at([r0, r1, r2]: [f64; 3], z: f64) -> f64 {
    r0 + z * (r1 + z * r2)
}
