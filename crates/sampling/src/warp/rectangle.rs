//! A rectangle as seen from a point, sampled uniformly by solid angle [Ureña 2013], [Pharr 2023 §A.5.4].
//!
//! In a frame along the sides with the rectangle at z₀ < 0, the solid angle left of x is uniform in u₀; given x, the height
//! on the sphere is uniform in u₁.

use math::{DVec3, Point3, Vec2, Vector3};

/// A rectangle as seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    origin: DVec3,
    axes: [DVec3; 3],
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// The rectangle with a corner and two sides at right angles, seen from `p`; `None` if it has no solid angle there.
    pub fn new(p: Point3, corner: Point3, side_x: Vector3, side_y: Vector3) -> Option<SphericalRectangle> {
        let (side_x, side_y) = (side_x.as_dvec3(), side_y.as_dvec3());
        let (axis_x, axis_y) = (side_x.try_normalize()?, side_y.try_normalize()?);
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
            x: [x, x + side_x.length()],
            y: [y, y + side_y.length()],
            z,
            solid_angle: 0.0,
        };
        rectangle.solid_angle = rectangle.solid_angle_up_to(rectangle.x[1]);
        (z < 0.0 && rectangle.solid_angle > 0.0).then_some(rectangle)
    }

    /// In steradians.
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// The density of [`sample`](Self::sample) per solid angle.
    #[inline]
    pub fn pdf(&self) -> f32 {
        (1.0 / self.solid_angle) as f32
    }

    /// A point of the rectangle.
    pub fn sample(&self, u: Vec2) -> Point3 {
        let Self { x: [x0, x1], y: [y0, y1], z, .. } = *self;
        // z components of the normals of the planes through p and the sides at y₀ and y₁.
        let b0 = -y0 / y0.hypot(z);
        let b1 = y1 / y1.hypot(z);
        // The spherical angles at the corners (x₀, y₀) and (x₀, y₁), which do not depend on where the cut is.
        let cos_corner = |y: f64| (x0 * y / (x0.hypot(z) * y.hypot(z))).clamp(-1.0, 1.0);
        let fixed = (-cos_corner(y0)).acos() + cos_corner(y1).acos();
        let angle = u.x as f64 * self.solid_angle - fixed;
        let f = (angle.cos() * b0 - b1) / angle.sin();
        let cos_u = (1.0 / (f * f + b0 * b0).sqrt()).copysign(f).clamp(-1.0, 1.0);
        let x = (-(cos_u * z) / (1.0 - cos_u * cos_u).max(1e-300).sqrt()).clamp(x0, x1);

        let distance = x.hypot(z);
        let (h0, h1) = (y0 / distance.hypot(y0), y1 / distance.hypot(y1));
        let h = h0 + u.y as f64 * (h1 - h0);
        let y = (h * distance / (1.0 - h * h).max(1e-300).sqrt()).clamp(y0, y1);
        let [axis_x, axis_y, axis_z] = self.axes;
        (self.origin + x * axis_x + y * axis_y + z * axis_z).as_vec3()
    }

    /// The `u` that [`sample`](Self::sample) sends to a point of the rectangle.
    pub fn invert(&self, point: Point3) -> Vec2 {
        let d = point.as_dvec3() - self.origin;
        let x = d.dot(self.axes[0]).clamp(self.x[0], self.x[1]);
        let y = d.dot(self.axes[1]).clamp(self.y[0], self.y[1]);
        let distance = x.hypot(self.z);
        let height = |y: f64| y / distance.hypot(y);
        let (h0, h1) = (height(self.y[0]), height(self.y[1]));
        let u0 = self.solid_angle_up_to(x) / self.solid_angle;
        let u1 = (height(y) - h0) / (h1 - h0);
        Vec2::new(u0.clamp(0.0, 1.0) as f32, u1.clamp(0.0, 1.0) as f32)
    }

    /// The solid angle of the part left of `x`: a signed sum of arctangents over its four corners.
    fn solid_angle_up_to(&self, x: f64) -> f64 {
        let corner = |x: f64, y: f64| {
            let distance = (x * x + y * y + self.z * self.z).sqrt();
            (x * y / (-self.z * distance)).atan()
        };
        let [y0, y1] = self.y;
        corner(x, y1) - corner(x, y0) - corner(self.x[0], y1) + corner(self.x[0], y0)
    }
}
