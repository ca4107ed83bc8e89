//! Settings of a scene that can be changed by name: one table.

use description::{
    FilterDesc, IntegratorDesc, LightSamplerDesc, MltDesc, PhotonMappingDesc, RadiosityDesc, SamplerKind,
    SceneDesc, Span, SppmDesc, VcmDesc,
};

use crate::names::{FILTERS, QUALITIES, SAMPLERS};
use crate::values::{At, Flags, PlyFile, Value, choose};

/// A setting that can be changed by name.
pub struct Setting {
    /// Its name: the one that the pbrt-v4 format has for it.
    pub name: &'static str,
    /// What it means, with its unit and values.
    pub help: &'static str,
    place: Place,
}

/// Where the value of a setting stands.
enum Place {
    /// In those algorithms that have it.
    Integrator(for<'a> fn(&'a mut IntegratorDesc) -> Option<Box<dyn Value + 'a>>),
    /// Elsewhere in any scene.
    Scene(fn(&mut SceneDesc, &str) -> Result<(), String>),
}

impl Setting {
    /// The one of that name.
    pub(crate) fn named(name: &str) -> Option<&'static Self> {
        SETTINGS.iter().find(|setting| setting.name == name)
    }

    /// Changes the scene.
    pub(crate) fn apply(&self, desc: &mut SceneDesc, text: &str) -> Result<(), String> {
        match self.place {
            Place::Integrator(place) => {
                place(&mut desc.integrator).ok_or("the scene's algorithm has no such setting")?.set(text)
            }
            Place::Scene(set) => set(desc, text),
        }
    }

    /// Whether it changes a scene with such an algorithm.
    pub(crate) fn is_of(&self, integrator: &IntegratorDesc) -> bool {
        match self.place {
            Place::Integrator(place) => place(&mut integrator.clone()).is_some(),
            Place::Scene(_) => true,
        }
    }

    /// From now on what is wrong with the setting is the fault of what stands at `span`.
    pub(crate) fn blame(&self, desc: &mut SceneDesc, span: Span) {
        // Names that the format has for what has another one here.
        let parameters: &[_] = match self.name {
            "photons" => &["photons", "photonsperiteration"],
            "techniques" => &["visualizestrategies", "visualizeweights"],
            "filterradius" => &["xradius", "yradius"],
            _ => &[self.name],
        };
        for &parameter in parameters {
            match self.place {
                Place::Integrator(_) => desc.integrator.origin.set_parameter(parameter, span),
                Place::Scene(_) => {
                    desc.film.origin.set_parameter(parameter, span);
                    desc.filter.origin.set_parameter(parameter, span);
                }
            }
        }
    }
}

/// The settings of an algorithm with their values; `None` for what is left to it.
pub(crate) fn settings_of(integrator: &IntegratorDesc) -> Vec<(&'static str, Option<String>)> {
    let mut integrator = integrator.clone();
    let value = |setting: &Setting| match setting.place {
        Place::Integrator(place) => Some((setting.name, place(&mut integrator)?.get())),
        Place::Scene(_) => None,
    };
    SETTINGS.iter().filter_map(value).collect()
}

