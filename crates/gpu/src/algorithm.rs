//! The algorithms that kernels have.

use description::schema::Settings;
use description::{
    AmbientOcclusionDesc, BdptDesc, IntegratorDesc, LightSamplerDesc, LightTracingDesc, PathDesc,
    ReflectionsDesc, WhittedDesc,
};
use spectrum::RgbColorSpace;

/// The most scattering events of algorithms whose threads keep what they have found at each.
const MAX_DEPTH: u32 = 16;

/// An algorithm with its settings.
#[derive(Clone, Debug)]
pub enum Algorithm {
    /// Camera rays, without shadow rays.
    RayCasting,
    /// Whitted's ray tracing, of which all reflections are traced.
    Whitted(WhittedDesc),
    /// Visibility over the hemisphere; unoccluded points are the white of the colour space.
    AmbientOcclusion(AmbientOcclusionDesc, &'static RgbColorSpace),
    /// Path tracing.
    Path(PathDesc),
    /// The same through media.
    VolPath(PathDesc),
    /// Light paths, connected to the camera.
    LightTracing(LightTracingDesc),
    /// Bidirectional path tracing.
    Bdpt(BdptDesc),
}

impl Algorithm {
    /// The algorithm of a description, for a film in a colour space. The error says what kernels do
    /// not have.
    pub fn new(desc: &IntegratorDesc, space: &'static RgbColorSpace) -> Result<Self, String> {
        let name = desc.name();
        let bounded = |max_depth: u32| {
            let refusal = format!("integrator `{name}` with a `maxdepth` above {MAX_DEPTH}");
            if max_depth > MAX_DEPTH { Err(refusal) } else { Ok(()) }
        };
        match *desc {
            IntegratorDesc::RayCasting => Ok(Self::RayCasting),
            IntegratorDesc::Whitted(settings) if settings.reflections != ReflectionsDesc::Traced => {
                Err(format!("integrator `{name}` with reflections that are not traced"))
            }
            IntegratorDesc::Whitted(settings) => {
                bounded(settings.max_depth).map(|()| Self::Whitted(settings))
            }
            IntegratorDesc::AmbientOcclusion(settings) => Ok(Self::AmbientOcclusion(settings, space)),
            IntegratorDesc::Path(settings) => Ok(Self::Path(settings)),
            IntegratorDesc::VolPath(settings) => Ok(Self::VolPath(settings)),
            IntegratorDesc::LightTracing(settings) => Ok(Self::LightTracing(settings)),
            IntegratorDesc::Bdpt(settings) if settings.visualize_strategies || settings.visualize_weights => {
                Err(format!("pictures of the strategies of integrator `{name}`"))
            }
            IntegratorDesc::Bdpt(settings) => bounded(settings.max_depth).map(|()| Self::Bdpt(settings)),
            _ => Err(format!("integrator `{name}`")),
        }
    }

    /// How it chooses a light for a point.
    pub fn light_sampler(&self) -> LightSamplerDesc {
        match self {
            Self::RayCasting | Self::Whitted(_) | Self::AmbientOcclusion(..) | Self::LightTracing(_) => {
                LightSamplerDesc::Uniform
            }
            Self::Path(desc) | Self::VolPath(desc) => desc.light_sampler,
            Self::Bdpt(_) => LightSamplerDesc::Bvh,
        }
    }

    /// The most splats of a light path; `None` if there are no light paths.
    pub fn splats(&self) -> Option<u32> {
        match self {
            Self::RayCasting
            | Self::Whitted(_)
            | Self::AmbientOcclusion(..)
            | Self::Path(_)
            | Self::VolPath(_) => None,
            Self::LightTracing(desc) => Some(desc.max_depth),
            Self::Bdpt(desc) => Some(desc.max_depth),
        }
    }
}
