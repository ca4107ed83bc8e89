//! Settings of a scene that can be changed by name: one table.

use std::str::FromStr;

use description::{
    FilterDesc, IntegratorDesc, LightSamplerDesc, MltDesc, PhotonMappingDesc, RadiosityDesc, SamplerKind,
    SceneDesc, SppmDesc, VcmDesc,
};

use crate::names::{
    FILTERS, FORM_FACTORS, LIGHT_SAMPLERS, MLT_TECHNIQUES, PHOTON_KERNELS, PHOTON_MAPPING_SHOWS, QUALITIES,
    SAMPLERS,
};

/// A setting that can be changed by name.
pub struct Setting {
    /// Its name: the one that the pbrt-v4 format has for it.
    pub name: &'static str,
    /// What it means, with its unit and values.
    pub help: &'static str,
    pub(crate) apply: fn(&mut SceneDesc, &str) -> Result<(), String>,
}

/// Everything that [`Overrides`](crate::Overrides) can change by name.
pub static SETTINGS: [Setting; 40] = [
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
        name: "techniques",
        help: "bdpt: one picture per strategy, weighted and unweighted: true or false",
        apply: |desc, text| match &mut desc.integrator.value {
            IntegratorDesc::Bdpt { visualize_strategies, visualize_weights, .. } => {
                set(Some(visualize_strategies), text)?;
                *visualize_weights = *visualize_strategies;
                Ok(())
            }
            _ => Err(NOT_HERE.into()),
        },
    },
    Setting {
        name: "technique",
        help: "mlt: what chains move through: path or bdpt",
        apply: |desc, text| {
            mlt(desc)?.technique = choose(text, &MLT_TECHNIQUES)?;
            Ok(())
        },
    },
    Setting {
        name: "bootstrapsamples",
        help: "mlt: most paths among which the chains of a pass choose where to start",
        apply: |desc, text| set(Some(&mut mlt(desc)?.bootstrap_samples), text),
    },
    Setting {
        name: "chains",
        help: "mlt: most chains of a pass, which has a mutation per pixel",
        apply: |desc, text| set(Some(&mut mlt(desc)?.chains), text),
    },
    Setting {
        name: "mutationsperpixel",
        help: "mlt: mutations per pixel, on average; --spp sets it, too",
        apply: |desc, text| set(Some(&mut mlt(desc)?.mutations_per_pixel), text),
    },
    Setting {
        name: "largestepprobability",
        help: "mlt: probability of a mutation to an independent path",
        apply: |desc, text| set(Some(&mut mlt(desc)?.large_step_probability), text),
    },
    Setting {
        name: "sigma",
        help: "mlt: standard deviation of small mutations in the unit cube of random numbers",
        apply: |desc, text| set(Some(&mut mlt(desc)?.sigma), text),
    },
    Setting {
        name: "photons",
        help: "photon-mapping: paths of the global map; sppm: paths; in each pass",
        apply: |desc, text| match &mut desc.integrator.value {
            IntegratorDesc::PhotonMapping(photon_mapping) => set(Some(&mut photon_mapping.photons), text),
            IntegratorDesc::Sppm(sppm) => {
                sppm.photons_per_iteration = Some(parse(text)?);
                Ok(())
            }
            _ => Err(NOT_HERE.into()),
        },
    },
    Setting {
        name: "causticphotons",
        help: "photon-mapping: paths of the caustic map in each pass",
        apply: |desc, text| set(Some(&mut photon_mapping(desc)?.caustic_photons), text),
    },
    Setting {
        name: "nearest",
        help: "photon-mapping: how many of the nearest photons make an estimate",
        apply: |desc, text| set(Some(&mut photon_mapping(desc)?.nearest), text),
    },
    Setting {
        name: "radius",
        help: "photon-mapping, sppm, vcm: how far away photons count (at first), in scene units",
        apply: |desc, text| {
            let radius = parse(text)?;
            match &mut desc.integrator.value {
                IntegratorDesc::PhotonMapping(photon_mapping) => photon_mapping.radius = Some(radius),
                IntegratorDesc::Sppm(sppm) => sppm.radius = radius,
                IntegratorDesc::Vcm(vcm) => vcm.radius = Some(radius),
                _ => return Err(NOT_HERE.into()),
            }
            Ok(())
        },
    },
    Setting {
        name: "kernel",
        help: "photon-mapping: how photons are weighed: cone or epanechnikov",
        apply: |desc, text| {
            photon_mapping(desc)?.kernel = choose(text, &PHOTON_KERNELS)?;
            Ok(())
        },
    },
    Setting {
        name: "gather",
        help: "photon-mapping, radiosity: rays of a final gather; 0 for none",
        apply: |desc, text| match &mut desc.integrator.value {
            IntegratorDesc::PhotonMapping(photon_mapping) => set(Some(&mut photon_mapping.gather), text),
            IntegratorDesc::Radiosity(radiosity) => set(Some(&mut radiosity.gather), text),
            _ => Err(NOT_HERE.into()),
        },
    },
    Setting {
        name: "show",
        help: "photon-mapping: radiance or photons",
        apply: |desc, text| {
            photon_mapping(desc)?.show = choose(text, &PHOTON_MAPPING_SHOWS)?;
            Ok(())
        },
    },
    Setting {
        name: "alpha",
        help: "vcm: how slowly the radius shrinks, from 0 to 1",
        apply: |desc, text| match &mut desc.integrator.value {
            IntegratorDesc::Vcm(vcm) => set(Some(&mut vcm.alpha), text),
            _ => Err(NOT_HERE.into()),
        },
    },
    Setting {
        name: "formfactors",
        help: "radiosity: how form factors are found: analytic or hemicube",
        apply: |desc, text| {
            radiosity(desc)?.form_factors = choose(text, &FORM_FACTORS)?;
            Ok(())
        },
    },
    Setting {
        name: "hemicuberesolution",
        help: "radiosity: pixels along an edge of a hemicube",
        apply: |desc, text| set(Some(&mut radiosity(desc)?.hemicube_resolution), text),
    },
    Setting {
        name: "patchsize",
        help: "radiosity: longest side of a patch, in scene units",
        apply: |desc, text| {
            radiosity(desc)?.patch_size = Some(parse(text)?);
            Ok(())
        },
    },
    Setting {
        name: "subdivision",
        help: "radiosity: how often an element may be quartered",
        apply: |desc, text| set(Some(&mut radiosity(desc)?.subdivision), text),
    },
    Setting {
        name: "gradient",
        help: "radiosity: change of light across an element, in parts of what is there, above which it is quartered",
        apply: |desc, text| set(Some(&mut radiosity(desc)?.gradient), text),
    },
    Setting {
        name: "maxpatches",
        help: "radiosity: most elements; of more primitives than half of it the smallest pass no light on",
        apply: |desc, text| set(Some(&mut radiosity(desc)?.max_patches), text),
    },
    Setting {
        name: "tolerance",
        help: "radiosity: share of light that need not be sent",
        apply: |desc, text| set(Some(&mut radiosity(desc)?.tolerance), text),
    },
    Setting {
        name: "steps",
        help: "radiosity: passes in which light is sent",
        apply: |desc, text| set(Some(&mut radiosity(desc)?.steps), text),
    },
    Setting {
        name: "mesh-out",
        help: "radiosity: a file (.ply) for patches with their radiosity as vertex colours",
        apply: |desc, text| {
            let radiosity = radiosity(desc)?;
            if !text.ends_with(".ply") {
                return Err("its name ends in .ply".into());
            }
            radiosity.mesh_out = Some(text.into());
            Ok(())
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

pub(crate) fn mlt(desc: &mut SceneDesc) -> Result<&mut MltDesc, String> {
    match &mut desc.integrator.value {
        IntegratorDesc::Mlt(mlt) => Ok(mlt),
        _ => Err(NOT_HERE.into()),
    }
}

fn radiosity(desc: &mut SceneDesc) -> Result<&mut RadiosityDesc, String> {
    match &mut desc.integrator.value {
        IntegratorDesc::Radiosity(radiosity) => Ok(radiosity),
        _ => Err(NOT_HERE.into()),
    }
}

fn photon_mapping(desc: &mut SceneDesc) -> Result<&mut PhotonMappingDesc, String> {
    match &mut desc.integrator.value {
        IntegratorDesc::PhotonMapping(photon_mapping) => Ok(photon_mapping),
        _ => Err(NOT_HERE.into()),
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
        | IntegratorDesc::LightTracing { max_depth }
        | IntegratorDesc::Bdpt { max_depth, .. }
        | IntegratorDesc::Mlt(MltDesc { max_depth, .. })
        | IntegratorDesc::PhotonMapping(PhotonMappingDesc { max_depth, .. })
        | IntegratorDesc::Vcm(VcmDesc { max_depth, .. })
        | IntegratorDesc::Radiosity(RadiosityDesc { max_depth, .. })
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
