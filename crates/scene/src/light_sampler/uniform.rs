//! All lights with equal probability.

use crate::light::{LightId, Lights};
use lanes::{Int, Mask, Real};

/// Every light with the same probability.
#[derive(Clone, Debug, Default)]
pub struct UniformLightSampler {
    count: u32,
}

impl UniformLightSampler {
    /// A sampler of these lights.
    pub fn new(lights: Lights) -> Self {
        Self { count: lights.len() as u32 }
    }

    /// A light, with the probability of its choice (> 0); `None` if there are no lights.
    #[inline]
    pub fn sample(&self, u: f32) -> Option<(LightId, f32)> {
        (self.count > 0).then(|| (LightId(((u * self.count as f32) as u32).min(self.count - 1)), self.pmf()))
    }

    /// The probability with which each light is chosen.
    #[inline]
    pub fn pmf(&self) -> f32 {
        if self.count == 0 { 0.0 } else { 1.0 / self.count as f32 }
    }

    /// See [`LightSampler::sample_lanes`](super::LightSampler::sample_lanes).
    #[inline(always)]
    pub(super) fn sample_lanes<R: Real>(&self, u: R, active: R::Mask) -> (R::Int, R, R::Mask) {
        if self.count == 0 {
            return (R::Int::splat(0), R::zero(), R::Mask::splat(false));
        }
        let light = (u * R::splat(self.count as f32)).to_int();
        let last = R::Int::splat(self.count - 1);
        (R::Int::select(light.lt(last), light, last), R::splat(self.pmf()), active)
    }
}
