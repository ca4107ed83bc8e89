//! Names of algorithms, samplers and filters, as the command line and pictures' headers have them.

use description::{
    AcceleratorDesc, BuildQualityDesc, BvhSplit, FilterDesc, IntegratorDesc, LightSamplerDesc, MltDesc,
    PhotonMappingDesc, RadiosityDesc, Randomization, SamplerKind, SppmDesc, VcmDesc,
};

use crate::settings::{keep, settings_of};

/// Of one list: the names of the algorithms that can be chosen with what they are when nothing is
/// set, and after them the names of those that can only be described. An algorithm that is missing
/// from it does not compile.
macro_rules! integrators {
    ($($name:literal: $variant:ident = $default:expr,)* ; $($undrawn:literal: $described:ident,)*) => {
        /// The names of the algorithms that can be chosen.
        pub const INTEGRATORS: [&str; [$($name),*].len()] = [$($name),*];

        /// The algorithm of that name in [`INTEGRATORS`], with default settings.
        fn default_integrator(name: &str) -> Option<IntegratorDesc> {
            match name {
                $($name => Some($default),)*
                _ => None,
            }
        }

        /// The name of an algorithm.
        pub fn integrator_name(desc: &IntegratorDesc) -> &'static str {
            match desc {
                $(IntegratorDesc::$variant { .. } => $name,)*
                $(IntegratorDesc::$described { .. } => $undrawn,)*
            }
        }
    };
}

integrators! {
    "ray-casting": RayCasting = IntegratorDesc::RayCasting,
    "whitted": Whitted = IntegratorDesc::Whitted { max_depth: 5 },
    "ambient-occlusion": AmbientOcclusion =
        IntegratorDesc::AmbientOcclusion { cos_sample: true, max_distance: f32::INFINITY },
    "random-walk": RandomWalk = IntegratorDesc::RandomWalk { max_depth: 5 },
    "simple-path": SimplePath =
        IntegratorDesc::SimplePath { max_depth: 5, sample_lights: true, sample_bsdf: true },
    "path": Path =
        IntegratorDesc::Path { max_depth: 5, regularize: false, light_sampler: LightSamplerDesc::Bvh },
    "vol-path": VolPath =
        IntegratorDesc::VolPath { max_depth: 5, regularize: false, light_sampler: LightSamplerDesc::Bvh },
    "light-tracing": LightTracing = IntegratorDesc::LightTracing { max_depth: 5 },
    "bdpt": Bdpt = IntegratorDesc::Bdpt {
        max_depth: 5,
        regularize: false,
        visualize_strategies: false,
        visualize_weights: false,
    },
    "mlt": Mlt = IntegratorDesc::Mlt(MltDesc::default()),
    "photon-mapping": PhotonMapping = IntegratorDesc::PhotonMapping(PhotonMappingDesc::default()),
    "sppm": Sppm = IntegratorDesc::Sppm(SppmDesc::default()),
    "vcm": Vcm = IntegratorDesc::Vcm(VcmDesc::default()),
    "radiosity": Radiosity = IntegratorDesc::Radiosity(RadiosityDesc::default()),
    ;
    "simple-vol-path": SimpleVolPath,
    "function": Function,
}

/// Acceleration structures that can be chosen.
pub(crate) const ACCELERATORS: [(&str, AcceleratorDesc); 2] = [
    ("bvh", AcceleratorDesc::Bvh { max_node_prims: 4, split: BvhSplit::Sah, quality: None }),
    ("none", AcceleratorDesc::None),
];

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

/// The algorithm called `name`: `current` if it is that, else one that has the settings of
/// `current` that both have, as far as they are not left at their defaults. The format's spelling
/// without hyphens is understood as well.
pub(crate) fn integrator_called(name: &str, current: &IntegratorDesc) -> Option<IntegratorDesc> {
    let name = INTEGRATORS.into_iter().find(|known| name == *known || name == known.replace('-', ""))?;
    if name == integrator_name(current) {
        return Some(current.clone());
    }
    let mut called = default_integrator(name)?;
    let unchanged = default_integrator(integrator_name(current)).map(|desc| settings_of(&desc));
    for setting in settings_of(current) {
        if unchanged.as_ref().is_none_or(|unchanged| !unchanged.contains(&setting)) {
            keep(&mut called, &setting);
        }
    }
    Some(called)
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

/// The name of a pixel filter.
pub(crate) fn filter_name(desc: &FilterDesc) -> &'static str {
    match desc {
        FilterDesc::Box { .. } => "box",
        FilterDesc::Triangle { .. } => "triangle",
        FilterDesc::Gaussian { .. } => "gaussian",
        FilterDesc::Mitchell { .. } => "mitchell",
        FilterDesc::LanczosSinc { .. } => "sinc",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_to_algorithms_and_back() {
        for name in INTEGRATORS {
            assert_eq!(integrator_name(&default_integrator(name).unwrap()), name);
        }
        for (name, kind) in &SAMPLERS {
            assert_eq!(sampler_name(kind), *name);
        }
        for (name, filter) in &FILTERS {
            assert_eq!(filter_name(filter), *name);
        }
        let volpath = integrator_called("volpath", &IntegratorDesc::RayCasting).unwrap();
        assert_eq!(volpath, IntegratorDesc::default());
    }

    #[test]
    fn the_same_algorithm_keeps_all_that_was_set() {
        let sppm =
            SppmDesc { photons_per_iteration: Some(7), radius: Some(3.0), seed: Some(5), max_depth: 9 };
        let sppm = IntegratorDesc::Sppm(sppm);
        assert_eq!(integrator_called("sppm", &sppm), Some(sppm));
    }

    #[test]
    fn another_algorithm_keeps_what_both_have() {
        let mut photons =
            PhotonMappingDesc { max_depth: 9, radius: Some(3.0), ..PhotonMappingDesc::default() };
        let called = |photons: &PhotonMappingDesc, name| {
            integrator_called(name, &IntegratorDesc::PhotonMapping(photons.clone())).unwrap()
        };
        let vcm = VcmDesc { max_depth: 9, radius: Some(3.0), ..VcmDesc::default() };
        assert_eq!(called(&photons, "vcm"), IntegratorDesc::Vcm(vcm));
        let mut sppm = SppmDesc { max_depth: 9, radius: Some(3.0), ..SppmDesc::default() };
        assert_eq!(called(&photons, "sppm"), IntegratorDesc::Sppm(sppm.clone()), "no default goes over");
        photons.photons = 1000;
        photons.gather = 4;
        sppm.photons_per_iteration = Some(1000);
        assert_eq!(called(&photons, "sppm"), IntegratorDesc::Sppm(sppm));
        let radiosity = RadiosityDesc { max_depth: 9, gather: 4, ..RadiosityDesc::default() };
        assert_eq!(called(&photons, "radiosity"), IntegratorDesc::Radiosity(radiosity));
    }
}
