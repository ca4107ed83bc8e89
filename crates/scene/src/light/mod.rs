//! Lights: what emits into the scene, and how a point finds it.
//!
//! A light answers two questions. *How much comes from there?* — [`Light::radiance`] for emitting
//! surfaces, [`Light::le`] for rays that leave the scene. *Where should I look?* —
//! [`Light::sample_li`] draws a direction from a point towards the light, [`Light::pdf_li`] is its
//! density per solid angle. Lights at a point or in one direction (delta lights) can only be
//! sampled, never hit: their pdf is 0.
//!
//! To follow light on its way there is a third question, *which rays leave?* — [`Light::sample_le`]
//! draws a ray with two densities. That of its position is per area of the surface; of lights
//! infinitely far away, which have none, per area of the disk of the scene's radius R that faces
//! them, 1/(πR²). That of its direction is per solid angle. Where one of the two is fixed, its
//! delta has the coefficient 1. What the ray carries on average is the light's power,
//!
//! ```text
//! β = L·|cos θ| / (p_position·p_direction)        E[β] = Φ
//! ```
//!
//! with θ at the light's surface (|cos θ| = 1 where there is none) and for L radiance, of lights at
//! a point radiant intensity. [`Light::pdf_le`] and [`Light::pdf_le_infinite`] are the densities of
//! a given ray, 0 for a delta: whoever has come to the light from the other side weighs with them
//! how likely light would have come that way ([Pharr 2016 §16.1.2]).
//!
//! Radiometric scale follows the pbrt-v4 format: a light's spectrum is first
//! divided by its photometric integral, so that a scale of 1 is a luminance of 1.

mod area;
mod bounds;
mod distant;
mod emission;
mod image_infinite;
mod point;
mod spot;
mod uniform_infinite;

pub use area::{AreaEmission, AreaLight, EmissionImage};
pub use bounds::LightBounds;
pub use distant::DistantLight;
pub use emission::Emission;
pub use geometry::ShapeSampleContext as LightSampleContext;
pub use image_infinite::ImageInfiniteLight;
pub use point::PointLight;
pub use spot::SpotLight;
pub use uniform_infinite::UniformInfiniteLight;

use crate::texture::Textures;
use math::{Bounds3, Frame, Normal3, Point2, Point3, Point3Error, Ray, Vector3};
use sampling::warp;
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// Index of a light in its scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LightId(pub u32);

/// One light.
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
}

/// Light that may arrive from a light, before visibility is known.
#[derive(Clone, Copy, Debug)]
pub struct LightLiSample {
    /// Incident radiance; for delta lights radiance whose delta cancels with that of `pdf`.
    pub l: SampledSpectrum,
    /// Unit direction from the reference point to the light.
    pub wi: Vector3,
    /// Density per solid angle at the reference point; 1 for delta lights.
    pub pdf: f32,
    /// Where on the light; `None` for lights infinitely far away.
    pub p: Option<Point3Error>,
    /// Normal of the light's surface there; zero where it has none.
    pub n: Normal3,
}

/// A ray of light on its way from a light.
#[derive(Clone, Copy, Debug)]
pub struct LightLeSample {
    /// Radiance along the ray; of lights at a point radiant intensity.
    pub l: SampledSpectrum,
    /// The way of the light, a unit direction; clear of the surface that it leaves.
    pub ray: Ray,
    /// Where on the light; `None` for lights infinitely far away.
    pub p: Option<Point3Error>,
    /// Normal of the light's surface there; zero where it has none.
    pub n: Normal3,
    /// Density of the position per area; 1 for lights at a point.
    pub pdf_position: f32,
    /// Density of the direction per solid angle; 1 for lights in one direction.
    pub pdf_direction: f32,
}

impl LightLeSample {
    /// What a particle that leaves along the ray carries: L·|cos θ| over the densities.
    pub fn beta(&self) -> SampledSpectrum {
        let cos_theta = if self.n == Normal3::ZERO { 1.0 } else { self.n.dot(self.ray.d).abs() };
        self.l * (cos_theta / (self.pdf_position * self.pdf_direction))
    }
}

