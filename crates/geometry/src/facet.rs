//! Ray tests of triangles and nearly flat patches in lanes.
//!
//! A *facet* is a triangle or a bilinear patch p(u, v) = corner + u·e₁ + v·e₂ + uv·twist. A ray
//! o + t·d meets the plane through its corner along e₁ and e₂, which has the normal N, at
//!
//! - t = −(N·(o − c) + k) / N·d, where c is a point near the middle and k its height, and
//! - x = U·(o − c + t·d) + x₀, and y likewise by V, where U and V are the dual vectors of e₁, e₂.
//!
//! These are the parameters u and v where there is no twist [Baldwin 2016]. With a twist of
//! (a, b, h) along e₁, e₂ and N they solve u·(1 + v·A) = x and v·(1 + u·B) = y, where
//! A = a − h·U·d/N·d and B = b − h·V·d/N·d, and the height uv·h adds to t.
//!
//! Where h is no more than rounding, the patch is a plane quadrilateral: x and y tell whether it is
//! hit, by the lines of its edges, and only the nearest hit needs u and v.
//!
//! This is computed in floats. A bound of all errors tells hits and misses from what floats cannot
//! decide: hits near edges or near an end of the ray, and rays along the plane. The shape's own
//! test resolves those, so that facets with a common edge leave no gap, and a ray does not hit the
//! surface that it leaves.

use lanes::{Mask, Real};
use math::{DVec3, Vec3, Vector3};

/// The numbers of a [`Facet`].
pub(crate) const FIELDS: usize = 21;
/// The numbers of a [`Twist`].
pub(crate) const TWIST_FIELDS: usize = 6;

/// The relative error of one rounding.
const UNIT: f64 = f32::EPSILON as f64 / 2.0;

/// Where |d| / |N·d| is above this, N·d may have the wrong sign.
const GRAZING: f32 = (1.0 / (8.0 * UNIT)) as f32;

/// A triangle or patch as its own test has it.
pub(crate) struct FacetFrame {
    pub corner: DVec3,
    pub sides: [DVec3; 2],
    pub twist: DVec3,
    pub is_triangle: bool,
    /// How far outside of [0, 1] parameters are accepted.
    pub beyond: f64,
}

/// A facet, one in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Facet<R: Real> {
    center: Vector3<R>,
    /// N, whose components have magnitudes that sum up to 1.
    normal: Vector3<R>,
    /// The height of the center above the plane.
    height: R,
    /// U and V.
    duals: [Vector3<R>; 2],
    /// x and y of the center.
    middle: [R; 2],
    /// The slopes of the edges opposite to y and x axis: x ≤ 1 + y·slants[0], and
    /// y ≤ 1 + x·slants[1]. Both are −1 in triangles, 0 in parallelograms.
    slants: [R; 2],
    /// The error of x and y is at most `error`·|d|/|N·d|·(`size` + |t·d|).
    error: R,
    size: R,
    /// That error is at least `scale`·|d| times the error of t.
    scale: R,
    /// The sign of smaller heights is uncertain.
    near: R,
}

/// The twist of a facet that is not plane.
#[derive(Clone, Copy)]
pub(crate) struct Twist<R: Real> {
    /// a, b and h.
    by: [R; 3],
    /// Where |d|/|N·d| is above this, there may be two hits.
    tame: R,
    /// x and y of the patch are at most `spread` + `lift`·|d|/|N·d| outside of [0, 1].
    spread: R,
    lift: R,
}

/// A facet as numbers.
pub(crate) struct FacetValues {
    /// The fields of [`Facet`], in their order.
    pub facet: [f32; FIELDS],
    /// Those of [`Twist`], of a patch that is not plane.
    pub twist: Option<[f32; TWIST_FIELDS]>,
    /// The twist a and b of a plane patch, for its [`parameters`]; else 0.
    pub skew: [f32; 2],
}

