//! The bounding sphere of a scene, for lights infinitely far away.

use math::{Bounds3, Frame, Point2, Point3, Ray, Vector3};
use sampling::warp;
use std::f32::consts::PI;

/// The bounding sphere of everything bounded. Unbounded geometry extends beyond it, and may occlude
/// distant lights: see [`Scene::sample_emission`](crate::Scene::sample_emission).
#[derive(Clone, Copy, Debug)]
pub struct SceneSphere {
    /// Centre in render space.
    pub center: Point3,
    /// Radius.
    pub radius: f32,
}

impl SceneSphere {
    /// The sphere around a box. In a scene without bounded shapes its radius is 1, as the power of
    /// lights needs one.
    pub fn around(bounds: &Bounds3) -> Self {
        let (center, radius) = bounds.bounding_sphere();
        Self { center, radius: if bounds.is_empty() { 1.0 } else { radius } }
    }

    /// A ray of direction −`w` from a uniform sample of the disk that touches the sphere in the
    /// direction `w`: incident light from infinity.
    pub(super) fn ray_from(&self, w: Vector3, u: Point2, time: f32) -> Ray {
        let disk = warp::sample_uniform_disk_concentric(u);
        let o = self.center + Frame::from_z(w).from_local(disk.extend(1.0)) * self.radius;
        Ray::new(o, -w, time)
    }

    /// The density of such samples per area of the disk.
    pub(super) fn disk_pdf(&self) -> f32 {
        1.0 / (PI * self.radius * self.radius)
    }

    /// The density of the disk's point on `ray`; 0 if the ray misses the sphere or starts beyond
    /// the disk.
    pub(super) fn pdf_facing_disk(&self, ray: &Ray) -> f32 {
        let to_center = self.center - ray.o;
        let along = to_center.dot(ray.d);
        let beside = (to_center - ray.d * along).length_squared() > self.radius * self.radius;
        if beside || -along > self.radius { 0.0 } else { self.disk_pdf() }
    }
}
