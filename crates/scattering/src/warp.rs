//! Directions of the upper hemisphere from points of the unit square [Pharr 2023 §A.5].

use math::{Vec2, Vec3, Vector3, safe_sqrt, spherical_direction};
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4, TAU};

/// A point of the unit disk, by concentric squares [Shirley 1997].
#[inline]
fn sample_uniform_disk_concentric(u: Vec2) -> Vec2 {
    let offset = 2.0 * u - Vec2::ONE;
    if offset == Vec2::ZERO {
        return Vec2::ZERO;
    }
    let (radius, theta) = if offset.x.abs() > offset.y.abs() {
        (offset.x, FRAC_PI_4 * offset.y / offset.x)
    } else {
        (offset.y, FRAC_PI_2 - FRAC_PI_4 * offset.x / offset.y)
    };
    radius * Vec2::from_angle(theta)
}

/// A direction with a density proportional to its cosine.
#[inline]
pub fn sample_cosine_hemisphere(u: Vec2) -> Vector3 {
    let d = sample_uniform_disk_concentric(u);
    Vec3::new(d.x, d.y, safe_sqrt(1.0 - d.length_squared()))
}

/// The density of [`sample_cosine_hemisphere`].
#[inline]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta * FRAC_1_PI
}

/// An even direction.
#[inline]
pub fn sample_uniform_hemisphere(u: Vec2) -> Vector3 {
    spherical_direction(safe_sqrt(1.0 - u.x * u.x), u.x, TAU * u.y)
}