/// Dispatch to the member.
macro_rules! each_light {
    ($self:expr, $light:ident => $e:expr) => {
        match $self {
            Light::Point($light) => $e,
            Light::Spot($light) => $e,
            Light::Distant($light) => $e,
            Light::Area($light) => $e,
            Light::UniformInfinite($light) => $e,
            Light::ImageInfinite($light) => $e,
        }
    };
}

impl Light {
    /// Whether it can only be sampled, never met by a ray.
    #[inline]
    pub fn is_delta(&self) -> bool {
        match self {
            Self::Point(_) | Self::Spot(_) | Self::Distant(_) => true,
            Self::Area(light) => light.is_invisible(),
            Self::UniformInfinite(_) | Self::ImageInfinite(_) => false,
        }
    }

    /// Whether rays that leave the scene meet it.
    #[inline]
    pub fn is_infinite(&self) -> bool {
        matches!(self, Self::UniformInfinite(_) | Self::ImageInfinite(_))
    }

    /// Whether it is infinitely far away, so that its light comes from a direction but from no
    /// place.
    #[inline]
    pub fn is_distant(&self) -> bool {
        matches!(self, Self::Distant(_)) || self.is_infinite()
    }

    /// Emitted power.
    #[doc(alias = "Phi")]
    pub fn phi(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        each_light!(self, light => light.phi(lambda))
    }

    /// A direction from `context` to the light, chosen by `u`, or `None` where nothing comes from.
    ///
    /// With `allow_incomplete` the light may leave out directions that BSDF sampling covers well,
    /// as long as the caller combines both with the pdf of the same flag.
    #[doc(alias = "SampleLi")]
    pub fn sample_li(
        &self,
        context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
        textures: &Textures,
    ) -> Option<LightLiSample> {
        match self {
            Self::Point(light) => light.sample_li(context, lambda),
            Self::Spot(light) => light.sample_li(context, lambda),
            Self::Distant(light) => light.sample_li(lambda),
            Self::Area(light) => light.sample_li(context, u, lambda, textures),
            Self::UniformInfinite(light) => light.sample_li(u, lambda, allow_incomplete),
            Self::ImageInfinite(light) => light.sample_li(u, lambda, allow_incomplete),
        }
    }

    /// Density per solid angle with which [`Light::sample_li`] chooses the unit direction `wi`.
    #[doc(alias = "PDF_Li")]
    pub fn pdf_li(&self, context: &LightSampleContext, wi: Vector3, allow_incomplete: bool) -> f32 {
        match self {
            Self::Point(_) | Self::Spot(_) | Self::Distant(_) => 0.0,
            Self::Area(light) => light.pdf_li(context, wi),
            Self::UniformInfinite(light) => light.pdf_li(allow_incomplete),
            Self::ImageInfinite(light) => light.pdf_li(wi, allow_incomplete),
        }
    }

    /// A ray of light that leaves at `time`, its position chosen by `u_position` and its direction
    /// by `u_direction`; `None` where no light does.
    #[doc(alias = "SampleLe")]
    pub fn sample_le(
        &self,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
        textures: &Textures,
    ) -> Option<LightLeSample> {
        match self {
            Self::Point(light) => light.sample_le(u_direction, time, lambda),
            Self::Spot(light) => light.sample_le(u_direction, time, lambda),
            Self::Distant(light) => light.sample_le(u_position, time, lambda),
            Self::Area(light) => light.sample_le(u_position, u_direction, time, lambda, textures),
            Self::UniformInfinite(light) => light.sample_le(u_position, u_direction, time, lambda),
            Self::ImageInfinite(light) => light.sample_le(u_position, u_direction, time, lambda),
        }
    }

