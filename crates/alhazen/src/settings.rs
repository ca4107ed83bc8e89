//! Settings of a scene that can be changed by name: one table.

use std::str::FromStr;

use description::{FilterDesc, IntegratorDesc, LightSamplerDesc, MltDesc, SamplerKind, SceneDesc, SppmDesc};

use crate::names::{FILTERS, LIGHT_SAMPLERS, QUALITIES, SAMPLERS};

/// A setting that can be changed by name.
pub struct Setting {
    /// Its name: the one that the pbrt-v4 format has for it.
    pub name: &'static str,
    /// What it means, with its unit and values.
    pub help: &'static str,
    pub(crate) apply: fn(&mut SceneDesc, &str) -> Result<(), String>,
}

/// Everything that [`Overrides`](crate::Overrides) can change by name.
pub static SETTINGS: [Setting; 16] = [
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
        name: "quality",
        help: "how much time the tree over the scene is worth: fast, balanced or high",
        apply: |desc, text| {
            desc.accelerator.value.set_quality(choose(text, &QUALITIES)?);
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
pub(crate) fn set_samples_per_pixel(desc: &mut SceneDesc, samples: i32) {
    desc.sampler.pixel_samples = samples;
    if let SamplerKind::Stratified { strata, .. } = &mut desc.sampler.kind {
        let root = f64::from(samples).sqrt() as i32;
        let side = (1..=root).rev().find(|side| samples % side == 0).unwrap_or(1);
        *strata = [samples / side, side];
    }
}

pub(crate) fn max_depth(desc: &mut IntegratorDesc) -> Option<&mut i32> {
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

pub(crate) fn regularize(desc: &mut IntegratorDesc) -> Option<&mut bool> {
    match desc {
        IntegratorDesc::Path { regularize, .. }
        | IntegratorDesc::VolPath { regularize, .. }
        | IntegratorDesc::Bdpt { regularize, .. }
        | IntegratorDesc::Mlt(MltDesc { regularize, .. }) => Some(regularize),
        _ => None,
    }
}

pub(crate) fn light_sampler(desc: &mut IntegratorDesc) -> Option<&mut LightSamplerDesc> {
    match desc {
        IntegratorDesc::Path { light_sampler, .. } | IntegratorDesc::VolPath { light_sampler, .. } => {
            Some(light_sampler)
        }
        _ => None,
    }
}
