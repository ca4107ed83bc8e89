//! Cameras.
//!
//! A [`Camera`] generates the ray of a film position. It consists of a [`Projection`] in camera
//! space, a [`CameraTransform`] to render space, and a shutter.
//!
//! Conventions: camera space looks along +z, x to the right, y up (a left-handed frame, as in
//! pbrt). Film positions are in pixels, x to the right and y down, (0, 0) at the top left corner of
//! the picture, so that the centre of pixel (i, j) is (i + ½, j + ½). Rays are in render space,
//! their directions have unit length, and their `time` is in the scene's units. For paths from the
//! lights, [`Camera::we`] is the importance of a ray and [`Camera::sample_wi`] samples the lens
//! from a point: a pixel's value is ∫∫ W_e·h·L·cos θ dω dA for its filter h of integral 1 over the
//! film in pixels. Differentials are one pixel wide; [`differential_scale`] is the factor on them
//! for many samples per pixel.

mod aperture;
mod compile;
mod exit_pupil;
mod film_positions;
mod importance;
#[cfg(test)]
mod importance_tests;
mod lens;
mod minimum_differentials;
mod orthographic;
mod perspective;
mod projection;
mod realistic;
#[cfg(test)]
mod realistic_tests;
mod screen;
mod spherical;
#[cfg(test)]
mod tests;
mod transform;

use lanes::{Each, MAX_LANES, Real};
use math::{
    CameraEnd, Differentials, Normal3, Point2, Point3, Ray, RayDifferential, Transform, Vec2, Vec3, Vector3,
    lerp,
};

pub use compile::compile;
pub use film_positions::FilmPositions;
pub use importance::CameraWiSample;
pub use minimum_differentials::{MinimumDifferentials, differential_scale};
pub use orthographic::Orthographic;
pub use perspective::Perspective;
pub use projection::Projection;
pub use realistic::{PlainLens, Realistic};
pub use screen::{Screen, ThinLens};
pub use spherical::Spherical;
pub use transform::{CameraTransform, world_from_render};

/// A sample of film, lens and shutter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSample<R = f32> {
    /// Position on the film, in pixels.
    pub film: Point2<R>,
    /// Sample value in [0, 1)² for the position on the lens.
    pub lens: Vec2<R>,
    /// Sample value in [0, 1) for the shutter time.
    pub time: R,
    /// Weight of the sample in its pixel, from the reconstruction filter.
    pub filter_weight: R,
}

/// A ray from a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// The ray, in render space.
    pub ray: Ray,
    /// The share of the radiance along the ray that reaches the film.
    pub weight: f32,
}

/// A ray from a camera, and the rays of the neighbouring pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRayDifferential {
    /// The ray with its neighbours, in render space.
    pub ray: RayDifferential,
    /// The share of the radiance along the ray that reaches the film.
    pub weight: f32,
}

/// A camera in a scene.
#[derive(Clone, Debug)]
pub struct Camera {
    projection: Projection,
    transform: CameraTransform,
    shutter: [f32; 2],
    minimum_differentials: MinimumDifferentials,
}

impl Camera {
    /// A camera that takes a picture of `resolution` pixels (width, height) while the shutter is
    /// open, from `shutter[0]` to `shutter[1]`.
    pub fn new(
        projection: Projection,
        transform: CameraTransform,
        shutter: [f32; 2],
        resolution: [u32; 2],
    ) -> Self {
        let minimum_differentials = MinimumDifferentials::new(&projection, resolution);
        Self { projection, transform, shutter, minimum_differentials }
    }

    /// The same camera with pixels `n` times as wide and high: film position x of the new camera is
    /// n·x of this one.
    pub fn coarser(&self, n: u32) -> Self {
        Self {
            projection: self.projection.coarser(n),
            transform: self.transform.clone(),
            shutter: self.shutter,
            minimum_differentials: self.minimum_differentials.coarser(n),
        }
    }

    /// The mapping from film positions to rays of camera space.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// The transforms between camera, render and world space.
    pub fn transform(&self) -> &CameraTransform {
        &self.transform
    }

    /// The smallest differences between rays of neighbouring pixels.
    pub fn minimum_differentials(&self) -> &MinimumDifferentials {
        &self.minimum_differentials
    }

    /// When the shutter opens and closes.
    pub fn shutter(&self) -> [f32; 2] {
        self.shutter
    }

    /// The shutter time of a sample value in [0, 1), in the scene's units.
    #[inline(always)]
    pub fn sample_time<R: Real>(&self, u: R) -> R {
        lerp(u, R::splat(self.shutter[0]), R::splat(self.shutter[1]))
    }

    /// Whether it moves while the shutter is open.
    pub fn is_moving(&self) -> bool {
        self.transform.animated().is_moving()
    }

    /// Whether rays depend on samples of the lens.
    pub fn has_lens(&self) -> bool {
        self.projection.has_lens()
    }