/// Gives an algorithm a setting of another one, if it has it, too.
pub(crate) fn keep(integrator: &mut IntegratorDesc, (name, value): &(&'static str, Option<String>)) {
    let Some(Setting { place: Place::Integrator(place), .. }) = Setting::named(name) else { return };
    if let (Some(mut place), Some(value)) = (place(integrator), value) {
        // A value that means nothing here is not shared.
        let _ = place.set(value);
    }
}

/// Everything that [`Overrides`](crate::Overrides) can change by name.
pub static SETTINGS: [Setting; 40] = [
    Setting {
        name: "maxdepth",
        help: "most bounces of a path after the camera's ray",
        place: Place::Integrator(|desc| at(max_depth(desc))),
    },
    Setting {
        name: "regularize",
        help: "roughen surfaces after the first rough bounce: true or false",
        place: Place::Integrator(|desc| at(regularize(desc))),
    },
    Setting {
        name: "lightsampler",
        help: "how a light is chosen: uniform, power, bvh or exhaustive",
        place: Place::Integrator(|desc| at(light_sampler(desc))),
    },
    Setting {
        name: "samplelights",
        help: "simple-path: sample lights at each surface: true or false",
        place: Place::Integrator(|desc| match desc {
            IntegratorDesc::SimplePath { sample_lights, .. } => at(Some(sample_lights)),
            _ => None,
        }),
    },
    Setting {
        name: "samplebsdf",
        help: "simple-path: sample directions by the BSDF: true or false",
        place: Place::Integrator(|desc| match desc {
            IntegratorDesc::SimplePath { sample_bsdf, .. } => at(Some(sample_bsdf)),
            _ => None,
        }),
    },
    Setting {
        name: "cossample",
        help: "ambient-occlusion: sample directions by the cosine: true or false",
        place: Place::Integrator(|desc| match desc {
            IntegratorDesc::AmbientOcclusion { cos_sample, .. } => at(Some(cos_sample)),
            _ => None,
        }),
    },
    Setting {
        name: "maxdistance",
        help: "ambient-occlusion: how far away a surface hides the sky, in scene units",
        place: Place::Integrator(|desc| match desc {
            IntegratorDesc::AmbientOcclusion { max_distance, .. } => at(Some(max_distance)),
            _ => None,
        }),
    },
    Setting {
        name: "techniques",
        help: "bdpt: one picture per strategy of up to 8 bounces, weighted and unweighted, 2.4 KiB a pixel at 5 bounces: true or false",
        place: Place::Integrator(|desc| match desc {
            IntegratorDesc::Bdpt { visualize_strategies, visualize_weights, .. } => {
                Some(Box::new(Flags([visualize_strategies, visualize_weights])))
            }
            _ => None,
        }),
    },
    Setting {
        name: "technique",
        help: "mlt: what chains move through: path or bdpt",
        place: Place::Integrator(|desc| at(mlt(desc).map(|mlt| &mut mlt.technique))),
    },
    Setting {
        name: "bootstrapsamples",
        help: "mlt: most paths among which the chains of a pass choose where to start",
        place: Place::Integrator(|desc| at(mlt(desc).map(|mlt| &mut mlt.bootstrap_samples))),
    },
    Setting {
        name: "chains",
        help: "mlt: most chains of a pass, which has a mutation per pixel",
        place: Place::Integrator(|desc| at(mlt(desc).map(|mlt| &mut mlt.chains))),
    },
    Setting {
        name: "mutationsperpixel",
        help: "mlt: mutations per pixel, on average; --spp sets it, too",
        place: Place::Integrator(|desc| at(mlt(desc).map(|mlt| &mut mlt.mutations_per_pixel))),
    },
    Setting {
        name: "largestepprobability",
        help: "mlt: probability of a mutation to an independent path",
        place: Place::Integrator(|desc| at(mlt(desc).map(|mlt| &mut mlt.large_step_probability))),
    },
    Setting {
        name: "sigma",
        help: "mlt: standard deviation of small mutations in the unit cube of random numbers",
        place: Place::Integrator(|desc| at(mlt(desc).map(|mlt| &mut mlt.sigma))),
    },
    Setting {
        name: "photons",
        help: "photon-mapping: paths of the global map; sppm: paths; in each pass",
        place: Place::Integrator(|desc| match desc {
            IntegratorDesc::PhotonMapping(photon_mapping) => at(Some(&mut photon_mapping.photons)),
            IntegratorDesc::Sppm(sppm) => at(Some(&mut sppm.photons_per_iteration)),
            _ => None,
        }),
    },
    Setting {
        name: "causticphotons",
        help: "photon-mapping: paths of the caustic map in each pass",
        place: Place::Integrator(|desc| {
            at(photon_mapping(desc).map(|photon_mapping| &mut photon_mapping.caustic_photons))
        }),
    },
    Setting {
        name: "nearest",
        help: "photon-mapping: how many of the nearest photons make an estimate",
        place: Place::Integrator(|desc| {
            at(photon_mapping(desc).map(|photon_mapping| &mut photon_mapping.nearest))
        }),
    },
    Setting {
        name: "radius",
        help: "photon-mapping, sppm, vcm: how far away photons count (at first), in scene units; else a part of the scene's size",
        place: Place::Integrator(|desc| match desc {
            IntegratorDesc::PhotonMapping(PhotonMappingDesc { radius, .. })
            | IntegratorDesc::Sppm(SppmDesc { radius, .. })
            | IntegratorDesc::Vcm(VcmDesc { radius, .. }) => at(Some(radius)),
            _ => None,
        }),
    },
    Setting {
        name: "kernel",
        help: "photon-mapping: how photons are weighed: cone or epanechnikov",
        place: Place::Integrator(|desc| {
            at(photon_mapping(desc).map(|photon_mapping| &mut photon_mapping.kernel))
        }),
    },
    Setting {
        name: "gather",
        help: "photon-mapping, radiosity: rays of a final gather; 0 for none",
        place: Place::Integrator(|desc| match desc {
            IntegratorDesc::PhotonMapping(PhotonMappingDesc { gather, .. })
            | IntegratorDesc::Radiosity(RadiosityDesc { gather, .. }) => at(Some(gather)),
            _ => None,
        }),
    },
    Setting {
        name: "show",
        help: "photon-mapping: radiance or photons",
        place: Place::Integrator(|desc| {
            at(photon_mapping(desc).map(|photon_mapping| &mut photon_mapping.show))
        }),
    },
    Setting {
        name: "alpha",
        help: "vcm: how slowly the radius shrinks, from 0 to 1",
        place: Place::Integrator(|desc| match desc {
            IntegratorDesc::Vcm(vcm) => at(Some(&mut vcm.alpha)),
            _ => None,
        }),
    },
    Setting {
        name: "formfactors",
        help: "radiosity: how form factors are found: analytic or hemicube",
        place: Place::Integrator(|desc| at(radiosity(desc).map(|radiosity| &mut radiosity.form_factors))),
    },
    Setting {
        name: "hemicuberesolution",
        help: "radiosity: pixels along an edge of a hemicube",
        place: Place::Integrator(|desc| {
            at(radiosity(desc).map(|radiosity| &mut radiosity.hemicube_resolution))
        }),
    },
    Setting {
        name: "patchsize",
        help: "radiosity: longest side of a patch, in scene units",
        place: Place::Integrator(|desc| at(radiosity(desc).map(|radiosity| &mut radiosity.patch_size))),
    },
    Setting {
        name: "subdivision",
        help: "radiosity: how often an element may be quartered",
        place: Place::Integrator(|desc| at(radiosity(desc).map(|radiosity| &mut radiosity.subdivision))),
    },
    Setting {
        name: "gradient",
        help: "radiosity: change of light across an element, in parts of what is there, above which it is quartered",
        place: Place::Integrator(|desc| at(radiosity(desc).map(|radiosity| &mut radiosity.gradient))),
    },
    Setting {
        name: "maxpatches",
        help: "radiosity: most elements; of more primitives than half of it the smallest pass no light on",
        place: Place::Integrator(|desc| at(radiosity(desc).map(|radiosity| &mut radiosity.max_patches))),
    },
    Setting {
        name: "tolerance",
        help: "radiosity: share of light that need not be sent",
        place: Place::Integrator(|desc| at(radiosity(desc).map(|radiosity| &mut radiosity.tolerance))),
    },
    Setting {
        name: "steps",
        help: "radiosity: passes in which light is sent",
        place: Place::Integrator(|desc| at(radiosity(desc).map(|radiosity| &mut radiosity.steps))),
    },
    Setting {
        name: "mesh-out",
        help: "radiosity: a file (.ply) for patches with their radiosity as vertex colours",
        place: Place::Integrator(|desc| {
            radiosity(desc).map(|radiosity| -> Box<dyn Value> { Box::new(PlyFile(&mut radiosity.mesh_out)) })
        }),
    },
    Setting {
        name: "sampler",
        help: "independent, stratified, halton, paddedsobol, sobol or zsobol",
        place: Place::Scene(|desc, text| {
            desc.sampler.kind = choose(text, &SAMPLERS)?;
            let samples = desc.sampler.pixel_samples;
            set_samples_per_pixel(desc, samples);
            Ok(())
        }),
    },
    Setting {
        name: "filter",
        help: "pixel filter with its usual radius: box, triangle, gaussian, mitchell or sinc",
        place: Place::Scene(|desc, text| {
            desc.filter.value = choose(text, &FILTERS)?;
            Ok(())
        }),
    },
    Setting {
        name: "filterradius",
        help: "radius of the pixel filter in both directions, in pixels",
        place: Place::Scene(|desc, text| {
            let (FilterDesc::Box { radius }
            | FilterDesc::Triangle { radius }
            | FilterDesc::Gaussian { radius, .. }
            | FilterDesc::Mitchell { radius, .. }
            | FilterDesc::LanczosSinc { radius, .. }) = &mut desc.filter.value;
            radius[0].set(text)?;
            radius[1] = radius[0];
            Ok(())
        }),
    },
    Setting {
        name: "quality",
        help: "how much time the tree over the scene is worth: fast, balanced or high",
        place: Place::Scene(|desc, text| {
            desc.accelerator.value.set_quality(choose(text, &QUALITIES)?);
            Ok(())
        }),
    },
    Setting {
        name: "maxcomponentvalue",
        help: "samples are scaled down so that no sensor response exceeds this",
        place: Place::Scene(|desc, text| desc.film.max_component_value.set(text)),
    },
    Setting {
        name: "iso",
        help: "sensitivity of the film, ISO",
        place: Place::Scene(|desc, text| desc.film.sensor.iso.set(text)),
    },
    Setting {
        name: "whitebalance",
        help: "temperature in kelvin of the light that shall look white; 0 changes nothing",
        place: Place::Scene(|desc, text| desc.film.sensor.white_balance.set(text)),
    },
    Setting {
        name: "savefp16",
        help: "store half floats (true) or single floats (false)",
        place: Place::Scene(|desc, text| desc.film.save_fp16.set(text)),
    },
    Setting {
        name: "disablepixeljitter",
        help: "sample every pixel at its centre only: true or false",
        place: Place::Scene(|desc, text| desc.options.disable_pixel_jitter.set(text)),
    },
];

/// A place where there is one.
fn at<'a>(place: Option<&'a mut (impl Value + 'a)>) -> Option<Box<dyn Value + 'a>> {
    place.map(|place| -> Box<dyn Value> { Box::new(At(place)) })
}

/// Sets the number of samples; the strata of a stratified sampler become as nearly square as the
/// number allows.
pub(crate) fn set_samples_per_pixel(desc: &mut SceneDesc, samples: i32) {
    desc.sampler.pixel_samples = samples;
    if let SamplerKind::Stratified { strata, .. } = &mut desc.sampler.kind {
        let root = f64::from(samples).sqrt() as i32;
        let side = (1..=root).rev().find(|side| samples % side == 0).unwrap_or(1);
        *strata = [samples / side, side];
    }
}

fn mlt(desc: &mut IntegratorDesc) -> Option<&mut MltDesc> {
    match desc {
        IntegratorDesc::Mlt(mlt) => Some(mlt),
        _ => None,
    }
}

fn radiosity(desc: &mut IntegratorDesc) -> Option<&mut RadiosityDesc> {
    match desc {
        IntegratorDesc::Radiosity(radiosity) => Some(radiosity),
        _ => None,
    }
}

fn photon_mapping(desc: &mut IntegratorDesc) -> Option<&mut PhotonMappingDesc> {
    match desc {
        IntegratorDesc::PhotonMapping(photon_mapping) => Some(photon_mapping),
        _ => None,
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

fn light_sampler(desc: &mut IntegratorDesc) -> Option<&mut LightSamplerDesc> {
    match desc {
        IntegratorDesc::Path { light_sampler, .. } | IntegratorDesc::VolPath { light_sampler, .. } => {
            Some(light_sampler)
        }
        _ => None,
    }
}
