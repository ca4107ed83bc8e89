//! A rectangle as seen from a point, sampled uniformly by solid angle [Ureña 2013],
//! [Pharr 2023 §A.5.4].
//!
//! In a frame along the sides with the rectangle at z < 0 and d = |(x, y, z)|, the solid angle
//! between the planes through the point and the lines at 0 and x is
//!
//! ```text
//! φ(x) = atan(x·y₁ / (−z·d₁)) − atan(x·y₀ / (−z·d₀))
//! ```
//!
//! so that φ is uniform in u₀ between φ(x₀) and φ(x₁); given x, the height on the sphere is uniform
//! in u₁. In floats the solid angle is off by a few 10⁻⁷ steradians, so that rectangles of less
//! than about 10⁻² are better sampled by area.

use lanes::{Real, atan2, sin_cos};
use math::{Point3, Vec2, Vector3, balance};

/// A rectangle as seen from a point, for each lane.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle<R: Real = f32> {
    origin: Point3<R>,
    /// A power of two by which lengths are multiplied, whose powers would overflow or vanish.
    unit: R,
    axes: [Vector3<R>; 3],
    /// One by the lengths of the sides, in these units as all that follow.
    scales: [R; 2],
    x: [R; 2],
    y: [R; 2],
    z: R,
    /// φ at the ends of x.
    phi: [R; 2],
}

impl<R: Real> SphericalRectangle<R> {
    /// The rectangle with a corner and two sides at right angles, seen from `p`.
    #[inline(always)]
    pub fn new(p: Point3<R>, corner: Point3<R>, side_x: Vector3<R>, side_y: Vector3<R>) -> Self {
        let d = corner - p;
        let largest = d.abs().max(side_x.abs().max(side_y.abs())).max_element();
        let unit = balance(largest);
        let (d, side_x, side_y) = (d * unit, side_x * unit, side_y * unit);
        let (length_x, length_y) = (side_x.length(), side_y.length());
        let scales = [R::one() / length_x, R::one() / length_y];
        let (axis_x, axis_y) = (side_x * scales[0], side_y * scales[1]);
        let axis_z = axis_x.cross(axis_y);
        let z = d.dot(axis_z);
        let is_behind = z.gt(R::zero());
        let axis_z = Vector3::select(is_behind, -axis_z, axis_z);
        let (x, y) = (d.dot(axis_x), d.dot(axis_y));
        let mut rectangle = Self {
            origin: p,
            unit,
            axes: [axis_x, axis_y, axis_z],
            scales,
            x: [x, x + length_x],
            y: [y, y + length_y],
            z: -z.abs(),
            phi: [R::zero(); 2],
        };
        rectangle.phi = [rectangle.phi_at(rectangle.x[0]), rectangle.phi_at(rectangle.x[1])];
        rectangle
    }

    /// Where it has a solid angle. Elsewhere all else is meaningless.
    #[inline(always)]
    pub fn is_valid(&self) -> R::Mask {
        // NaN, where a side has no length, fails.
        self.z.lt(R::zero()) & self.phi[1].gt(self.phi[0])
    }

    /// In steradians.
    #[inline(always)]
    pub fn solid_angle(&self) -> R {
        self.phi[1] - self.phi[0]
    }

    /// The density of [`sample`](Self::sample) per solid angle.
    #[inline(always)]
    pub fn pdf(&self) -> R {
        R::one() / (self.phi[1] - self.phi[0])
    }

    /// A point of the rectangle, by the parts of the sides that lead to it. Divisions are few, as
    /// they take most of the time.
    #[inline(always)]
    pub fn sample(&self, u: Vec2<R>) -> Vec2<R> {
        let Self { x: [x0, x1], y: [y0, y1], z, scales, .. } = *self;
        let (z2, tiny) = (z * z, R::splat(f32::MIN_POSITIVE));
        // z components of the normals of the planes through p and the sides at y₀ and y₁.
        let [r0, r1] = inverse_lengths(z2, self.y);
        let (b0, b1) = (-(y0 * r0), y1 * r1);
        let (sin, cos) = sin_cos(self.phi[0] + u.x * (self.phi[1] - self.phi[0]));
        // f·sin φ, and (1 − b₀²)·sin² φ without cancellation: x = −z / √(f² − 1 + b₀²), with the
        // sign of f.
        let (f, rest) = (cos * b0 + b1, z * r0 * sin);
        let root = (f * f - rest * rest).max(tiny).sqrt();
        let x = (-z * sin / root.copysign(f)).clamp(x0, x1);

        let distance2 = x * x + z2;
        let [r0, r1] = inverse_lengths(distance2, self.y);
        let (h0, h1) = (y0 * r0, y1 * r1);
        let h = h0 + u.y * (h1 - h0);
        let y = (h * (distance2 / (R::one() - h * h).max(tiny)).sqrt()).clamp(y0, y1);
        let (zero, one) = (R::zero(), R::one());
        Vec2::new(((x - x0) * scales[0]).clamp(zero, one), ((y - y0) * scales[1]).clamp(zero, one))
    }

    /// The `u` that [`sample`](Self::sample) sends to a point of the rectangle.
    #[inline(always)]
    pub fn invert(&self, point: Point3<R>) -> Vec2<R> {
        let d = (point - self.origin) * self.unit;
        let x = d.dot(self.axes[0]).clamp(self.x[0], self.x[1]);
        let y = d.dot(self.axes[1]).clamp(self.y[0], self.y[1]);
        let [h0, h1, h] = [self.height(x, self.y[0]), self.height(x, self.y[1]), self.height(x, y)];
        let u0 = (self.phi_at(x) - self.phi[0]) / (self.phi[1] - self.phi[0]);
        let u1 = (h - h0) / (h1 - h0);
        Vec2::new(u0.clamp(R::zero(), R::one()), u1.clamp(R::zero(), R::one()))
    }

    /// The height on the sphere of a point of the rectangle.
    #[inline(always)]
    fn height(&self, x: R, y: R) -> R {
        y / (x * x + self.z * self.z + y * y).sqrt()
    }

    /// φ(x), both arctangents as one.
    #[inline(always)]
    fn phi_at(&self, x: R) -> R {
        let [y0, y1] = self.y;
        let square = x * x + self.z * self.z;
        let (sin0, cos0) = (x * y0, -self.z * (square + y0 * y0).sqrt());
        let (sin1, cos1) = (x * y1, -self.z * (square + y1 * y1).sqrt());
        atan2(sin1 * cos0 - cos1 * sin0, cos1 * cos0 + sin1 * sin0)
    }
}

/// 1/√(square + y²) of both y, by one division.
#[inline(always)]
fn inverse_lengths<R: Real>(square: R, [y0, y1]: [R; 2]) -> [R; 2] {
    let (length0, length1) = ((square + y0 * y0).sqrt(), (square + y1 * y1).sqrt());
    let inverse = R::one() / (length0 * length1);
    [length1 * inverse, length0 * inverse]
}
