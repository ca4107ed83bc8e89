//! The context of paths that are sampled from both ends.

use std::sync::Arc;

use description::LightSamplerDesc;
use scene::light_sampler::{LightSampler, PowerLightSampler};
use scene::{Scene, View};
use spectrum::SampledSpectrum;

use super::medium_emission::MediumEmission;
use super::partial::Balance;
use crate::{Cancelled, Control};

/// Light samplers.
#[derive(Clone, Debug)]
pub(crate) struct Lights {
    /// For next-event estimation at a vertex.
    pub seen_from: Arc<LightSampler>,
    /// For the first vertices of light subpaths.
    pub emitting: PowerLightSampler,
    /// Media where light subpaths start, too.
    pub media: Option<MediumEmission>,
}

impl Lights {
    /// Samplers of no lights.
    pub fn none() -> Self {
        Self { seen_from: Arc::default(), emitting: PowerLightSampler::default(), media: None }
    }

    /// Samplers of the lights of a scene.
    pub fn of(scene: &Scene, control: &Control) -> Result<Self, Cancelled> {
        let seen_from = scene.light_sampler(LightSamplerDesc::Bvh, &control.cancel).ok_or(Cancelled)?;
        Ok(Self { seen_from, emitting: PowerLightSampler::new(scene.lights()), media: None })
    }

    /// The same, with media that emit: for algorithms that do not find all of their light along
    /// camera paths.
    pub fn and_media(scene: &Scene, view: &View, control: &Control) -> Result<Self, Cancelled> {
        Ok(Self { media: MediumEmission::new(scene, view, control)?, ..Self::of(scene, control)? })
    }
}

/// Samples subpaths and builds paths from them.
#[derive(Clone, Copy)]
pub(crate) struct Bidirectional<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub lights: &'a Lights,
    /// The weighting of strategies.
    pub balance: Balance,
    /// Maximum number of scattering events of a path.
    pub max_depth: u32,
    /// Whether light subpaths go under the surfaces of bodies, too: for algorithms the camera
    /// subpaths of which end at the first vertices. Their light subpaths have no weights.
    pub light_goes_under: bool,
    /// Whether to roughen surfaces after the first rough one of each subpath.
    pub regularize: bool,
}

/// Radiance; if it is known at the first wavelength only, as radiance at all wavelengths with the
/// same expected value.
pub(crate) fn hero_only(l: SampledSpectrum, is_hero_only: bool) -> SampledSpectrum {
    if !is_hero_only {
        return l;
    }
    let mut hero = SampledSpectrum::ZERO;
    hero[0] = l[0] * spectrum::N as f32;
    hero
}
