//! Algorithms: their settings, which are in the head of the scene.

use description::{
    AmbientOcclusionDesc, BdptDesc, LightTracingDesc, MltDesc, PathDesc, RandomWalkDesc, SimplePathDesc,
    SimpleVolPathDesc, SppmDesc, WhittedDesc,
};

use super::{Flattener, Head};
use crate::algorithm::Algorithm;
use crate::tags::{SettingBit, bit};

impl Flattener<'_> {
    /// Sets the settings of an algorithm. Others are refused, or are not of kernels.
    pub fn algorithm(&mut self, algorithm: &Algorithm, head: &mut Head) {
        (head.max_depth, head.settings) = match *algorithm {
            Algorithm::RayCasting => (0, 0),
            // The text of the kernel has `ambient`, and other reflections are refused.
            Algorithm::Whitted(WhittedDesc {
                max_depth,
                ambient: _,
                reflections: _,
                reflection_distance: _,
                reflection_resolution: _,
            })
            | Algorithm::SimpleVolPath(SimpleVolPathDesc { max_depth })
            | Algorithm::RandomWalk(RandomWalkDesc { max_depth })
            | Algorithm::LightTracing(LightTracingDesc { max_depth })
            // The pass of photons has the rest.
            | Algorithm::Sppm(SppmDesc { max_depth, photons_per_iteration: _, radius: _, seed: _ }, _) => {
                (max_depth, 0)
            }
            Algorithm::AmbientOcclusion(AmbientOcclusionDesc { max_distance, cos_sample }, space) => {
                let white = space.illuminant();
                head.white = self.spectrum(&white);
                head.white_scale = 1.0 / white.to_photometric();
                (head.max_distance, head.cos_sample) = (max_distance, cos_sample.into());
                (0, 0)
            }
            // `lights` is of the light sampler.
            Algorithm::Path(PathDesc { max_depth, regularize, light_sampler: _ })
            | Algorithm::VolPath(PathDesc { max_depth, regularize, light_sampler: _ }) => {
                (max_depth, SettingBit::SamplesLights as u32 | bit(regularize, SettingBit::Regularizes))
            }
            Algorithm::SimplePath(SimplePathDesc { max_depth, sample_lights, sample_bsdf }) => {
                let [lights, bsdfs] = [
                    bit(sample_lights, SettingBit::SamplesLights),
                    bit(sample_bsdf, SettingBit::SamplesBsdfs),
                ];
                (max_depth, SettingBit::MirrorsDirections as u32 | lights | bsdfs)
            }
            // Pictures of strategies are refused.
            Algorithm::Bdpt(BdptDesc {
                max_depth,
                regularize,
                visualize_strategies: _,
                visualize_weights: _,
            })
            // Other techniques are refused, and what runs the chains has their numbers.
            | Algorithm::Mlt(
                MltDesc {
                    max_depth,
                    regularize,
                    technique: _,
                    bootstrap_samples: _,
                    chains: _,
                    mutations_per_pixel: _,
                    large_step_probability: _,
                    sigma: _,
                },
                _,
            ) => (max_depth, bit(regularize, SettingBit::Regularizes)),
        };
    }
}
