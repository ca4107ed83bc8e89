//! Choosing one light among many, in proportion to what it may contribute.
//!
//! [`LightSampler::sample`] returns a light with the probability of its choice;
//! [`LightSampler::pmf`] is that probability for a given light, which multiple importance sampling
//! needs when a BSDF sample hits that light.

mod bvh;
mod cluster;
mod exhaustive;
mod infinite;
mod power;
mod uniform;

pub use bvh::BvhLightSampler;
pub use exhaustive::ExhaustiveLightSampler;
pub use power::PowerLightSampler;
pub use uniform::UniformLightSampler;

use crate::light::{LightId, LightSampleContext, Lights};
use description::LightSamplerDesc;
use lanes::Real;
use std::sync::atomic::AtomicBool;

/// A light sampler.
#[derive(Clone, Debug)]
pub enum LightSampler {
    /// See [`UniformLightSampler`].
    Uniform(UniformLightSampler),
    /// See [`PowerLightSampler`].
    Power(PowerLightSampler),
    /// See [`BvhLightSampler`].
    Bvh(BvhLightSampler),
    /// See [`ExhaustiveLightSampler`].
    Exhaustive(ExhaustiveLightSampler),
}

impl Default for LightSampler {
    /// A sampler of no lights.
    fn default() -> Self {
        Self::Uniform(UniformLightSampler::default())
    }
}

impl LightSampler {
    /// A sampler of these lights, as described; `None` if `cancel` is set while it is built. More
    /// lights than a tree can hold are chosen by their power.
    pub fn new(desc: LightSamplerDesc, lights: Lights, cancel: &AtomicBool) -> Option<Self> {
        Some(match desc {
            LightSamplerDesc::Uniform => Self::Uniform(UniformLightSampler::new(lights)),
            LightSamplerDesc::Bvh if lights.len() <= BvhLightSampler::MAX_LIGHTS => {
                Self::Bvh(BvhLightSampler::new(lights, cancel)?)
            }
            LightSamplerDesc::Power | LightSamplerDesc::Bvh => Self::Power(PowerLightSampler::new(lights)),
            LightSamplerDesc::Exhaustive => Self::Exhaustive(ExhaustiveLightSampler::new(lights, cancel)?),
        })
    }

    /// A light for the point `context`, with the probability of its choice (> 0).
    #[inline]
    pub fn sample(&self, context: &LightSampleContext, u: f32) -> Option<(LightId, f32)> {
        match self {
            Self::Uniform(s) => s.sample(u),
            Self::Power(s) => s.sample(u),
            Self::Bvh(s) => s.sample(context, u),
            Self::Exhaustive(s) => s.sample(context, u),
        }
    }

    /// [`sample`](Self::sample) for each lane of `active`: the ids of the lights, the probabilities
    /// of their choice, and the lanes that have a light. All lanes have the same as alone.
    #[inline(always)]
    pub fn sample_lanes<R: Real>(
        &self,
        context: &LightSampleContext<R>,
        u: R,
        active: R::Mask,
    ) -> (R::Int, R, R::Mask) {
        match self {
            Self::Uniform(s) => s.sample_lanes(u, active),
            Self::Power(s) => s.sample_lanes(u, active),
            Self::Bvh(s) => s.sample_lanes(context, u, active),
            Self::Exhaustive(s) => s.sample_lanes(context, u, active),
        }
    }

    /// The probability with which `light` is chosen for the point `context`.
    #[inline]
    pub fn pmf(&self, context: &LightSampleContext, light: LightId) -> f32 {
        self.pmf_lanes::<f32>(context, light.0, true)
    }

    /// [`pmf`](Self::pmf) for each lane of `active`. All lanes have the same as alone.
    #[inline(always)]
    pub fn pmf_lanes<R: Real>(&self, context: &LightSampleContext<R>, lights: R::Int, active: R::Mask) -> R {
        match self {
            Self::Uniform(s) => R::splat(s.pmf()),
            Self::Power(s) => s.pmf_lanes(lights, active),
            Self::Bvh(s) => s.pmf_lanes(context, lights, active),
            Self::Exhaustive(s) => s.pmf_lanes(context, lights, active),
        }
    }
}
