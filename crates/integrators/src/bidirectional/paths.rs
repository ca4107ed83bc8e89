//! What it takes to make paths from both ends.

use scene::light_sampler::{LightSampler, LightSamplerKind, PowerLightSampler};
use scene::{Scene, View};
use spectrum::SampledSpectrum;

use super::partial::Balance;

/// What chooses lights.
#[derive(Clone, Debug)]
pub(crate) struct Lights {
    /// For a point.
    pub seen_from: LightSampler,
    /// Where light subpaths start.
    pub emitting: PowerLightSampler,
}

impl Lights {
    /// Those of no scene.
    pub fn none() -> Self {
        Self { seen_from: LightSampler::default(), emitting: PowerLightSampler::default() }
    }

    pub fn of(scene: &Scene) -> Self {
        Self {
            seen_from: scene.light_sampler(LightSamplerKind::Bvh),
            emitting: PowerLightSampler::new(scene.lights()),
        }
    }
}

/// Makes paths.
#[derive(Clone, Copy)]
pub(crate) struct Bidirectional<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub lights: &'a Lights,
    /// How strategies share paths.
    pub balance: Balance,
    /// Most scattering events of a path.
    pub max_depth: u32,
    /// Roughen surfaces after the first rough one of each subpath.
    pub regularize: bool,
}

/// Light that is known at the first wavelength alone, as light at all that have the same mean.
pub(crate) fn hero_only(l: SampledSpectrum) -> SampledSpectrum {
    let mut hero = SampledSpectrum::ZERO;
    hero[0] = l[0] * spectrum::N as f32;
    hero
}
