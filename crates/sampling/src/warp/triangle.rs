//! Triangles: in the plane, uniformly by area; as seen from a point, uniformly by solid angle.
//!
//! The plane warp folds the square along its diagonal without a square root [Heitz 2019].
//!
//! The spherical one cuts off a part of the triangle with u₀ of its solid angle Ω by a line from
//! corner 1 to the opposite side, then walks u₁ along that line [Arvo 1995]. Let a, b and c be the
//! unit directions to the corners, and a⊥ the unit vector at right angles to a on the side of c.
//! The solid angle, and that between a, b and the direction at the angle φ from a towards c, are
//! [Van Oosterom 1983]
//!
//! ```text
//! tan(Ω/2) = V / (1 + a·b + b·c + c·a)        V = |a·(b × c)|
//! tan(u₀Ω/2) = h·W / (1 + a·b + h·b·a⊥)       W = |a·(b × a⊥)|,  h = tan(φ/2)
//! ```
//!
//! of which the second is solved for h without cancellation. Angles become places along the sides
//! of the triangle itself, so that points lie inside of it however small it looks.

use lanes::{Real, atan2, sin_cos};
use math::{Point3, Vec2, Vec3, Vector3, balance};

/// Barycentric coordinates, uniform over a triangle.
#[inline(always)]
pub fn sample_uniform_triangle<R: Real>(u: Vec2<R>) -> [R; 3] {
    let below = u.x.lt(u.y);
    let half = R::select(below, u.x, u.y) * R::splat(0.5);
    let rest = R::select(below, u.y, u.x) - half;
    let (b0, b1) = (R::select(below, half, rest), R::select(below, rest, half));
    [b0, b1, R::one() - b0 - b1]
}

/// Density of [`sample_uniform_triangle`] per area of the (b₀, b₁) plane.
#[inline]
pub fn uniform_triangle_pdf() -> f32 {
    2.0
}

/// Inverse of [`sample_uniform_triangle`].
#[inline]
pub fn invert_uniform_triangle(b: [f32; 3]) -> Vec2 {
    if b[0] > b[1] { Vec2::new(b[0] + b[1], 2.0 * b[1]) } else { Vec2::new(2.0 * b[0], b[1] + b[0]) }
}

/// A triangle as seen from a point, for each lane.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle<R: Real = f32> {
    /// From the point to corner 0, all lengths in units of a power of two near the largest.
    to_corner: Vector3<R>,
    /// From corner 0 to corners 1 and 2.
    sides: [Vector3<R>; 2],
    /// Distances of the corners.
    distances: [R; 3],
    /// Unit directions to corners 0 and 1.
    a: Vector3<R>,
    b: Vector3<R>,
    /// 1 + a·b.
    one_plus_cos: R,
    volume: R,
    solid_angle: R,
}

impl<R: Real> SphericalTriangle<R> {
    /// The triangle with these corners seen from `p`.
    #[inline(always)]
    pub fn new(corners: [Point3<R>; 3], p: Point3<R>) -> Self {
        let [p0, p1, p2] = corners;
        let (v0, v1, v2) = (p0 - p, p1 - p, p2 - p);
        // Powers of lengths may overflow or vanish.
        let unit = balance(v0.abs().max(v1.abs().max(v2.abs())).max_element());
        let (v0, v1, v2) = (v0 * unit, v1 * unit, v2 * unit);
        let sides = [(p1 - p0) * unit, (p2 - p0) * unit];
        let (l0, l1, l2) = (v0.length(), v1.length(), v2.length());
        let (a, b, c) = (v0 * (R::one() / l0), v1 * (R::one() / l1), v2 * (R::one() / l2));
        // All corners have the same product with the normal; that of the nearest is rounded least.
        let n = (sides[0] * (R::one() / l1)).cross(sides[1] * (R::one() / l2));
        let nearest = Vec3::select(l1.lt(l0), v1, v0);
        let nearest = Vec3::select(l2.lt(l0.min(l1)), v2, nearest);
        let volume = (nearest.dot(n) * (R::one() / l0)).abs();
        let one_plus_cos = R::splat(0.5) * (a + b).length_squared();
        let solid_angle = R::splat(2.0) * atan2(volume, one_plus_cos + c.dot(a + b));
        let distances = [l0, l1, l2];
        Self { to_corner: v0, sides, distances, a, b, one_plus_cos, volume, solid_angle }
    }

