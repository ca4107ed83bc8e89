//! Names of algorithms, samplers and filters, as the command line and pictures' headers have them.

use description::{
    AcceleratorDesc, BuildQualityDesc, BvhSplit, FilterDesc, FormFactorsDesc, IntegratorDesc,
    LightSamplerDesc, MltDesc, MltTechnique, PhotonKernel, PhotonMappingDesc, PhotonMappingShow,
    RadiosityDesc, Randomization, SamplerKind, SppmDesc, VcmDesc,
};

use crate::settings::{light_sampler, max_depth, regularize};

/// The names of the algorithms that can be chosen.
pub const INTEGRATORS: [&str; 14] = [
    "ray-casting",
    "whitted",
    "ambient-occlusion",
    "random-walk",
    "simple-path",
    "path",
    "vol-path",
    "light-tracing",
    "bdpt",
    "mlt",
    "photon-mapping",
    "sppm",
    "vcm",
    "radiosity",
];

/// Acceleration structures that can be chosen.
pub(crate) const ACCELERATORS: [(&str, AcceleratorDesc); 2] = [
    ("bvh", AcceleratorDesc::Bvh { max_node_prims: 4, split: BvhSplit::Sah, quality: None }),
    ("none", AcceleratorDesc::None),
];

pub(crate) const LIGHT_SAMPLERS: [(&str, LightSamplerDesc); 4] = [
    ("uniform", LightSamplerDesc::Uniform),
    ("power", LightSamplerDesc::Power),
    ("bvh", LightSamplerDesc::Bvh),
    ("exhaustive", LightSamplerDesc::Exhaustive),
];

pub(crate) const FORM_FACTORS: [(&str, FormFactorsDesc); 2] =
    [("analytic", FormFactorsDesc::Analytic), ("hemicube", FormFactorsDesc::Hemicube)];

pub(crate) const MLT_TECHNIQUES: [(&str, MltTechnique); 2] =
    [("path", MltTechnique::Path), ("bdpt", MltTechnique::Bdpt)];

pub(crate) const PHOTON_KERNELS: [(&str, PhotonKernel); 2] =
    [("cone", PhotonKernel::Cone), ("epanechnikov", PhotonKernel::Epanechnikov)];

pub(crate) const PHOTON_MAPPING_SHOWS: [(&str, PhotonMappingShow); 2] =
    [("radiance", PhotonMappingShow::Radiance), ("photons", PhotonMappingShow::Photons)];

pub(crate) const SAMPLERS: [(&str, SamplerKind); 6] = [
    ("independent", SamplerKind::Independent),
    ("stratified", SamplerKind::Stratified { strata: [4, 4], jitter: true }),
    ("halton", SamplerKind::Halton { randomization: Randomization::PermuteDigits }),
    ("paddedsobol", SamplerKind::PaddedSobol { randomization: Randomization::FastOwen }),
    ("sobol", SamplerKind::Sobol { randomization: Randomization::FastOwen }),
    ("zsobol", SamplerKind::ZSobol { randomization: Randomization::FastOwen }),
];

pub(crate) const FILTERS: [(&str, FilterDesc); 5] = [
    ("box", FilterDesc::Box { radius: [0.5, 0.5] }),
    ("triangle", FilterDesc::Triangle { radius: [2.0, 2.0] }),
    ("gaussian", FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 0.5 }),
    ("mitchell", FilterDesc::Mitchell { radius: [2.0, 2.0], b: 1.0 / 3.0, c: 1.0 / 3.0 }),
    ("sinc", FilterDesc::LanczosSinc { radius: [4.0, 4.0], tau: 3.0 }),
];

pub(crate) const QUALITIES: [(&str, BuildQualityDesc); 3] = [
    ("fast", BuildQualityDesc::Fast),
    ("balanced", BuildQualityDesc::Balanced),
    ("high", BuildQualityDesc::High),
];