impl FacetFrame {
    /// The facet as numbers; `None` where floats cannot hold them, or where the patch is no
    /// perturbation of a parallelogram.
    pub fn values(&self) -> Option<FacetValues> {
        let Self { corner, sides: [e1, e2], twist, is_triangle, beyond } = *self;
        let cross = e1.cross(e2);
        let [u, v] = [e2.cross(cross), cross.cross(e1)].map(|dual| dual / cross.length_squared());
        let norm = |w: DVec3| w.abs().element_sum();
        let n = cross / norm(cross);
        let by = [u, v, n].map(|w| w.dot(twist));
        let mut corners = vec![DVec3::ZERO, e1, e2];
        if !is_triangle {
            corners.push(e1 + e2 + twist);
        }
        let low = corners.iter().fold(e1, |low, p| low.min(*p));
        let high = corners.iter().fold(e1, |high, p| high.max(*p));
        let center = (corner + (low + high) / 2.0).as_vec3();
        let from_corner = center.as_dvec3() - corner;
        let extent =
            corners.iter().fold(DVec3::ZERO, |extent, p| extent.max((*p - from_corner).abs())) * 1.01;
        let size = extent.max_element();
        let dual = norm(u).max(norm(v));
        let [a, b, h] = by;
        // An unknown height within h has the effect of a size that is this much larger.
        let blur = h.abs() / (16.0 * UNIT);
        let is_plane = blur <= size;
        let slants = match (is_triangle, is_plane) {
            (true, _) => [-1.0; 2],
            (false, true) => [a / (1.0 + b), b / (1.0 + a)],
            (false, false) => [0.0; 2],
        };
        let size = if is_plane { size + blur } else { size };
        // Beyond an edge, its line is up to so many times farther away than the parameter tells.
        let stretch = 1.0 + slants[0].abs().max(slants[1].abs());
        let scale = dual * stretch;
        let error = 16.0 * UNIT * scale;
        let is_sound = [size, 1.0 / size, dual, norm(corner)].iter().all(|x| *x < 1e12)
            && size * dual < 1e3
            && a.abs() + b.abs() <= 0.25;
        if !is_sound {
            return None;
        }
        let near = 6.0 * UNIT * n.abs().dot(extent) + if is_plane { h.abs() } else { 0.0 };
        let middle = [u, v].map(|dual| dual.dot(from_corner));
        let [n3, u3, v3] = [n, u, v].map(|w| w.to_array());
        let vectors = [center.as_dvec3().to_array(), n3, u3, v3].concat();
        let size = size + beyond * stretch / error;
        let (height, [x, y], [right, up]) = (n.dot(from_corner), middle, slants);
        let rest = [height, x, y, right, up, error, size, scale, near];
        let mut facet = [0.0; FIELDS];
        facet.iter_mut().zip(vectors.iter().chain(&rest)).for_each(|(value, x)| *value = *x as f32);
        let lift = h.abs() * dual;
        let spread = a.abs().max(b.abs());
        let twist = [a, b, h, 1.0 / (8.0 * lift), spread, lift].map(|x| x as f32);
        let skew = if is_plane && !is_triangle { [a as f32, b as f32] } else { [0.0; 2] };
        Some(FacetValues { facet, twist: (!is_plane).then_some(twist), skew })
    }
}

impl<R: Real> Facet<R> {
    #[inline(always)]
    pub fn of(values: [R; FIELDS]) -> Self {
        let [cx, cy, cz, nx, ny, nz, ux, uy, uz, vx, vy, vz, rest @ ..] = values;
        let [height, x, y, right, up, error, size, scale, near] = rest;
        Self {
            center: Vec3::new(cx, cy, cz),
            normal: Vec3::new(nx, ny, nz),
            height,
            duals: [Vec3::new(ux, uy, uz), Vec3::new(vx, vy, vz)],
            middle: [x, y],
            slants: [right, up],
            error,
            size,
            scale,
            near,
        }
    }
}

