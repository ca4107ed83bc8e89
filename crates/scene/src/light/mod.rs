//! Lights: what emits into the scene, and how a point finds it.
//!
//! A light answers two questions. *How much comes from there?* — [`Light::radiance`] for emitting surfaces, [`Light::le`] for
//! rays that leave the scene. *Where should I look?* — [`Light::sample_li`] draws a direction from a point towards the
//! light, [`Light::pdf_li`] is its density per solid angle. Lights at a point or in one direction (delta lights) can only
//! be sampled, never hit: their pdf is 0. Radiometric scale follows the pbrt-v4 format: a light's spectrum is first
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
use math::{Bounds3, Normal3, Point2, Point3, Point3Error, Ray, Vector3};
use spectrum::{SampledSpectrum, SampledWavelengths};

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

    /// Emitted power.
    #[doc(alias = "Phi")]
    pub fn phi(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        each_light!(self, light => light.phi(lambda))
    }

    /// A direction from `context` to the light, chosen by `u`, or `None` where nothing comes from.
    ///
    /// With `allow_incomplete` the light may leave out directions that BSDF sampling covers well, as long as the caller
    /// combines both with the pdf of the same flag.
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

    /// Radiance along a ray that leaves the scene.
    #[doc(alias = "Le")]
    pub fn le(&self, ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        match self {
            Self::UniformInfinite(light) => light.le(lambda),
            Self::ImageInfinite(light) => light.le(ray.d, lambda),
            Self::Point(_) | Self::Spot(_) | Self::Distant(_) | Self::Area(_) => SampledSpectrum::ZERO,
        }
    }

    /// Radiance that an emitting surface sends along `w` from a point with normal `n` and coordinates `uv`.
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

    /// Where it is and whereto it emits, for choosing among many; `None` for what is infinitely far away.
    pub fn bounds(&self) -> Option<LightBounds> {
        match self {
            Self::Point(light) => light.bounds(),
            Self::Spot(light) => light.bounds(),
            Self::Area(light) => light.bounds(),
            Self::Distant(_) | Self::UniformInfinite(_) | Self::ImageInfinite(_) => None,
        }
    }
}

/// The sphere around everything that can be hit: how big the scene looks to lights that are infinitely far away.
#[derive(Clone, Copy, Debug)]
pub struct SceneSphere {
    /// Centre in render space.
    pub center: Point3,
    /// Radius.
    pub radius: f32,
}

impl SceneSphere {
    /// The sphere around a box. Where nothing has an end, lights still need an extent to have a power: that is 1.
    pub fn around(bounds: &Bounds3) -> Self {
        let (center, radius) = bounds.bounding_sphere();
        Self { center, radius: if bounds.is_empty() { 1.0 } else { radius } }
    }
}
