//! Importance: the camera as an emitter, to which light paths connect.
//!
//! A pixel's value is an integral over the rays (p, ω) that enter the camera through its lens, in
//! which the importance W_e weights radiance and h, of integral 1 over the film in pixels, is the
//! pixel's reconstruction filter:
//!
//! ```text
//! I = ∫∫ W_e(p, ω)·h(film(p, ω))·L(p, ω)·cos θ dω dA(p)
//! ```
//!
//! [`Camera::generate_ray`] must be an estimator of it with film positions drawn by h and weight 1.
//! So the film in pixels measures importance: W_e·cos θ·dω·dA, over all rays with film positions in
//! an area of the film, is that area (a film position is seen by all of the lens, and each part of
//! the lens has its share). With the film position uniform in one pixel and the point uniform on
//! the lens, a ray has the densities
//!
//! ```text
//! p_position = 1/A_lens        p_direction = d(film)/dω        W_e = p_position·p_direction/cos θ
//! ```
//!
//! of which the second is, for a pixel of the area A on the plane of focus at the distance f,
//! f²/(A·cos³θ): a perspective camera has W_e = 1/(A_1·A_lens·cos⁴θ), where A_1 is the pixel's area
//! at the distance 1. Deltas have the coefficient 1: a pinhole and the point of a spherical camera
//! have p_position = 1 (the latter has no normal, and cos θ = 1). The film of an orthographic
//! camera without a lens lies in the scene itself, and its direction is fixed: p_position =
//! 1/A_pixel, p_direction = 1.
//!
//! Areas, angles and normals are those of render space, also if the camera's transform scales or
//! shears. Every point in front of the camera has a film position, perhaps beside the film, as
//! filters reach over its border. The film of a spherical camera repeats beyond its border: the
//! film position returned is the one on the film, and [`Camera::film_positions`] lists the others.
//!
//! A camera with a system of lenses is not seen from the scene ([`Camera::is_unseen`]): the ray
//! from a point to a film position is not known in closed form. It has no importance here, so that
//! strategies that connect light paths to the camera find nothing.
//!
//! Sources: [Pharr 2016 §16.1.1]; [Veach 1997 ch. 8].

use super::Camera;
use super::projection::{Aperture, Projection};
use math::{Mat3, Normal3, Point2, Point3, Ray, Transform, Vec2, Vec3, Vector3};

/// A sample of the lens from a point of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraWiSample {
    /// Importance along the direction.
    pub we: f32,
    /// Unit direction from the point to the camera.
    pub wi: Vector3,
    /// Density per solid angle at the point, as d²/cos θ is for a pinhole; 1 where the direction is
    /// fixed. Exitant radiance L of the point, at an angle α to its normal, adds W_e·L·cos α / pdf
    /// to the film at `film`.
    pub pdf: f32,
    /// Position on the film, in pixels; perhaps beside it.
    pub film: Point2,
    /// Point of the lens.
    pub p: Point3,
    /// Unit normal of the lens, towards the scene; zero where it has none.
    pub n: Normal3,
}

/// Film position and densities of a ray.
struct Seen {
    film: Point2,
    n: Normal3,
    cos_theta: f32,
    pdf_position: f32,
    pdf_direction: f32,
}

impl Seen {
    fn we(&self) -> f32 {
        self.pdf_position * self.pdf_direction / self.cos_theta
    }
}

impl Camera {
    /// Whether all its rays are parallel, so that it has no lens to connect to.
    #[inline]
    pub fn is_parallel(&self) -> bool {
        matches!(self.projection.aperture(), Aperture::Film)
    }

    /// Whether light paths cannot be connected to it: it has no importance that could be computed.
    #[inline]
    pub fn is_unseen(&self) -> bool {
        matches!(self.projection.aperture(), Aperture::Unseen)
    }

    /// The importance of a ray that starts on the lens, at its time, and its film position, in
    /// pixels and perhaps beside the film; `None` for rays that do not leave the front of the
    /// camera.
    #[doc(alias = "We")]
    pub fn we(&self, ray: &Ray) -> Option<(f32, Point2)> {
        self.seen_along(ray).map(|seen| (seen.we(), seen.film))
    }

    /// The densities of a ray that starts on the lens: of its point per area of the lens, and of
    /// its direction per solid angle, with film positions uniform over the area of one pixel.
    /// Deltas have the coefficient 1.
    #[doc(alias = "Pdf_We")]
    pub fn pdf_we(&self, ray: &Ray) -> (f32, f32) {
        self.seen_along(ray).map_or((0.0, 0.0), |seen| (seen.pdf_position, seen.pdf_direction))
    }

    /// Samples a point of the lens by `u`, as seen from `p` at a time; `None` where `p` is not in
    /// front of the camera.
    #[doc(alias = "SampleWi")]
    pub fn sample_wi(&self, p: Point3, time: f32, u: Vec2) -> Option<CameraWiSample> {
        let render_from_camera = self.transform.render_from_camera(time);
        let seen_p = render_from_camera.inverse().point(p);
        let on_lens = self.projection.lens_point(seen_p, u);
        let seen = self.seen(&render_from_camera, on_lens, (seen_p - on_lens).try_normalize()?)?;
        let lens_p = render_from_camera.point(on_lens);
        let distance2 = p.distance_squared(lens_p);
        let pdf = if self.is_parallel() { 1.0 } else { seen.pdf_position * distance2 / seen.cos_theta };
        Some(CameraWiSample {
            we: seen.we(),
            wi: (lens_p - p).try_normalize()?,
            pdf,
            film: seen.film,
            p: lens_p,
            n: seen.n,
        })
    }

    fn seen_along(&self, ray: &Ray) -> Option<Seen> {
        let render_from_camera = self.transform.render_from_camera(ray.time);
        let camera_from_render = render_from_camera.inverse();
        let d = camera_from_render.vector(ray.d).try_normalize()?;
        self.seen(&render_from_camera, camera_from_render.point(ray.o), d)
    }

    /// Film position and densities of the ray from the lens point `o` along the unit direction `d`,
    /// both in camera space.
    fn seen(&self, render_from_camera: &Transform, o: Point3, d: Vector3) -> Option<Seen> {
        let (film, density) = self.projection.film(o, d)?;
        // The factor of the transform on volumes, from which follow those on areas of the plane z =
        // 0 and on solid angles.
        let volume = Mat3::from_mat4(*render_from_camera.matrix()).determinant().abs();
        let normal = render_from_camera.normal(Vec3::Z);
        let along = render_from_camera.vector(d);
        let area = volume * normal.length();
        let solid_angle = volume / along.length().powi(3);
        let (pdf_position, pdf_direction) = match self.projection.aperture() {
            Aperture::Point | Aperture::Pinhole => (1.0, density / solid_angle),
            Aperture::Lens(lens_area) => (1.0 / (lens_area * area), density / solid_angle),
            Aperture::Film => (density / area, 1.0),
            Aperture::Unseen => return None,
        };
        let (n, cos_theta) = match self.projection {
            Projection::Spherical(_) => (Vec3::ZERO, 1.0),
            _ => (normal.normalize(), d.z / (normal.length() * along.length())),
        };
        let seen = Seen { film, n, cos_theta, pdf_position, pdf_direction };
        (film.is_finite() && seen.we().is_finite()).then_some(seen)
    }
}
