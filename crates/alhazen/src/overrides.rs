//! What a caller changes of a scene before it is rendered: the command line's options, and one table of settings by name.

use std::fmt;
use std::str::FromStr;

use description::{
    FilterDesc, IntegratorDesc, LightSamplerDesc, MltDesc, Randomization, SamplerKind, SceneDesc, SppmDesc,
};

/// Changes to a scene. `None` leaves what the scene says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The name of the algorithm, as in [`INTEGRATORS`]. Settings that both algorithms have are kept.
    pub integrator: Option<String>,
    /// Settings by their names in [`SETTINGS`], with their values as text.
    pub settings: Vec<(String, String)>,
    /// Samples per pixel.
    pub samples_per_pixel: Option<u32>,
    /// Width and height of the whole image in pixels.
    pub resolution: Option<[i32; 2]>,
    /// The part to render as fractions `[x0, x1, y0, y1]` of the whole image, y down.
    pub crop: Option<[f32; 4]>,
    /// The one pixel to render, as column and row of the whole image.
    pub pixel: Option<[i32; 2]>,
    /// Seed of all random numbers.
    pub seed: Option<i32>,
}

/// A change that makes no sense.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverrideError(String);

impl fmt::Display for OverrideError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for OverrideError {}

/// The algorithms' names.
pub const INTEGRATORS: [&str; 12] = [
    "ray-casting",
    "whitted",
    "ambient-occlusion",
    "random-walk",
    "simple-path",
    "path",
    "simple-vol-path",
    "vol-path",
    "light-path",
    "bdpt",
    "mlt",
    "sppm",
];

/// A setting that can be changed by name.
pub struct Setting {
    /// Its name: the one that the pbrt-v4 format has for it.
    pub name: &'static str,
    /// What it means, with its unit and values.
    pub help: &'static str,
    apply: fn(&mut SceneDesc, &str) -> Result<(), String>,
}

/// Everything that [`Overrides::settings`] can change.
pub static SETTINGS: [Setting; 15] = [
    Setting {
        name: "maxdepth",
        help: "most bounces of a path after the camera's ray",
        apply: |desc, text| set(max_depth(&mut desc.integrator), text),
    },
    Setting {
        name: "regularize",
        help: "roughen surfaces after the first rough bounce: true or false",
        apply: |desc, text| set(regularize(&mut desc.integrator), text),
    },
    Setting {
        name: "lightsampler",
        help: "how a light is chosen: uniform, power, bvh or exhaustive",
        apply: |desc, text| {
            let chosen = choose(text, &LIGHT_SAMPLERS)?;
            *light_sampler(&mut desc.integrator).ok_or(NOT_HERE)? = chosen;
            Ok(())
        },
    },
    Setting {
        name: "samplelights",
        help: "simple-path: sample lights at each surface: true or false",
        apply: |desc, text| match &mut desc.integrator.value {
            IntegratorDesc::SimplePath { sample_lights, .. } => set(Some(sample_lights), text),
            _ => Err(NOT_HERE.into()),
        },
    },
    Setting {
        name: "samplebsdf",
        help: "simple-path: sample directions by the BSDF: true or false",
        apply: |desc, text| match &mut desc.integrator.value {
            IntegratorDesc::SimplePath { sample_bsdf, .. } => set(Some(sample_bsdf), text),
            _ => Err(NOT_HERE.into()),
        },
    },
    Setting {
        name: "cossample",
        help: "ambient-occlusion: sample directions by the cosine: true or false",
        apply: |desc, text| match &mut desc.integrator.value {
            IntegratorDesc::AmbientOcclusion { cos_sample, .. } => set(Some(cos_sample), text),
            _ => Err(NOT_HERE.into()),
        },
    },
    Setting {
        name: "maxdistance",
        help: "ambient-occlusion: how far away a surface hides the sky, in scene units",
        apply: |desc, text| match &mut desc.integrator.value {
            IntegratorDesc::AmbientOcclusion { max_distance, .. } => set(Some(max_distance), text),
            _ => Err(NOT_HERE.into()),
        },
    },
    Setting {
        name: "sampler",
        help: "independent, stratified, halton, paddedsobol, sobol or zsobol",
        apply: |desc, text| {
            desc.sampler.kind = choose(text, &SAMPLERS)?;
            let samples = desc.sampler.pixel_samples;
            set_samples_per_pixel(desc, samples);
            Ok(())
        },
    },
    Setting {
        name: "filter",
        help: "pixel filter with its usual radius: box, triangle, gaussian, mitchell or sinc",
        apply: |desc, text| {
            desc.filter.value = choose(text, &FILTERS)?;
            Ok(())
        },
    },
    Setting {
        name: "filterradius",
        help: "radius of the pixel filter in both directions, in pixels",
        apply: |desc, text| {
            let (FilterDesc::Box { radius }
            | FilterDesc::Triangle { radius }
            | FilterDesc::Gaussian { radius, .. }
            | FilterDesc::Mitchell { radius, .. }
            | FilterDesc::LanczosSinc { radius, .. }) = &mut desc.filter.value;
            *radius = [parse(text)?; 2];
            Ok(())
        },
    },
    Setting {
        name: "maxcomponentvalue",
        help: "samples are scaled down so that no sensor response exceeds this",
        apply: |desc, text| set(Some(&mut desc.film.max_component_value), text),
    },
    Setting {
        name: "iso",
        help: "sensitivity of the film, ISO",
        apply: |desc, text| set(Some(&mut desc.film.sensor.iso), text),
    },
    Setting {
        name: "whitebalance",
        help: "temperature in kelvin of the light that shall look white; 0 changes nothing",
        apply: |desc, text| set(Some(&mut desc.film.sensor.white_balance), text),
    },
    Setting {
        name: "savefp16",
        help: "store half floats (true) or single floats (false)",
        apply: |desc, text| set(Some(&mut desc.film.save_fp16), text),
    },
    Setting {
        name: "disablepixeljitter",
        help: "sample every pixel at its centre only: true or false",
        apply: |desc, text| set(Some(&mut desc.options.disable_pixel_jitter), text),
    },
];

