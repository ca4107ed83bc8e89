//! Lights: emission and light sampling.
//!
//! Emission is [`LightRef::radiance`] of emitting surfaces and [`LightRef::le`] for rays that leave
//! the scene. For next-event estimation, [`LightRef::sample_li`] samples a direction from a point
//! to the light, and [`LightRef::pdf_li`] is its density per solid angle. Lights at a point or in
//! one direction (delta lights) can only be sampled, never hit: their pdf is 0.
//!
//! For light paths, [`LightRef::sample_le`] samples a ray with two densities. That of its position
//! is per area of the surface; for lights infinitely far away, which have none, it is per area that
//! faces the ray: on a disk of the scene's radius R it is 1/(πR²). That of its direction is per
//! solid angle. Where one of the two is fixed, its delta has the coefficient 1. The ray's
//! throughput β has the light's power as its mean,
//!
//! ```text
//! β = L·|cos θ| / (p_position·p_direction)        E[β] = Φ
//! ```
//!
//! with θ at the light's surface (|cos θ| = 1 where there is none) and L the radiance, or for
//! lights at a point the radiant intensity. [`LightRef::pdf_le`] and [`LightRef::pdf_le_infinite`]
//! are the densities of a given ray, 0 for a delta: bidirectional methods use them to weight paths
//! that hit the light from the camera ([Pharr 2016 §16.1.2]).
//!
//! All functions depend on the shutter time: samples and densities at time t are those of the light
//! as it is placed at t.
//!
//! Each kind of light implements [`LightModel`]. A row of the scene's table of lights is a
//! [`Light`]; the row of an emitting geometry holds one light per primitive. A [`LightRef`] is one
//! light with the tables that it refers to; its methods are the interface to lights.
//!
//! Radiometric scale follows the pbrt-v4 format: a light's spectrum is first divided by its
//! photometric integral, so that a scale of 1 is a luminance of 1.

mod area;
mod bounds;
mod distant;
mod emission;
mod emitter;
mod goniometric;
mod image_infinite;
mod point;
mod portal_infinite;
mod projection;
mod scene_sphere;
mod screen;
mod spot;
mod table;
mod uniform_infinite;

pub use crate::id::{EmissionId, LightId};
pub use area::AreaLight;
pub use bounds::LightBounds;
pub use distant::DistantLight;
pub use emission::{AreaEmission, Emission, EmissionImage};
pub use geometry::ShapeSampleContext as LightSampleContext;
pub use goniometric::GoniometricLight;
pub use image_infinite::ImageInfiniteLight;
pub use point::PointLight;
pub use portal_infinite::{PlainPortal, Portal, PortalInfiniteLight, PortalRadiance, RectifiedImage};
pub use projection::{ProjectionLight, Slide};
pub use scene_sphere::SceneSphere;
pub use spot::SpotLight;
pub(crate) use table::LightTable;
pub use table::{LightPart, LightRef, Lights};
pub use uniform_infinite::UniformInfiniteLight;

use math::{Normal3, Point2, Point3, Point3Error, Ray, Vector3, closed_set};
use spectrum::{SampledSpectrum, SampledWavelengths};

closed_set! {
    /// A row of the table of lights.
    #[derive(Clone, Debug)]
    pub enum Light {
        /// See [`PointLight`].
        Point(PointLight),
        /// See [`SpotLight`].
        Spot(SpotLight),
        /// See [`DistantLight`].
        Distant(DistantLight),
        /// See [`AreaLight`].
        Area(AreaLight),
        /// See [`UniformInfiniteLight`].
        UniformInfinite(UniformInfiniteLight),
        /// See [`ImageInfiniteLight`].
        ImageInfinite(Box<ImageInfiniteLight>),
        /// See [`PortalInfiniteLight`].
        PortalInfinite(Box<PortalInfiniteLight>),
        /// See [`GoniometricLight`].
        Goniometric(Box<GoniometricLight>),
        /// See [`ProjectionLight`].
        Projection(Box<ProjectionLight>),
    }
    each each_light $
}

use each_light;

/// The interface of a kind of light. `part` is the primitive of an emitting geometry, with the
/// tables of the scene; other kinds of lights ignore it.
pub trait LightModel {
    /// Whether it can only be sampled, never hit by a ray.
    fn is_delta(&self) -> bool;

    /// Whether rays that leave the scene receive its radiance.
    fn is_infinite(&self) -> bool {
        false
    }

    /// Whether it is infinitely far away, so that its light has a direction but no origin.
    fn is_distant(&self) -> bool {
        self.is_infinite()
    }

    /// Whether emitted rays of a light infinitely far away start within the scene, so that what
    /// lies behind their origins occludes them, too.
    fn emits_within_scene(&self) -> bool {
        false
    }