/// The algorithm called `name`, with those settings of `current` that it has too. The format's spelling without hyphens is
/// understood as well.
pub(crate) fn integrator_called(name: &str, current: &mut IntegratorDesc) -> Option<IntegratorDesc> {
    let name = INTEGRATORS.into_iter().find(|known| name == *known || name == known.replace('-', ""))?;
    let max_depth_before = max_depth(current).map_or(5, |depth| *depth);
    let regularize_before = regularize(current).is_some_and(|regularize| *regularize);
    let light_sampler_before = light_sampler(current).map_or(LightSamplerDesc::Bvh, |sampler| *sampler);
    let (max_depth, regularize, light_sampler) = (max_depth_before, regularize_before, light_sampler_before);
    Some(match name {
        "ray-casting" => IntegratorDesc::RayCasting,
        "whitted" => IntegratorDesc::Whitted { max_depth },
        "ambient-occlusion" => {
            IntegratorDesc::AmbientOcclusion { cos_sample: true, max_distance: f32::INFINITY }
        }
        "random-walk" => IntegratorDesc::RandomWalk { max_depth },
        "simple-path" => IntegratorDesc::SimplePath { max_depth, sample_lights: true, sample_bsdf: true },
        "path" => IntegratorDesc::Path { max_depth, regularize, light_sampler },
        "light-tracing" => IntegratorDesc::LightTracing { max_depth },
        "bdpt" => IntegratorDesc::Bdpt {
            max_depth,
            regularize,
            visualize_strategies: false,
            visualize_weights: false,
        },
        "mlt" => IntegratorDesc::Mlt(MltDesc { max_depth, regularize, ..MltDesc::default() }),
        "photon-mapping" => {
            IntegratorDesc::PhotonMapping(PhotonMappingDesc { max_depth, ..PhotonMappingDesc::default() })
        }
        "sppm" => IntegratorDesc::Sppm(SppmDesc { max_depth, ..SppmDesc::default() }),
        "radiosity" => IntegratorDesc::Radiosity(RadiosityDesc { max_depth, ..RadiosityDesc::default() }),
        "vcm" => IntegratorDesc::Vcm(VcmDesc { max_depth, ..VcmDesc::default() }),
        _ => IntegratorDesc::VolPath { max_depth, regularize, light_sampler },
    })
}

/// The name of an algorithm.
pub fn integrator_name(desc: &IntegratorDesc) -> &'static str {
    match desc {
        IntegratorDesc::RayCasting => "ray-casting",
        IntegratorDesc::Whitted { .. } => "whitted",
        IntegratorDesc::AmbientOcclusion { .. } => "ambient-occlusion",
        IntegratorDesc::RandomWalk { .. } => "random-walk",
        IntegratorDesc::SimplePath { .. } => "simple-path",
        IntegratorDesc::Path { .. } => "path",
        IntegratorDesc::SimpleVolPath { .. } => "simple-vol-path",
        IntegratorDesc::VolPath { .. } => "vol-path",
        IntegratorDesc::LightTracing { .. } => "light-tracing",
        IntegratorDesc::Bdpt { .. } => "bdpt",
        IntegratorDesc::Mlt(_) => "mlt",
        IntegratorDesc::PhotonMapping(_) => "photon-mapping",
        IntegratorDesc::Sppm(_) => "sppm",
        IntegratorDesc::Vcm(_) => "vcm",
        IntegratorDesc::Radiosity(_) => "radiosity",
        IntegratorDesc::Function { .. } => "function",
    }
}

/// The name of a sampler.
pub fn sampler_name(kind: &SamplerKind) -> &'static str {
    match kind {
        SamplerKind::Independent => "independent",
        SamplerKind::Stratified { .. } => "stratified",
        SamplerKind::Halton { .. } => "halton",
        SamplerKind::PaddedSobol { .. } => "paddedsobol",
        SamplerKind::Sobol { .. } => "sobol",
        SamplerKind::ZSobol { .. } => "zsobol",
        SamplerKind::Pmj02Bn => "pmj02bn",
    }
}
