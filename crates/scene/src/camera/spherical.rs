//! The spherical camera: one point that looks in every direction, as is needed to record an environment map.
//!
//! With (s, t) the film position over the resolution, the equirectangular mapping looks at θ = πt from +y and
//! φ = 2πs from +x towards +z; the equal-area mapping unfolds the sphere into an octahedron ([Clarberg
//! 2008]), so that all pixels see the same solid angle, 4π/n for n pixels. Film positions beyond the border,
//! where wide reconstruction filters reach, continue on the sphere ([Pharr 2023 §5.3]).

use description::SphericalMapping;
use math::{
    Point2, Point3, Vec2, Vec3, Vector3, equal_area_square_to_sphere, spherical_direction,
    wrap_equal_area_square,
};
use std::f32::consts::{PI, TAU};

/// All directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spherical {
    mapping: SphericalMapping,
    resolution: Vec2,
}

impl Spherical {
    /// The sphere of directions spread over `resolution` pixels.
    pub fn new(mapping: SphericalMapping, resolution: [u32; 2]) -> Self {
        Self { mapping, resolution: Vec2::new(resolution[0] as f32, resolution[1] as f32) }
    }

    /// Origin and unit direction, in camera space.
    #[inline]
    pub(super) fn ray(&self, film: Point2) -> (Point3, Vector3) {
        let st = film / self.resolution;
        let z_up = match self.mapping {
            SphericalMapping::EquiRectangular => {
                let (sin_theta, cos_theta) = (PI * st.y).sin_cos();
                spherical_direction(sin_theta, cos_theta, TAU * st.x)
            }
            SphericalMapping::EqualArea => equal_area_square_to_sphere(wrap_equal_area_square(st)),
        };
        (Vec3::ZERO, Vec3::new(z_up.x, z_up.z, z_up.y))
    }
}