    /// Whether all of the radiance along each ray reaches the film.
    pub fn is_unweighted(&self) -> bool {
        self.projection.is_unweighted()
    }

    /// The ray of a sample, and the share of the radiance along it that reaches the film: 0 for a
    /// ray that is blocked.
    #[inline(always)]
    pub fn ray<R: Real>(&self, sample: &CameraSample<R>) -> (Ray<R>, R) {
        let (o, d, weight) = self.projection.ray(sample.film, sample.lens);
        let ray = self.transform.ray(&Ray::new(o, d, self.sample_time(sample.time)));
        (Ray { d: ray.d.normalize(), camera: CameraEnd::Origin, ..ray }, weight)
    }

    /// The ray of a sample; `None` where no light reaches that point of the film.
    #[doc(alias = "GenerateRay")]
    pub fn generate_ray(&self, sample: &CameraSample) -> Option<CameraRay> {
        let (ray, weight) = self.ray(sample);
        (weight > 0.0).then_some(CameraRay { ray, weight })
    }

    /// The ray of a sample with the rays one pixel to the right and one pixel down, through the
    /// same point of the lens at the same time.
    #[doc(alias = "GenerateRayDifferential")]
    pub fn generate_ray_differential(&self, sample: &CameraSample) -> Option<CameraRayDifferential> {
        let (ray, differentials, weight) = self.ray_and_neighbours(sample);
        let ray = RayDifferential { ray, differentials: Some(differentials) };
        (weight > 0.0).then_some(CameraRayDifferential { ray, weight })
    }

    /// The ray of a sample with those of the pixels to the right and down, and its weight, for each
    /// lane: [`generate_ray_differential`](Self::generate_ray_differential).
    #[inline(always)]
    pub fn ray_and_neighbours<R: Real>(&self, sample: &CameraSample<R>) -> (Ray<R>, Differentials<R>, R) {
        let time = self.sample_time(sample.time);
        let (o, d, weight, near) = self.projection.ray_differential(sample.film, sample.lens);
        let ray = self.transform.ray(&Ray::new(o, d, time));
        let rx = self.transform.ray(&Ray::new(near.rx_origin, near.rx_direction, time));
        let ry = self.transform.ray(&Ray::new(near.ry_origin, near.ry_direction, time));
        // A transform that scales changes the length of directions. All three are divided by the
        // same factor, to keep their differences.
        let factor = R::one() / ray.d.length();
        let differentials = Differentials {
            rx_origin: rx.o,
            rx_direction: rx.d * factor,
            ry_origin: ry.o,
            ry_direction: ry.d * factor,
        };
        (Ray { d: ray.d * factor, camera: CameraEnd::Origin, ..ray }, differentials, weight)
    }

    /// The approximate footprint of a pixel on the tangent plane of a surface at `p` with normal
    /// `n` (render space), as if the camera saw it directly: ∂p/∂x and ∂p/∂y, each times `scale`
    /// (see [`differential_scale`]). For surfaces that a path reaches without ray differentials.
    #[doc(alias = "Approximate_dp_dxy")]
    #[inline(always)]
    pub fn approximate_dp_dxy<R: Real>(
        &self,
        p: Point3<R>,
        n: Normal3<R>,
        time: R,
        scale: f32,
    ) -> [Vector3<R>; 2] {
        let render_from_camera = self.transform.animated();
        if !render_from_camera.is_moving() {
            return self.dp_dxy(p, n, render_from_camera.start(), scale);
        }
        let [p, n] = [p, n].each(|v| v.to_array().each(R::to_array));
        let time = time.to_array();
        let mut across = [[[0.0; MAX_LANES]; 3]; 2];
        for lane in 0..R::LANES {
            let [p, n] = [&p, &n].each(|v| Vec3::new(v[0][lane], v[1][lane], v[2][lane]));
            let found = self.dp_dxy(p, n, &render_from_camera.at(time[lane]), scale);
            for (columns, v) in across.iter_mut().zip(found) {
                (columns[0][lane], columns[1][lane], columns[2][lane]) = (v.x, v.y, v.z);
            }
        }
        across.each(|v| Vec3::from_array(v.each(|column| R::load(&column))))
    }

    #[inline(always)]
    fn dp_dxy<R: Real>(
        &self,
        p: Point3<R>,
        n: Normal3<R>,
        render_from_camera: &Transform,
        scale: f32,
    ) -> [Vector3<R>; 2] {
        let camera_from_render = render_from_camera.inverse();
        let (d, distance) = self.projection.way_to(camera_from_render.affine_point(p));
        let [x, y] = self.minimum_differentials.dp_dxy(d, distance, camera_from_render.normal(n));
        let scale = R::splat(scale);
        [render_from_camera.vector_lanes(x * scale), render_from_camera.vector_lanes(y * scale)]
    }
}
