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
//! in u₁.

use math::{DVec3, Point3, Vec2, Vector3};

/// A rectangle as seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    origin: DVec3,
    axes: [DVec3; 3],
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
    /// φ at the ends of x.
    phi: [f64; 2],
}

impl SphericalRectangle {
    /// The rectangle with a corner and two sides at right angles, seen from `p`; `None` if it has
    /// no solid angle there.
    pub fn new(p: Point3, corner: Point3, side_x: Vector3, side_y: Vector3) -> Option<SphericalRectangle> {
        let (side_x, side_y) = (side_x.as_dvec3(), side_y.as_dvec3());
        let (length_x, length_y) = (side_x.length(), side_y.length());
        let (axis_x, axis_y) = (side_x * (1.0 / length_x), side_y * (1.0 / length_y));
        let mut axis_z = axis_x.cross(axis_y);
        let d = corner.as_dvec3() - p.as_dvec3();
        let mut z = d.dot(axis_z);
        if z > 0.0 {
            (z, axis_z) = (-z, -axis_z);
        }
        let (x, y) = (d.dot(axis_x), d.dot(axis_y));
        let mut rectangle = SphericalRectangle {
            origin: p.as_dvec3(),
            axes: [axis_x, axis_y, axis_z],
            x: [x, x + length_x],
            y: [y, y + length_y],
            z,
            phi: [0.0; 2],
        };
        rectangle.phi = rectangle.x.map(|x| rectangle.phi_at(x));
        // NaN, where a side has no length, fails.
        (z < 0.0 && rectangle.phi[1] > rectangle.phi[0]).then_some(rectangle)
    }

    /// In steradians.
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        (self.phi[1] - self.phi[0]) as f32
    }

    /// The density of [`sample`](Self::sample) per solid angle.
    #[inline]
    pub fn pdf(&self) -> f32 {
        (1.0 / (self.phi[1] - self.phi[0])) as f32
    }

    /// A point of the rectangle. (Squares of what were floats neither overflow nor vanish.)
    pub fn sample(&self, u: Vec2) -> Point3 {
        let Self { x: [x0, x1], y: [y0, y1], z, .. } = *self;
        // z components of the normals of the planes through p and the sides at y₀ and y₁.
        let [b0, b1] = [-y0, y1].map(|y| y / (y * y + z * z).sqrt());
        let (sin, cos) = (self.phi[0] + u.x as f64 * (self.phi[1] - self.phi[0])).sin_cos();
        let f = (cos * b0 + b1) / sin;
        let x = ((-z).copysign(f) / (f * f + b0 * b0 - 1.0).max(1e-300).sqrt()).clamp(x0, x1);

        let distance2 = x * x + z * z;
        let [h0, h1] = [y0, y1].map(|y| y / (distance2 + y * y).sqrt());
        let h = h0 + u.y as f64 * (h1 - h0);
        let y = (h * (distance2 / (1.0 - h * h).max(1e-300)).sqrt()).clamp(y0, y1);
        let [axis_x, axis_y, axis_z] = self.axes;
        (self.origin + x * axis_x + y * axis_y + z * axis_z).as_vec3().into()
    }

    /// The `u` that [`sample`](Self::sample) sends to a point of the rectangle.
    pub fn invert(&self, point: Point3) -> Vec2 {
        let d = point.as_dvec3() - self.origin;
        let x = d.dot(self.axes[0]).clamp(self.x[0], self.x[1]);
        let y = d.dot(self.axes[1]).clamp(self.y[0], self.y[1]);
        let height = |y: f64| y / (x * x + self.z * self.z + y * y).sqrt();
        let (h0, h1) = (height(self.y[0]), height(self.y[1]));
        let u0 = (self.phi_at(x) - self.phi[0]) / (self.phi[1] - self.phi[0]);
        let u1 = (height(y) - h0) / (h1 - h0);
        Vec2::new(u0.clamp(0.0, 1.0) as f32, u1.clamp(0.0, 1.0) as f32)
    }

    /// φ(x), both arctangents as one.
    fn phi_at(&self, x: f64) -> f64 {
        let [(sin0, cos0), (sin1, cos1)] =
            self.y.map(|y| (x * y, -self.z * (x * x + y * y + self.z * self.z).sqrt()));
        (sin1 * cos0 - cos1 * sin0).atan2(cos1 * cos0 + sin1 * sin0)
    }
}
