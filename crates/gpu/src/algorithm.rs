//! The algorithms that kernels have.

use description::schema::Settings;
use description::{
    AmbientOcclusionDesc, BdptDesc, IntegratorDesc, LightSamplerDesc, LightTracingDesc, MltDesc,
    MltTechnique, PathDesc, RandomWalkDesc, ReflectionsDesc, SimplePathDesc, SimpleVolPathDesc, SppmDesc,
    WhittedDesc,
};
use sampling::Sampler;
use spectrum::RgbColorSpace;

/// The most scattering events of algorithms whose threads keep something of each.
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
    /// The same without light sampling.
    SimpleVolPath(SimpleVolPathDesc),
    /// Path tracing by light sampling or by hits, without weights.
    SimplePath(SimplePathDesc),
    /// Walks in uniform directions.
    RandomWalk(RandomWalkDesc),
    /// Light paths, connected to the camera.
    LightTracing(LightTracingDesc),
    /// Bidirectional path tracing.
    Bdpt(BdptDesc),
    /// Metropolis light transport by the technique `bdpt`, and the seed of its chains.
    Mlt(MltDesc, u32),
    /// Stochastic progressive photon mapping, and the seed of its photons.
    Sppm(SppmDesc, u32),
}

impl Algorithm {
    /// The algorithm of a description, for a film in a colour space; `seed` is that of what it
    /// draws beside the numbers of samplers. The error says what kernels do not have.
    pub fn new(desc: &IntegratorDesc, space: &'static RgbColorSpace, seed: u32) -> Result<Self, String> {
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
            IntegratorDesc::SimpleVolPath(settings) => Ok(Self::SimpleVolPath(settings)),
            IntegratorDesc::SimplePath(settings) => Ok(Self::SimplePath(settings)),
            IntegratorDesc::RandomWalk(settings) => Ok(Self::RandomWalk(settings)),
            IntegratorDesc::LightTracing(settings) => Ok(Self::LightTracing(settings)),
            IntegratorDesc::Bdpt(settings) if settings.visualize_strategies || settings.visualize_weights => {
                Err(format!("pictures of the strategies of integrator `{name}`"))
            }
            IntegratorDesc::Bdpt(settings) => bounded(settings.max_depth).map(|()| Self::Bdpt(settings)),
            IntegratorDesc::Mlt(settings) if settings.technique != MltTechnique::Bdpt => {
                Err(format!("integrator `{name}` by any technique but `bdpt`"))
            }
            IntegratorDesc::Mlt(settings) => bounded(settings.max_depth).map(|()| Self::Mlt(settings, seed)),
            IntegratorDesc::Sppm(settings) => Ok(Self::Sppm(settings, seed)),
            IntegratorDesc::PhotonMapping(_)
            | IntegratorDesc::Vcm(_)
            | IntegratorDesc::Radiosity(_)
            | IntegratorDesc::Function(_) => Err(format!("integrator `{name}`")),
        }
    }

    /// How it chooses a light for a point.
    pub fn light_sampler(&self) -> LightSamplerDesc {
        match self {
            Self::RayCasting
            | Self::Whitted(_)
            | Self::AmbientOcclusion(..)
            | Self::SimpleVolPath(_)
            | Self::SimplePath(_)
            | Self::RandomWalk(_)
            | Self::LightTracing(_) => LightSamplerDesc::Uniform,
            Self::Path(desc) | Self::VolPath(desc) => desc.light_sampler,
            Self::Bdpt(_) | Self::Mlt(..) | Self::Sppm(..) => LightSamplerDesc::Bvh,
        }
    }

    /// The number of passes that are planned, given the sampler of camera rays.
    pub fn passes(&self, sampler: &Sampler) -> u32 {
        if let Self::Mlt(desc, _) = self { desc.mutations_per_pixel } else { sampler.samples_per_pixel() }
    }

    /// Whether paths begin at lights, so that there are pictures only as a whole.
    pub fn begins_at_lights(&self) -> bool {
        self.traits().light_paths
    }

    /// Whether paths add light to any pixel of the film.
    pub fn splats(&self) -> bool {
        self.traits().splats
    }

    /// The facts of the algorithm.
    pub(crate) fn traits(&self) -> Traits {
        let [media, bodies, light_paths, splats] = match self {
            Self::RayCasting | Self::Whitted(_) | Self::AmbientOcclusion(..) => [false; 4],
            Self::SimplePath(_) | Self::RandomWalk(_) => [true, false, false, false],
            Self::Path(_) | Self::VolPath(_) | Self::SimpleVolPath(_) => [true, true, false, false],
            Self::LightTracing(_) | Self::Bdpt(_) | Self::Mlt(..) => [false, false, true, true],
            Self::Sppm(..) => [false, false, true, false],
        };
        Traits { media, bodies, light_paths, splats }
    }
}

/// Facts of an algorithm.
pub(crate) struct Traits {
    /// Paths pass interfaces, and are scattered by media or ignore them.
    pub media: bool,
    /// Paths go on under the surface of bodies.
    pub bodies: bool,
    /// Paths begin at lights.
    pub light_paths: bool,
    /// Paths add light to any pixel of the film.
    pub splats: bool,
}
