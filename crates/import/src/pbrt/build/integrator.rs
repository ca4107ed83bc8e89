//! Light transport algorithms.

use description::{
    FormFactorsDesc, IntegratorDesc, LightSamplerDesc, MltDesc, MltTechnique, PhotonKernel,
    PhotonMappingDesc, PhotonMappingShow, RadiosityDesc, SppmDesc, Stated, VcmDesc,
};

use super::Builder;
use crate::pbrt::reader::Reader;
use crate::pbrt::statement::Statement;

const TYPES: [&str; 18] = [
    "path",
    "volpath",
    "bdpt",
    "mlt",
    "sppm",
    "lightpath",
    "simplepath",
    "simplevolpath",
    "randomwalk",
    "ambientocclusion",
    "function",
    "whitted",
    "ray-casting",
    "ambient-occlusion",
    "light-tracing",
    "photon-mapping",
    "vcm",
    "radiosity",
];

impl Builder<'_> {
    pub(super) fn integrator(&mut self, statement: Statement) -> Stated<IntegratorDesc> {
        self.read_or_default(statement, integrator)
    }
}

fn integrator(reader: &mut Reader) -> Option<IntegratorDesc> {
    Some(match reader.kind.value.as_str() {
        "ray-casting" => IntegratorDesc::RayCasting,
        "whitted" => IntegratorDesc::Whitted { max_depth: max_depth(reader) },
        "ambientocclusion" | "ambient-occlusion" => IntegratorDesc::AmbientOcclusion {
            cos_sample: reader.boolean("cossample", true),
            max_distance: reader.positive("maxdistance", f32::INFINITY),
        },
        "randomwalk" | "random-walk" => IntegratorDesc::RandomWalk { max_depth: max_depth(reader) },
        "simplepath" | "simple-path" => IntegratorDesc::SimplePath {
            max_depth: max_depth(reader),
            sample_lights: reader.boolean("samplelights", true),
            sample_bsdf: reader.boolean("samplebsdf", true),
        },
        "path" => IntegratorDesc::Path {
            max_depth: max_depth(reader),
            regularize: reader.boolean("regularize", false),
            light_sampler: light_sampler(reader),
        },
        "simplevolpath" => IntegratorDesc::SimpleVolPath { max_depth: max_depth(reader) },
        "volpath" => IntegratorDesc::VolPath {
            max_depth: max_depth(reader),
            regularize: reader.boolean("regularize", false),
            light_sampler: light_sampler(reader),
        },
        "lightpath" | "light-tracing" => IntegratorDesc::LightTracing { max_depth: max_depth(reader) },
        "bdpt" => IntegratorDesc::Bdpt {
            max_depth: max_depth(reader),
            regularize: reader.boolean("regularize", false),
            visualize_strategies: reader.boolean("visualizestrategies", false),
            visualize_weights: reader.boolean("visualizeweights", false),
        },
        "mlt" => IntegratorDesc::Mlt(mlt(reader)),
        "sppm" => IntegratorDesc::Sppm(SppmDesc {
            max_depth: max_depth(reader),
            photons_per_iteration: reader
                .optional_integer("photonsperiteration")
                .filter(|&photons| photons > 0),
            radius: radius(reader),
            seed: reader.optional_integer("seed"),
        }),
        "photon-mapping" => IntegratorDesc::PhotonMapping(photon_mapping(reader)),
        "vcm" => IntegratorDesc::Vcm(VcmDesc {
            max_depth: max_depth(reader),
            radius: radius(reader),
            alpha: reader.positive("alpha", VcmDesc::default().alpha),
        }),
        "radiosity" => IntegratorDesc::Radiosity(radiosity(reader)),
        "function" => IntegratorDesc::Function {
            function: reader.string("function").map_or("step".into(), |function| function.value),
            skip_bad: reader.boolean("skipbad", true),
            image_filename: reader.string("imagefilename").map(|file| file.value),
        },
        _ => {
            reader.unknown_type("integrator", "integrator", &TYPES);
            return None;
        }
    })
}

fn max_depth(reader: &mut Reader) -> i32 {
    reader.integer("maxdepth", 5, 0..=i32::MAX)
}

fn light_sampler(reader: &mut Reader) -> LightSamplerDesc {
    reader.choice(
        "lightsampler",
        LightSamplerDesc::Bvh,
        &[
            ("uniform", LightSamplerDesc::Uniform),
            ("power", LightSamplerDesc::Power),
            ("bvh", LightSamplerDesc::Bvh),
            ("exhaustive", LightSamplerDesc::Exhaustive),
        ],
    )
}

/// A distance, where one is given.
fn radius(reader: &mut Reader) -> Option<f32> {
    Some(reader.positive("radius", f32::INFINITY)).filter(|radius| radius.is_finite())
}

fn photon_mapping(reader: &mut Reader) -> PhotonMappingDesc {
    let default = PhotonMappingDesc::default();
    PhotonMappingDesc {
        max_depth: max_depth(reader),
        photons: reader.integer("photons", default.photons, 0..=i32::MAX),
        caustic_photons: reader.integer("causticphotons", default.caustic_photons, 0..=i32::MAX),
        nearest: reader.integer("nearest", default.nearest, 1..=i32::MAX),
        radius: radius(reader),
        kernel: reader.choice(
            "kernel",
            default.kernel,
            &[("cone", PhotonKernel::Cone), ("epanechnikov", PhotonKernel::Epanechnikov)],
        ),
        gather: reader.integer("gather", default.gather, 0..=i32::MAX),
        show: reader.choice(
            "show",
            default.show,
            &[("radiance", PhotonMappingShow::Radiance), ("photons", PhotonMappingShow::Photons)],
        ),
    }
}

fn radiosity(reader: &mut Reader) -> RadiosityDesc {
    let default = RadiosityDesc::default();
    RadiosityDesc {
        max_depth: max_depth(reader),
        form_factors: reader.choice(
            "formfactors",
            default.form_factors,
            &[("analytic", FormFactorsDesc::Analytic), ("hemicube", FormFactorsDesc::Hemicube)],
        ),
        hemicube_resolution: reader.integer("hemicuberesolution", default.hemicube_resolution, 2..=1024),
        patch_size: Some(reader.positive("patchsize", f32::INFINITY)).filter(|size| size.is_finite()),
        subdivision: reader.integer("subdivision", default.subdivision, 0..=10),
        gradient: reader.positive("gradient", default.gradient),
        max_patches: reader.integer("maxpatches", default.max_patches, 1..=i32::MAX),
        tolerance: reader.positive("tolerance", default.tolerance),
        steps: reader.integer("steps", default.steps, 1..=i32::MAX),
        gather: reader.integer("gather", default.gather, 0..=i32::MAX),
        mesh_out: reader.string("mesh-out").map(|file| file.value),
    }
}

fn mlt(reader: &mut Reader) -> MltDesc {
    let default = MltDesc::default();
    MltDesc {
        technique: reader.choice(
            "technique",
            default.technique,
            &[("path", MltTechnique::Path), ("bdpt", MltTechnique::Bdpt)],
        ),
        max_depth: max_depth(reader),
        bootstrap_samples: reader.integer("bootstrapsamples", default.bootstrap_samples, 1..=i32::MAX),
        chains: reader.integer("chains", default.chains, 1..=i32::MAX),
        mutations_per_pixel: reader.integer("mutationsperpixel", default.mutations_per_pixel, 1..=i32::MAX),
        large_step_probability: reader.float("largestepprobability", default.large_step_probability),
        sigma: reader.positive("sigma", default.sigma),
        regularize: reader.boolean("regularize", default.regularize),
    }
}
