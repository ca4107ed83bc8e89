//! The spherical camera: one point that sees in every direction, for rendering environment maps.
//!
//! With (s, t) the film position over the resolution, the equirectangular mapping has θ = πt from
//! +y and φ = 2πs from +x towards +z; the equal-area mapping unfolds the sphere into an octahedron
//! ([Clarberg 2008]), so that all pixels see the same solid angle, 4π/n for n pixels. Film
//! positions beyond the border, where wide reconstruction filters reach, continue on the sphere
//! ([Pharr 2023 §5.3]).

use description::SphericalMapping;
use lanes::Real;
use math::{
    Point2, Point3, Vec2, Vec3, Vector3, equal_area_sphere_to_square, equal_area_square_to_sphere,
    spherical_direction, spherical_phi, wrap_equal_area_square,
};
use std::f32::consts::{PI, TAU};

/// The projection of all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spherical {
    mapping: SphericalMapping,
    resolution: Vec2,
}

impl Spherical {
    /// The sphere of directions, mapped to `resolution` pixels.
    pub fn new(mapping: SphericalMapping, resolution: [u32; 2]) -> Self {
        Self { mapping, resolution: Vec2::new(resolution[0] as f32, resolution[1] as f32) }
    }

    /// The same sphere in pixels `n` times as wide and high.
    pub(super) fn coarser(&self, n: u32) -> Self {
        Self { resolution: self.resolution / n as f32, ..*self }
    }

    /// How the sphere is mapped.
    pub fn mapping(&self) -> SphericalMapping {
        self.mapping
    }

    /// Width and height of the film, in pixels.
    pub fn resolution(&self) -> Vec2 {
        self.resolution
    }

    /// Origin and unit direction, in camera space.
    #[inline(always)]
    pub(super) fn ray<R: Real>(&self, film: Point2<R>) -> (Point3<R>, Vector3<R>) {
        let st = Vec2::new(film.x / R::splat(self.resolution.x), film.y / R::splat(self.resolution.y));
        let z_up = match self.mapping {
            SphericalMapping::EquiRectangular => {
                let (sin_theta, cos_theta) = lanes::sin_cos(R::splat(PI) * st.y);
                spherical_direction(sin_theta, cos_theta, R::splat(TAU) * st.x)
            }
            SphericalMapping::EqualArea => equal_area_square_to_sphere(wrap_equal_area_square(st)),
        };
        (Vec3::splat(R::zero()), Vec3::new(z_up.x, z_up.z, z_up.y))
    }

    /// The inverse of [`Self::ray`] on the film itself, and film area per solid angle: dω is
    /// 2π²·sin θ ds dt, or 4π ds dt for equal areas. `None` at the poles of the equirectangular
    /// mapping, each of which is mapped to a whole row.
    #[inline]
    pub(super) fn film(&self, d: Vector3) -> Option<(Point2, f32)> {
        let z_up = Vec3::new(d.x, d.z, d.y);
        let (st, solid_angle) = match self.mapping {
            SphericalMapping::EquiRectangular => {
                let sin_theta = lanes::hypot(d.x, d.z);
                let theta = lanes::atan2(sin_theta, d.y);
                (Vec2::new(spherical_phi(z_up) / TAU, theta / PI), 2.0 * PI * PI * sin_theta)
            }
            SphericalMapping::EqualArea => (equal_area_sphere_to_square(z_up), 4.0 * PI),
        };
        let pixels = self.resolution.x * self.resolution.y;
        (solid_angle > 0.0).then(|| (st * self.resolution, pixels / solid_angle))
    }
}