const NOT_HERE: &str = "the scene's algorithm has no such setting";

const LIGHT_SAMPLERS: [(&str, LightSamplerDesc); 4] = [
    ("uniform", LightSamplerDesc::Uniform),
    ("power", LightSamplerDesc::Power),
    ("bvh", LightSamplerDesc::Bvh),
    ("exhaustive", LightSamplerDesc::Exhaustive),
];

const SAMPLERS: [(&str, SamplerKind); 6] = [
    ("independent", SamplerKind::Independent),
    ("stratified", SamplerKind::Stratified { strata: [4, 4], jitter: true }),
    ("halton", SamplerKind::Halton { randomization: Randomization::PermuteDigits }),
    ("paddedsobol", SamplerKind::PaddedSobol { randomization: Randomization::FastOwen }),
    ("sobol", SamplerKind::Sobol { randomization: Randomization::FastOwen }),
    ("zsobol", SamplerKind::ZSobol { randomization: Randomization::FastOwen }),
];

const FILTERS: [(&str, FilterDesc); 5] = [
    ("box", FilterDesc::Box { radius: [0.5, 0.5] }),
    ("triangle", FilterDesc::Triangle { radius: [2.0, 2.0] }),
    ("gaussian", FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 0.5 }),
    ("mitchell", FilterDesc::Mitchell { radius: [2.0, 2.0], b: 1.0 / 3.0, c: 1.0 / 3.0 }),
    ("sinc", FilterDesc::LanczosSinc { radius: [4.0, 4.0], tau: 3.0 }),
];

impl Overrides {
    /// Changes the scene; the first change that makes no sense is the error.
    pub fn apply(&self, desc: &mut SceneDesc) -> Result<(), OverrideError> {
        if let Some(name) = &self.integrator {
            let changed = integrator(name, &mut desc.integrator).ok_or_else(|| {
                OverrideError(format!(
                    "no integrator is called `{name}`; there are {}",
                    INTEGRATORS.join(", ")
                ))
            })?;
            desc.integrator.value = changed;
        }
        for (name, value) in &self.settings {
            let setting = SETTINGS.iter().find(|setting| setting.name == name).ok_or_else(|| {
                let names: Vec<_> = SETTINGS.iter().map(|setting| setting.name).collect();
                OverrideError(format!("no setting is called `{name}`; there are {}", names.join(", ")))
            })?;
            (setting.apply)(desc, value)
                .map_err(|reason| OverrideError(format!("cannot set {name} to `{value}`: {reason}")))?;
        }
        if let Some(samples) = self.samples_per_pixel {
            let samples = i32::try_from(samples).ok().filter(|&samples| samples > 0);
            let samples = samples
                .ok_or_else(|| OverrideError(format!("samples per pixel are from 1 to {}", i32::MAX)))?;
            set_samples_per_pixel(desc, samples);
        }
        if let Some(resolution) = self.resolution {
            desc.film.resolution = resolution;
        }
        if let Some(crop) = self.crop {
            desc.film.pixel_bounds = None;
            desc.film.crop_window = Some(crop);
        }
        if let Some([x, y]) = self.pixel {
            let [width, height] = desc.film.resolution;
            if !((0..width).contains(&x) && (0..height).contains(&y)) {
                return Err(OverrideError(format!(
                    "pixel {x},{y} is not in the image of {width} × {height} pixels"
                )));
            }
            desc.film.pixel_bounds = Some([x, x + 1, y, y + 1]);
        }
        if let Some(seed) = self.seed {
            desc.options.seed = seed;
            desc.sampler.seed = Some(seed);
        }
        Ok(())
    }
}