    /// Densities of position and direction with which [`Light::sample_le`] chooses the ray that
    /// leaves the light's point `p`, where its normal is `n` (zero at a light without a surface),
    /// along the unit direction `w`. Both are 0 for lights infinitely far away.
    #[doc(alias = "PDF_Le")]
    pub fn pdf_le(&self, p: Point3, n: Normal3, w: Vector3) -> (f32, f32) {
        match self {
            Self::Point(light) => (0.0, light.pdf_le()),
            Self::Spot(light) => (0.0, light.pdf_le(w)),
            Self::Area(light) => light.pdf_le(p, n, w),
            Self::Distant(_) | Self::UniformInfinite(_) | Self::ImageInfinite(_) => (0.0, 0.0),
        }
    }

    /// Densities of position and direction with which [`Light::sample_le`] of a light infinitely
    /// far away chooses the ray that arrives along `ray`, a ray of unit direction that leaves the
    /// scene towards the light. Both are 0 for other lights, and where no chosen ray passes: beside
    /// the scene's sphere, and above the disk where they start.
    #[doc(alias = "PDF_Le")]
    pub fn pdf_le_infinite(&self, ray: &Ray) -> (f32, f32) {
        match self {
            Self::Distant(light) => (light.scene.pdf_facing_disk(ray), 0.0),
            Self::UniformInfinite(light) => (light.scene.pdf_facing_disk(ray), light.pdf_li(false)),
            Self::ImageInfinite(light) => (light.scene.pdf_facing_disk(ray), light.pdf_li(ray.d, false)),
            Self::Point(_) | Self::Spot(_) | Self::Area(_) => (0.0, 0.0),
        }
    }

    /// Radiance along a ray that leaves the scene.
    #[doc(alias = "Le")]
    pub fn le(&self, ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        match self {
            Self::UniformInfinite(light) => light.le(lambda),
            Self::ImageInfinite(light) => light.le(ray.d, lambda),
            Self::Point(_) | Self::Spot(_) | Self::Distant(_) | Self::Area(_) => SampledSpectrum::ZERO,
        }
    }

    /// Radiance that an emitting surface sends along `w` from a point with normal `n` and
    /// coordinates `uv`.
    #[doc(alias = "L")]
    pub fn radiance(
        &self,
        n: Normal3,
        uv: Point2,
        w: Vector3,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        match self {
            Self::Area(light) => light.radiance(n, uv, w, lambda),
            _ => SampledSpectrum::ZERO,
        }
    }

    /// Where it is and whereto it emits, for choosing among many; `None` for what is infinitely far
    /// away.
    pub fn bounds(&self) -> Option<LightBounds> {
        match self {
            Self::Point(light) => light.bounds(),
            Self::Spot(light) => light.bounds(),
            Self::Area(light) => light.bounds(),
            Self::Distant(_) | Self::UniformInfinite(_) | Self::ImageInfinite(_) => None,
        }
    }
}

/// The sphere around everything that has an end: how big the scene looks to lights that are
/// infinitely far away. What has no end goes on beyond it, and may keep their light from it: see
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
    fn ray_from(&self, w: Vector3, u: Point2, time: f32) -> Ray {
        let disk = warp::sample_uniform_disk_concentric(u);
        let o = self.center + Frame::from_z(w).from_local(disk.extend(1.0)) * self.radius;
        Ray::new(o, -w, time)
    }

    /// The density of such a choice per area of the disk.
    fn disk_pdf(&self) -> f32 {
        1.0 / (PI * self.radius * self.radius)
    }

    /// The density with which that disk has a point on `ray`; 0 where the ray passes beside it.
    fn pdf_facing_disk(&self, ray: &Ray) -> f32 {
        let to_center = self.center - ray.o;
        let along = to_center.dot(ray.d);
        let beside = (to_center - ray.d * along).length_squared() > self.radius * self.radius;
        if beside || -along > self.radius { 0.0 } else { self.disk_pdf() }
    }
}
