//! The arrangement of samples: what the samples of a pixel depend on beside their indices.

use description::{IntegratorDesc, SamplerKind, SceneDesc};

/// The settings of a render that decide how its samples are arranged.
pub(crate) struct Arrangement {
    sampler: SamplerKind,
    integrator: IntegratorDesc,
    is_adaptive: bool,
    /// Whether textures are filtered, by filters that narrow as samples increase.
    needs_footprints: bool,
}

impl Arrangement {
    /// Of the render of a description.
    pub fn new(desc: &SceneDesc, needs_footprints: bool) -> Self {
        Self {
            sampler: desc.sampler.kind.clone(),
            integrator: desc.integrator.value.clone(),
            is_adaptive: desc.options.adaptive.is_some(),
            needs_footprints,
        }
    }

    /// Whether samples differ from those of a render that was planned for this number of them.
    pub fn differs_for(&self, samples: u32) -> bool {
        let mut other = self.sampler.clone();
        other.set_samples_per_pixel(samples);
        let mut integrator = self.integrator.clone();
        integrator.set_samples_per_pixel(samples);
        let planned = self.integrator.samples_per_pixel(&self.sampler);
        self.points(&self.sampler) != self.points(&other)
            || self.needs_footprints && planned != integrator.samples_per_pixel(&other)
    }

    /// The numbers for which the points of camera paths and of light paths are arranged.
    fn points(&self, sampler: &SamplerKind) -> [Option<u32>; 4] {
        use SamplerKind::{Halton, Independent, PaddedSobol, Pmj02Bn, Sobol, Stratified, ZSobol};
        let samples = sampler.samples_per_pixel();
        let [columns, rows] = match *sampler {
            Independent { .. } | Halton { .. } | Sobol { .. } => [None; 2],
            Stratified { strata, .. } => strata.map(Some),
            PaddedSobol { .. } => [Some(samples), None],
            ZSobol { .. } | Pmj02Bn { .. } => [Some(sampler.arranged_samples()), None],
        };
        let of_lights = self.integrator.facts().samples_light_paths.then(|| sampler.arranged_samples());
        let most = (self.is_adaptive && self.integrator.facts().estimates_pixels).then_some(samples);
        [columns, rows, of_lights, most]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Overrides;

    fn differs(settings: &[(&str, &str)], integrator: &str, [planned, samples]: [u32; 2]) -> bool {
        let mut desc = SceneDesc::default();
        let overrides = Overrides {
            integrator: Some(integrator.into()),
            settings: settings.iter().map(|&(name, value)| (name.into(), value.into())).collect(),
            samples_per_pixel: Some(planned),
            ..Overrides::default()
        };
        overrides.apply(&mut desc).unwrap();
        Arrangement::new(&desc, false).differs_for(samples)
    }

    #[test]
    fn renders_of_other_numbers_of_samples_may_have_the_same_samples() {
        for (sampler, numbers, expected) in [
            ("independent", [16, 100], false),
            ("halton", [16, 100], false),
            ("sobol", [16, 100], false),
            ("zsobol", [100, 128], false),
            ("zsobol", [100, 65], false),
            ("zsobol", [100, 64], true),
            ("pmj02bn", [5, 8], false),
            ("pmj02bn", [5, 9], true),
            ("paddedsobol", [100, 128], true),
            ("stratified", [16, 12], true),
        ] {
            let settings = [("sampler", sampler)];
            assert_eq!(differs(&settings, "path", numbers), expected, "{sampler} {numbers:?}");
            assert!(!differs(&settings, "path", [numbers[0]; 2]), "{sampler}: the same number");
        }
        let independent = [("sampler", "independent")];
        for integrator in ["light-tracing", "bdpt", "vcm"] {
            assert!(differs(&independent, integrator, [16, 100]), "{integrator}");
        }
        let adaptive = [independent[0], ("adaptive", "0.1")];
        assert!(differs(&adaptive, "path", [16, 100]) && !differs(&adaptive, "sppm", [16, 100]));
    }
}