    /// Emitted power. If the size changes with time, the mean of the powers at the start and the
    /// end of motion.
    #[doc(alias = "Phi")]
    fn phi(&self, part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum;

    /// A direction from `context` to the light, chosen by `u`; `None` if it has no radiance.
    ///
    /// With `allow_incomplete` the light may leave out directions that BSDF sampling covers well,
    /// as long as the caller combines both with the pdf of the same flag.
    #[doc(alias = "SampleLi")]
    fn sample_li(
        &self,
        part: &LightPart,
        context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample>;

    /// Density per solid angle with which [`sample_li`](Self::sample_li) chooses the unit direction
    /// `wi`, along which a ray has hit the light at `point`; 0 for delta lights.
    #[doc(alias = "PDF_Li")]
    fn pdf_li(
        &self,
        _part: &LightPart,
        _context: &LightSampleContext,
        _wi: Vector3,
        _point: LightPoint,
        _allow_incomplete: bool,
    ) -> f32 {
        0.0
    }

    /// An emitted ray at `time`, its position chosen by `u_position` and its direction by
    /// `u_direction`; `None` if it has no radiance.
    #[doc(alias = "SampleLe")]
    fn sample_le(
        &self,
        part: &LightPart,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample>;

    /// Densities of position and direction with which [`sample_le`](Self::sample_le) chooses the
    /// ray that leaves the light's point `p`, where its normal is `n` (zero at a light without a
    /// surface), along the unit direction `w` at `time`. Both are 0 for lights infinitely far away.
    #[doc(alias = "PDF_Le")]
    fn pdf_le(&self, _part: &LightPart, _p: Point3, _n: Normal3, _w: Vector3, _time: f32) -> (f32, f32) {
        (0.0, 0.0)
    }

    /// Densities of position and direction with which [`sample_le`](Self::sample_le) of a light
    /// infinitely far away chooses the ray that arrives along `ray`, a ray of unit direction that
    /// leaves the scene towards the light. Both are 0 for other lights, and for rays that are never
    /// chosen: those that miss the scene's sphere or start beyond the disk, or miss the portal.
    #[doc(alias = "PDF_Le")]
    fn pdf_le_infinite(&self, _ray: &Ray) -> (f32, f32) {
        (0.0, 0.0)
    }

    /// Radiance along a ray that leaves the scene.
    #[doc(alias = "Le")]
    fn le(&self, _ray: &Ray, _lambda: &SampledWavelengths) -> SampledSpectrum {
        SampledSpectrum::ZERO
    }

    /// Radiance that an emitting surface sends along `w` from a point with normal `n` and
    /// coordinates `uv`.
    #[doc(alias = "L")]
    fn radiance(
        &self,
        _part: &LightPart,
        _n: Normal3,
        _uv: Point2,
        _w: Vector3,
        _lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        SampledSpectrum::ZERO
    }

    /// Bounds over all times; `None` for lights infinitely far away.
    fn bounds(&self, _part: &LightPart) -> Option<LightBounds> {
        None
    }
}

/// A point of a light and its normal there, zero where it has none; `None` if the light is
/// infinitely far away.
pub type LightPoint = Option<(Point3, Normal3)>;

/// A sample of incident light, before its visibility is tested.
#[derive(Clone, Copy, Debug)]
pub struct LightLiSample {
    /// Incident radiance; for delta lights, the coefficient of a delta that cancels with that of
    /// `pdf`.
    pub l: SampledSpectrum,
    /// Unit direction from the reference point to the light.
    pub wi: Vector3,
    /// Density per solid angle at the reference point; 1 for delta lights.
    pub pdf: f32,
    /// Point of the light; `None` for lights infinitely far away.
    pub p: Option<Point3Error>,
    /// Normal of the light's surface there; zero where it has none.
    pub n: Normal3,
}

impl LightLiSample {
    /// The shadow ray from a surface to the light, and its end.
    pub fn shadow_ray(&self, from: &LightSampleContext) -> (Ray, f32) {
        match self.p {
            Some(p) => (Ray::between(from.p, from.n, p, self.n, from.time), Ray::SHADOW_END),
            None => (from.spawn_ray(self.wi), f32::INFINITY),
        }
    }
}

/// A sampled ray that leaves a light.
#[derive(Clone, Copy, Debug)]
pub struct LightLeSample {
    /// Radiance along the ray; for lights at a point, radiant intensity.
    pub l: SampledSpectrum,
    /// The ray, of unit direction; its origin is offset from the surface against self-intersection.
    pub ray: Ray,
    /// Point of the light; `None` for lights infinitely far away.
    pub p: Option<Point3Error>,
    /// Normal of the light's surface there; zero where it has none.
    pub n: Normal3,
    /// Density of the position per area; 1 for lights at a point.
    pub pdf_position: f32,
    /// Density of the direction per solid angle; 1 for lights in one direction.
    pub pdf_direction: f32,
}

impl LightLeSample {
    /// Initial path throughput: L·|cos θ| over the densities.
    pub fn beta(&self) -> SampledSpectrum {
        let cos_theta = if self.n == Normal3::ZERO { 1.0 } else { self.n.dot(self.ray.d).abs() };
        self.l * (cos_theta / (self.pdf_position * self.pdf_direction))
    }
}
