//! The extent of a scene, as lights infinitely far away need it.

use math::{Bounds3, Frame, Point2, Point3, Ray, Vector3};
use sampling::warp;
use std::f32::consts::PI;

/// The bounding sphere of everything bounded. Unbounded geometry goes on beyond it, and may keep
/// the light of distant lights from it: see
/// [`Scene::sample_emission`](crate::Scene::sample_emission).
#[derive(Clone, Copy, Debug)]
pub struct SceneSphere {
    /// Centre in render space.
    pub center: Point3,
    /// Radius.
    pub radius: f32,
}

impl SceneSphere {
    /// The sphere around a box. Where nothing has an end, lights still need an extent to have a
    /// power: that is 1.
    pub fn around(bounds: &Bounds3) -> Self {
        let (center, radius) = bounds.bounding_sphere();
        Self { center, radius: if bounds.is_empty() { 1.0 } else { radius } }
    }

    /// The ray from an even choice of points of the disk that faces the direction `w` and touches
    /// the sphere from there, against `w`: how light from far away falls on all of the sphere.
    pub(super) fn ray_from(&self, w: Vector3, u: Point2, time: f32) -> Ray {
        let disk = warp::sample_uniform_disk_concentric(u);
        let o = self.center + Frame::from_z(w).from_local(disk.extend(1.0)) * self.radius;
        Ray::new(o, -w, time)
    }

    /// The density of such a choice per area of the disk.
    pub(super) fn disk_pdf(&self) -> f32 {
        1.0 / (PI * self.radius * self.radius)
    }

    /// The density with which that disk has a point on `ray`; 0 where the ray passes beside it.
    pub(super) fn pdf_facing_disk(&self, ray: &Ray) -> f32 {
        let to_center = self.center - ray.o;
        let along = to_center.dot(ray.d);
        let beside = (to_center - ray.d * along).length_squared() > self.radius * self.radius;
        if beside || -along > self.radius { 0.0 } else { self.disk_pdf() }
    }
}