fn parse<T: FromStr>(text: &str) -> Result<T, String> {
    text.trim().parse().map_err(|_| match std::any::type_name::<T>() {
        "bool" => "it is true or false".into(),
        "i32" => "it is a whole number".into(),
        _ => "it is a number".into(),
    })
}

fn set<T: FromStr>(place: Option<&mut T>, text: &str) -> Result<(), String> {
    *place.ok_or(NOT_HERE)? = parse(text)?;
    Ok(())
}

fn choose<T: Clone>(text: &str, choices: &[(&str, T)]) -> Result<T, String> {
    let chosen = choices.iter().find(|(name, _)| *name == text);
    chosen.map(|(_, value)| value.clone()).ok_or_else(|| {
        let names: Vec<_> = choices.iter().map(|&(name, _)| name).collect();
        format!("there are {}", names.join(", "))
    })
}

/// Sets the number of samples; the strata of a stratified sampler become as nearly square as the number allows.
fn set_samples_per_pixel(desc: &mut SceneDesc, samples: i32) {
    desc.sampler.pixel_samples = samples;
    if let SamplerKind::Stratified { strata, .. } = &mut desc.sampler.kind {
        let root = f64::from(samples).sqrt() as i32;
        let side = (1..=root).rev().find(|side| samples % side == 0).unwrap_or(1);
        *strata = [samples / side, side];
    }
}

fn max_depth(desc: &mut IntegratorDesc) -> Option<&mut i32> {
    match desc {
        IntegratorDesc::Whitted { max_depth }
        | IntegratorDesc::RandomWalk { max_depth }
        | IntegratorDesc::SimplePath { max_depth, .. }
        | IntegratorDesc::Path { max_depth, .. }
        | IntegratorDesc::SimpleVolPath { max_depth }
        | IntegratorDesc::VolPath { max_depth, .. }
        | IntegratorDesc::LightPath { max_depth }
        | IntegratorDesc::Bdpt { max_depth, .. }
        | IntegratorDesc::Mlt(MltDesc { max_depth, .. })
        | IntegratorDesc::Sppm(SppmDesc { max_depth, .. }) => Some(max_depth),
        IntegratorDesc::RayCasting
        | IntegratorDesc::AmbientOcclusion { .. }
        | IntegratorDesc::Function { .. } => None,
    }
}

fn regularize(desc: &mut IntegratorDesc) -> Option<&mut bool> {
    match desc {
        IntegratorDesc::Path { regularize, .. }
        | IntegratorDesc::VolPath { regularize, .. }
        | IntegratorDesc::Bdpt { regularize, .. }
        | IntegratorDesc::Mlt(MltDesc { regularize, .. }) => Some(regularize),
        _ => None,
    }
}

fn light_sampler(desc: &mut IntegratorDesc) -> Option<&mut LightSamplerDesc> {
    match desc {
        IntegratorDesc::Path { light_sampler, .. } | IntegratorDesc::VolPath { light_sampler, .. } => {
            Some(light_sampler)
        }
        _ => None,
    }
}