impl<R: Real> Twist<R> {
    #[inline(always)]
    pub fn of([a, b, h, tame, spread, lift]: [R; TWIST_FIELDS]) -> Self {
        Self { by: [a, b, h], tame, spread, lift }
    }
}

/// Rays, one in each lane.
#[derive(Clone, Copy)]
pub(crate) struct RayLanes<R: Real> {
    o: Vector3<R>,
    d: Vector3<R>,
    /// |d|, the largest component; infinite where a product with it could underflow or overflow.
    length: R,
    t_max: R,
    /// Whether any has an end.
    is_bounded: bool,
}

/// Where rays meet facets, for each lane.
#[derive(Clone, Copy)]
pub(crate) struct Meeting<R: Real> {
    /// A hit before the end of the ray.
    pub certain: R::Mask,
    /// Perhaps a hit as near as the nearest one.
    pub uncertain: R::Mask,
    /// Distance of certain hits, and x and y of plane facets, u and v of others.
    pub t: R,
    pub at: [R; 2],
}

impl<R: Real> RayLanes<R> {
    /// Rays and their ends, and a mask of those that can hit anything.
    #[inline(always)]
    pub fn new(o: Vector3<R>, d: Vector3<R>, t_max: R, is_bounded: bool) -> (Self, R::Mask) {
        let length = d.abs().max_element();
        let (zero, infinite) = (R::zero(), R::splat(f32::INFINITY));
        // NaN, infinity times zero, is lost by a maximum.
        let finite = (dot(o, Vec3::splat(zero), zero) + dot(d, Vec3::splat(zero), zero)).eq(zero);
        let valid = finite & (R::one() / length).lt(infinite) & t_max.gt(zero);
        let (small, large) = (R::splat(1e-18), R::splat(1e18));
        let ordinary = length.gt(small) & length.lt(large) & o.abs().max_element().lt(large);
        (Self { o, d, length: R::select(ordinary, length, infinite), t_max, is_bounded }, valid)
    }

    /// Meets plane facets, where the nearest hit so far is at `nearest`.
    #[inline(always)]
    pub fn meet(&self, facet: &Facet<R>, nearest: R) -> Meeting<R> {
        self.judge(facet, &self.on_plane(facet), nearest)
    }

    /// Meets patches that are not plane.
    #[inline(always)]
    pub fn meet_patch(&self, facet: &Facet<R>, twist: &Twist<R>, nearest: R) -> Meeting<R> {
        let plane = self.on_plane(facet);
        let margin = twist.lift.mul_add(plane.secant, plane.error + twist.spread);
        let outside = (plane.inside + margin).lt(R::zero()) & !plane.grazes;
        if outside.all() {
            let none = R::Mask::splat(false);
            return Meeting { certain: none, uncertain: none, t: plane.t, at: plane.at };
        }
        let Meeting { certain, uncertain, t, at } =
            self.judge(facet, &self.untwist(facet, twist, &plane), nearest);
        Meeting { certain: certain & !outside, uncertain: uncertain & !outside, t, at }
    }

    /// Where the plane along a facet's sides is met.
    #[inline(always)]
    fn on_plane(&self, facet: &Facet<R>) -> OnPlane<R> {
        let from_center = self.o - facet.center;
        let inverse = R::splat(-1.0) / dot(facet.normal, self.d, R::zero());
        let height = dot(facet.normal, from_center, facet.height);
        let t = height * inverse;
        let secant = inverse.abs() * self.length;
        let reach = height.abs().mul_add(secant, facet.size);
        let error = facet.error * secant * reach;
        let p = Vec3::new(
            t.mul_add(self.d.x, from_center.x),
            t.mul_add(self.d.y, from_center.y),
            t.mul_add(self.d.z, from_center.z),
        );
        let x = dot(facet.duals[0], p, facet.middle[0]);
        let y = dot(facet.duals[1], p, facet.middle[1]);
        let grazes = !secant.lt(R::splat(GRAZING));
        let inside = facet.inside(x, y);
        OnPlane { t, at: [x, y], height, inside, error, near: facet.near, inverse, secant, grazes }
    }