    /// Where it has a solid angle. Elsewhere all else is meaningless.
    #[inline(always)]
    pub fn is_valid(&self) -> R::Mask {
        // NaN, where a corner is the point, fails.
        self.volume.gt(R::zero()) & self.solid_angle.gt(R::zero())
    }

    /// In steradians.
    #[inline(always)]
    pub fn solid_angle(&self) -> R {
        self.solid_angle
    }

    /// The density of [`sample`](Self::sample) per solid angle.
    #[inline(always)]
    pub fn pdf(&self) -> R {
        R::one() / self.solid_angle
    }

    /// A point of the triangle, by its barycentric coordinates at corners 1 and 2.
    #[inline(always)]
    pub fn sample(&self, u: Vec2<R>) -> Vec2<R> {
        let [l0, l1, l2] = self.distances;
        let side = Line::new(l0, self.a, self.sides[1]);
        let (sin, cos) = sin_cos(R::splat(0.5) * u.x * self.solid_angle);
        // h as a fraction; V·l₂/height is W.
        let across = self.sides[1] - self.a * side.along;
        let above = sin * self.one_plus_cos;
        let below = (cos * (self.volume * l2) - sin * (self.sides[0].dot(across) / l1)) / side.height;
        let below = below.max(R::zero());
        let t = side.place(R::splat(2.0) * above * below, (below - above) * (below + above));

        let line = Line::new(l1, self.b, self.sides[1] * t - self.sides[0]);
        let rise = u.y * line.one_minus_cos(R::one());
        let sin = (rise * (R::splat(2.0) - rise)).max(R::zero()).sqrt();
        let s = line.place(sin, R::one() - rise);
        Vec2::new(R::one() - s, s * t)
    }

    /// The `u` that [`sample`](Self::sample) sends to a point of the triangle.
    #[inline(always)]
    pub fn invert(&self, point: Vec2<R>) -> Vec2<R> {
        let [zero, one] = [R::zero(), R::one()];
        let [_, l1, l2] = self.distances;
        let s = (one - point.x).max(zero);
        let t = R::select(s.gt(zero), point.y / s, zero).clamp(zero, one);
        let to_side = self.to_corner + self.sides[1] * t;
        let denominator = self.one_plus_cos * to_side.length() + to_side.dot(self.a + self.b);
        let cut_off = R::splat(2.0) * atan2(t * (self.volume * l2), denominator);
        let line = Line::new(l1, self.b, self.sides[1] * t - self.sides[0]);
        let u = Vec2::new(cut_off / self.solid_angle, line.one_minus_cos(s) / line.one_minus_cos(one));
        Vec2::new(u.x.clamp(zero, one), u.y.clamp(zero, one))
    }
}

/// A line from a corner, in the plane of the line and the point that it is seen from.
#[derive(Clone, Copy)]
struct Line<R: Real> {
    /// Distance of the corner.
    distance: R,
    /// The line's components along the direction to the corner and at right angles to it.
    along: R,
    height: R,
}

impl<R: Real> Line<R> {
    #[inline(always)]
    fn new(distance: R, direction: Vector3<R>, line: Vector3<R>) -> Self {
        let along = line.dot(direction);
        Self { distance, along, height: (line - direction * along).length() }
    }

    /// The place in [0, 1] along the line that is seen at an angle from the corner, given by sine
    /// and cosine up to a common factor.
    #[inline(always)]
    fn place(&self, sin: R, cos: R) -> R {
        let below = (self.height * cos - self.along * sin).max(R::splat(f32::MIN_POSITIVE));
        (self.distance * sin / below).clamp(R::zero(), R::one())
    }

    /// 1 − cos of the angle from the corner at which a place is seen, without cancellation.
    #[inline(always)]
    fn one_minus_cos(&self, place: R) -> R {
        let (x, y) = (self.distance + place * self.along, place * self.height);
        let distance = (x * x + y * y).sqrt();
        R::select(x.gt(R::zero()), y * y / (distance + x), distance - x) / distance
    }
}
