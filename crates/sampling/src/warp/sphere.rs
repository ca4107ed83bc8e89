//! Sampling directions: the sphere, the upper hemisphere, and a cone around +z.
//!
//! Uniform warps follow Archimedes: z is uniform, the angle around it too. A cosine-weighted
//! direction is a uniform point of the disk lifted to the hemisphere [Malley 1988]. Densities are
//! per solid angle.

use super::disk::turn;
use super::{invert_uniform_disk_concentric, sample_uniform_disk_concentric};
use lanes::{Each, Real};
use math::{Vec2, Vec3, Vector3, safe_sqrt, spherical_direction};
use std::f32::consts::{FRAC_1_PI, PI, TAU};

/// A direction of the sphere.
#[inline(always)]
pub fn sample_uniform_sphere<R: Real>(u: Vec2<R>) -> Vector3<R> {
    let [one, two] = [1.0, 2.0].each(R::splat);
    let z = one - two * u.x;
    // 1 − z² without cancellation at the poles.
    spherical_direction(two * safe_sqrt(u.x * (one - u.x)), z, u.y * R::splat(TAU))
}

/// Density of [`sample_uniform_sphere`].
#[inline]
pub fn uniform_sphere_pdf() -> f32 {
    0.25 * FRAC_1_PI
}

/// Inverse of [`sample_uniform_sphere`].
#[inline]
pub fn invert_uniform_sphere(w: Vector3) -> Vec2 {
    Vec2::new(0.5 * (1.0 - w.z), turn(w.x, w.y))
}

/// A direction of the hemisphere z ≥ 0.
#[inline(always)]
pub fn sample_uniform_hemisphere<R: Real>(u: Vec2<R>) -> Vector3<R> {
    spherical_direction(safe_sqrt(R::one() - u.x * u.x), u.x, u.y * R::splat(TAU))
}

/// Density of [`sample_uniform_hemisphere`] where z ≥ 0.
#[inline]
pub fn uniform_hemisphere_pdf() -> f32 {
    0.5 * FRAC_1_PI
}

/// Inverse of [`sample_uniform_hemisphere`].
#[inline]
pub fn invert_uniform_hemisphere(w: Vector3) -> Vec2 {
    Vec2::new(w.z, turn(w.x, w.y))
}

/// A direction of the hemisphere z ≥ 0 with density proportional to z.
#[inline(always)]
pub fn sample_cosine_hemisphere<R: Real>(u: Vec2<R>) -> Vector3<R> {
    let d = sample_uniform_disk_concentric(u);
    Vec3::new(d.x, d.y, safe_sqrt(R::one() - d.length_squared()))
}

/// Density of [`sample_cosine_hemisphere`] at a direction with this z; 0 below the horizon.
#[inline(always)]
pub fn cosine_hemisphere_pdf<R: Real>(cos_theta: R) -> R {
    cos_theta.max(R::zero()) * R::splat(FRAC_1_PI)
}

/// Inverse of [`sample_cosine_hemisphere`].
#[inline]
pub fn invert_cosine_hemisphere(w: Vector3) -> Vec2 {
    invert_uniform_disk_concentric(Vec2::new(w.x, w.y))
}

/// A direction whose angle with +z has at least the cosine `cos_theta_max`.
#[inline(always)]
pub fn sample_uniform_cone<R: Real>(u: Vec2<R>, cos_theta_max: R) -> Vector3<R> {
    let [one, two] = [1.0, 2.0].each(R::splat);
    // 1 − cos θ, which is accurate for narrow cones.
    let lost = u.x * (one - cos_theta_max);
    spherical_direction(safe_sqrt(lost * (two - lost)), one - lost, u.y * R::splat(TAU))
}

/// Density of [`sample_uniform_cone`] inside the cone.
#[inline(always)]
pub fn uniform_cone_pdf<R: Real>(cos_theta_max: R) -> R {
    R::one() / (R::splat(2.0 * PI) * (R::one() - cos_theta_max))
}

/// Inverse of [`sample_uniform_cone`].
#[inline]
pub fn invert_uniform_cone(w: Vector3, cos_theta_max: f32) -> Vec2 {
    Vec2::new((1.0 - w.z) / (1.0 - cos_theta_max), turn(w.x, w.y))
}