/// The algorithm called `name`, with those settings of `current` that it has too. The format's spelling without hyphens is
/// understood as well.
fn integrator(name: &str, current: &mut IntegratorDesc) -> Option<IntegratorDesc> {
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
        "simple-vol-path" => IntegratorDesc::SimpleVolPath { max_depth },
        "vol-path" => IntegratorDesc::VolPath { max_depth, regularize, light_sampler },
        "light-path" => IntegratorDesc::LightPath { max_depth },
        "bdpt" => IntegratorDesc::Bdpt {
            max_depth,
            regularize,
            visualize_strategies: false,
            visualize_weights: false,
        },
        "mlt" => IntegratorDesc::Mlt(MltDesc { max_depth, regularize, ..MltDesc::default() }),
        _ => IntegratorDesc::Sppm(SppmDesc { max_depth, ..SppmDesc::default() }),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changed(overrides: Overrides) -> Result<SceneDesc, OverrideError> {
        let mut desc = SceneDesc::default();
        overrides.apply(&mut desc).map(|()| desc)
    }

    fn with_settings(settings: &[(&str, &str)]) -> Result<SceneDesc, OverrideError> {
        let settings = settings.iter().map(|&(name, value)| (name.into(), value.into())).collect();
        changed(Overrides { settings, ..Overrides::default() })
    }

    #[test]
    fn another_algorithm_keeps_the_settings_that_it_shares() {
        let mut desc = SceneDesc::default();
        desc.integrator.value =
            IntegratorDesc::Path { max_depth: 9, regularize: true, light_sampler: LightSamplerDesc::Power };
        for name in INTEGRATORS {
            let mut copy = desc.clone();
            let integrator = Some(name.to_owned());
            Overrides { integrator, ..Overrides::default() }.apply(&mut copy).unwrap();
            assert!(max_depth(&mut copy.integrator).is_none_or(|depth| *depth == 9), "{name}");
            assert!(regularize(&mut copy.integrator).is_none_or(|regularize| *regularize), "{name}");
        }
        let integrator = Some("volpath".to_owned());
        let desc = changed(Overrides { integrator, ..Overrides::default() }).unwrap();
        assert!(matches!(desc.integrator.value, IntegratorDesc::VolPath { max_depth: 5, .. }));
    }

    #[test]
    fn every_setting_has_a_value_that_it_takes_and_one_that_it_refuses() {
        for setting in &SETTINGS {
            let mut scenes = [
                IntegratorDesc::default(),
                IntegratorDesc::SimplePath { max_depth: 1, sample_lights: true, sample_bsdf: true },
                IntegratorDesc::AmbientOcclusion { cos_sample: true, max_distance: 1.0 },
            ]
            .map(|integrator| SceneDesc { integrator: integrator.into(), ..SceneDesc::default() });
            let mut takes = |value| scenes.iter_mut().any(|desc| (setting.apply)(desc, value).is_ok());
            assert!(["7", "true", "power", "sobol", "box"].into_iter().any(&mut takes), "{}", setting.name);
            assert!(!takes("nonsense"), "{}", setting.name);
        }
    }

    #[test]
    fn settings_reach_the_scene_in_order() {
        let desc =
            with_settings(&[("maxdepth", "3"), ("filter", "box"), ("filterradius", "2"), ("iso", "400")])
                .unwrap();
        assert!(matches!(desc.integrator.value, IntegratorDesc::VolPath { max_depth: 3, .. }));
        assert_eq!(desc.filter.value, FilterDesc::Box { radius: [2.0, 2.0] });
        assert_eq!(desc.film.sensor.iso, 400.0);
    }

    #[test]
    fn what_makes_no_sense_is_told() {
        let message = |settings| with_settings(settings).unwrap_err().to_string();
        assert_eq!(message(&[("maxdepth", "deep")]), "cannot set maxdepth to `deep`: it is a whole number");
        assert!(message(&[("depth", "5")]).starts_with("no setting is called `depth`; there are maxdepth, "));
        assert_eq!(
            message(&[("cossample", "true")]),
            "cannot set cossample to `true`: the scene's algorithm has no such setting"
        );
        let pixel = Overrides { pixel: Some([2000, 0]), ..Overrides::default() };
        assert_eq!(
            changed(pixel).unwrap_err().to_string(),
            "pixel 2000,0 is not in the image of 1280 × 720 pixels"
        );
    }

    #[test]
    fn strata_make_the_samples_asked_for() {
        for (samples, strata) in [(1, [1, 1]), (12, [4, 3]), (16, [4, 4]), (17, [17, 1])] {
            let mut desc = with_settings(&[("sampler", "stratified")]).unwrap();
            Overrides { samples_per_pixel: Some(samples), ..Overrides::default() }.apply(&mut desc).unwrap();
            assert!(
                matches!(desc.sampler.kind, SamplerKind::Stratified { strata: found, .. } if found == strata)
            );
        }
    }

    #[test]
    fn size_part_and_seed_replace_those_of_the_scene() {
        let desc = changed(Overrides {
            resolution: Some([100, 50]),
            crop: Some([0.0, 0.5, 0.0, 1.0]),
            pixel: Some([99, 49]),
            seed: Some(7),
            ..Overrides::default()
        });
        let desc = desc.unwrap();
        assert_eq!((desc.film.resolution, desc.film.pixel_bounds), ([100, 50], Some([99, 100, 49, 50])));
        assert_eq!((desc.options.seed, desc.sampler.seed), (7, Some(7)));
    }
}