    /// From the plane of a facet's sides to the twisted patch.
    #[inline(always)]
    fn untwist(&self, facet: &Facet<R>, twist: &Twist<R>, plane: &OnPlane<R>) -> OnPlane<R> {
        let [a, b, h] = twist.by;
        let slope = h * plane.inverse;
        let a = slope.mul_add(dot(facet.duals[0], self.d, R::zero()), a);
        let b = slope.mul_add(dot(facet.duals[1], self.d, R::zero()), b);
        let [u, v] = parameters([a, b], plane.at);
        let height = (u * v).mul_add(-h, plane.height);
        let error = R::splat(6.0) * plane.error;
        OnPlane {
            t: height * plane.inverse,
            at: [u, v],
            height,
            inside: facet.inside(u, v),
            error,
            near: h.abs().mul_add(error + error, plane.near),
            grazes: plane.grazes | !plane.secant.le(twist.tame),
            ..*plane
        }
    }

    /// Tells hits from misses. NaN, where a ray runs along the plane, is uncertain.
    #[inline(always)]
    fn judge(&self, facet: &Facet<R>, on: &OnPlane<R>, nearest: R) -> Meeting<R> {
        let &OnPlane { t, at, height, inside, error, near, grazes, .. } = on;
        let zero = R::zero();
        let is_clear = height.abs().gt(near);
        let ahead = t.gt(zero);
        let length = self.length * facet.scale;
        let mut certain = inside.ge(error) & is_clear & ahead & !grazes;
        if self.is_bounded {
            certain = certain & ((self.t_max - t) * length).gt(error);
        }
        let excluded = (inside + error).lt(zero) | (is_clear & !ahead) | ((t - nearest) * length).gt(error);
        Meeting { certain, uncertain: (!excluded | grazes) & !certain, t, at }
    }
}

/// Where rays meet the plane of a facet, or its patch.
#[derive(Clone, Copy)]
struct OnPlane<R: Real> {
    t: R,
    at: [R; 2],
    /// −1 / N·d, and |d| / |N·d|.
    inverse: R,
    secant: R,
    /// The height of the origin, by which it is far from the plane where it is above `near`.
    height: R,
    /// How far the point is inside, and the error of that.
    inside: R,
    error: R,
    near: R,
    /// Whether nothing is certain.
    grazes: R::Mask,
}

impl<R: Real> Facet<R> {
    /// How far x and y are inside of the facet, or below zero outside.
    #[inline(always)]
    fn inside(&self, x: R, y: R) -> R {
        let right = self.slants[0].mul_add(y, R::one() - x);
        let up = self.slants[1].mul_add(x, R::one() - y);
        x.min(y).min(right.min(up))
    }
}

/// u and v of the point at x and y of a patch whose twist is (a, b) in its plane: x and y
/// themselves where there is none.
#[inline(always)]
pub(crate) fn parameters<R: Real>([a, b]: [R; 2], [x, y]: [R; 2]) -> [R; 2] {
    // a·v² + linear·v − y = 0, and u = x / (1 + a·v), with one division.
    let one = R::one();
    let linear = b.mul_add(x, one - a * y);
    let y2 = y + y;
    let lower = linear + linear.mul_add(linear, a * (y2 + y2)).sqrt();
    let upper = a.mul_add(y2, lower);
    let scale = one / (lower * upper);
    [x * lower * lower * scale, y2 * upper * scale]
}

/// a·b + c.
#[inline(always)]
fn dot<R: Real>(a: Vector3<R>, b: Vector3<R>, c: R) -> R {
    a.x.mul_add(b.x, a.y.mul_add(b.y, a.z.mul_add(b.z, c)))
}
