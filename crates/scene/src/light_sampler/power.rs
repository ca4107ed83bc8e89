//! Lights in proportion to their power, independent of the shading point. This sampler therefore
//! also chooses the lights at which light paths start.

use crate::light::{LightId, Lights};
use lanes::{Int, MAX_LANES, Mask, Real};
use sampling::AliasTable;
use spectrum::SampledWavelengths;

/// Lights by power. The default has no lights.
#[derive(Clone, Debug, Default)]
pub struct PowerLightSampler {
    table: Option<AliasTable>,
}

impl PowerLightSampler {
    /// Builds the distribution; uniform if no light has power.
    pub fn new(lights: Lights) -> Self {
        let lambda = SampledWavelengths::sample_visible(0.5);
        let powers = lights.powers(&lambda);
        let mut powers: Vec<f32> =
            powers.map(|power| power.safe_div(lambda.pdf()).average().max(0.0)).collect();
        if powers.iter().all(|&p| p == 0.0) {
            powers.fill(1.0);
        }
        Self { table: AliasTable::new(&powers) }
    }

    /// The distribution; `None` if there are no lights.
    pub fn table(&self) -> Option<&AliasTable> {
        self.table.as_ref()
    }

    /// A light, with the probability of its choice (> 0); `None` if there are no lights.
    #[inline]
    pub fn sample(&self, u: f32) -> Option<(LightId, f32)> {
        let choice = self.table.as_ref()?.sample(u);
        (choice.pmf > 0.0).then_some((LightId(choice.index as u32), choice.pmf))
    }

    /// The probability with which `light` is chosen.
    #[inline]
    pub fn pmf(&self, light: LightId) -> f32 {
        self.table.as_ref().map_or(0.0, |table| table.pmf(light.0 as usize))
    }

    /// See [`LightSampler::sample_lanes`](super::LightSampler::sample_lanes). The lanes go one by
    /// one, as the table is sampled in double precision.
    #[inline(always)]
    pub(super) fn sample_lanes<R: Real>(&self, u: R, active: R::Mask) -> (R::Int, R, R::Mask) {
        let (u, active) = (u.to_array(), active.bits());
        let (mut lights, mut pmf, mut valid) = ([0; MAX_LANES], [0.0; MAX_LANES], 0);
        for (lane, &u) in u[..R::LANES].iter().enumerate() {
            if active >> lane & 1 == 1
                && let Some((light, p)) = self.sample(u)
            {
                (lights[lane], pmf[lane]) = (light.0, p);
                valid |= 1 << lane;
            }
        }
        (R::Int::load(&lights), R::load(&pmf), R::Mask::from_bits(valid))
    }

    /// See [`LightSampler::pmf_lanes`](super::LightSampler::pmf_lanes).
    #[inline(always)]
    pub(super) fn pmf_lanes<R: Real>(&self, lights: R::Int, active: R::Mask) -> R {
        let (lights, active) = (lights.to_array(), active.bits());
        let mut pmf = [0.0; MAX_LANES];
        for (lane, &light) in lights[..R::LANES].iter().enumerate() {
            if active >> lane & 1 == 1 {
                pmf[lane] = self.pmf(LightId(light));
            }
        }
        R::load(&pmf)
    }
}
