//! Rays r(t) = o + t·d at a shutter time, and ray differentials.

use crate::{Normal3, Point3, Point3Error, Vector3, offset_ray_origin};
use lanes::Real;

/// The end of a ray at which the camera is. The camera does not see the back faces of single-sided
/// surfaces, so that these rays pass through them; other rays meet both sides of all surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CameraEnd {
    /// The camera is at neither end, or was before the ray went on beyond an interface between
    /// media.
    #[default]
    Neither,
    /// A camera ray.
    Origin,
    /// A ray from a point of the scene towards the camera.
    Target,
}

/// A ray. The direction need not have unit length; t is in lengths of the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray<R = f32> {
    /// Origin.
    pub o: Point3<R>,
    /// Direction, of any length but zero.
    pub d: Vector3<R>,
    /// Shutter time.
    pub time: R,
    /// Where the camera is.
    pub camera: CameraEnd,
}

impl Ray {
    /// The end of a shadow ray as a fraction of the distance to its target: just short of the
    /// target's own surface.
    pub const SHADOW_END: f32 = 1.0 - 1e-4;
}

impl<R: Real> Ray<R> {
    /// A ray from `o` along `d`.
    #[inline(always)]
    pub fn new(o: Point3<R>, d: Vector3<R>, time: R) -> Self {
        Self { o, d, time, camera: CameraEnd::Neither }
    }

    /// The point o + t·d.
    #[inline(always)]
    pub fn at(&self, t: R) -> Point3<R> {
        self.o + self.d * t
    }

    /// The ray that leaves a surface at `p` with geometric normal `n` along `d`.
    #[inline(always)]
    pub fn spawn(p: Point3Error<R>, n: Normal3<R>, d: Vector3<R>, time: R) -> Self {
        Self::new(offset_ray_origin(p, n, d), d, time)
    }

    /// The ray from one surface to another, on which t = 1 is the (offset) target; pass
    /// [`Ray::SHADOW_END`] as its end. An end without a surface (a point light, a camera) has the
    /// normal zero.
    #[inline(always)]
    pub fn between(
        from: Point3Error<R>,
        from_n: Normal3<R>,
        to: Point3Error<R>,
        to_n: Normal3<R>,
        time: R,
    ) -> Self {
        let o = offset_ray_origin(from, from_n, to.p - from.p);
        let target = offset_ray_origin(to, to_n, o - to.p);
        Self::new(o, target - o, time)
    }
}

/// The rays through the neighbouring pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differentials<R = f32> {
    /// Origin one pixel to the right.
    pub rx_origin: Point3<R>,
    /// Direction one pixel to the right.
    pub rx_direction: Vector3<R>,
    /// Origin one pixel down.
    pub ry_origin: Point3<R>,
    /// Direction one pixel down.
    pub ry_direction: Vector3<R>,
}

impl<R: Real> Differentials<R> {
    /// Scales the differences from `ray` by `s`.
    #[inline(always)]
    pub fn scale(&mut self, ray: &Ray<R>, s: R) {
        let (o, dir) = (ray.o, ray.d);
        self.rx_origin = o + (self.rx_origin - o) * s;
        self.ry_origin = o + (self.ry_origin - o) * s;
        self.rx_direction = dir + (self.rx_direction - dir) * s;
        self.ry_direction = dir + (self.ry_direction - dir) * s;
    }
}

/// A ray with optional differentials, by which textures are filtered over the footprint of a pixel
/// ([Igehy 1999]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayDifferential {
    /// The ray itself.
    pub ray: Ray,
    /// The rays of the neighbouring pixels, where known.
    pub differentials: Option<Differentials>,
}

impl RayDifferential {
    /// Scales the differentials by `s`: with n samples per pixel their mean spacing is 1/√n.
    pub fn scale(&mut self, s: f32) {
        if let Some(d) = &mut self.differentials {
            d.scale(&self.ray, s);
        }
    }
}

impl From<Ray> for RayDifferential {
    fn from(ray: Ray) -> Self {
        Self { ray, differentials: None }
    }
}
