//! Light transport algorithms.

use description::{IntegratorDesc, LightSamplerDesc, MltDesc, SppmDesc, Stated};

use super::Builder;
use crate::pbrt::reader::Reader;
use crate::pbrt::statement::Statement;

const TYPES: [&str; 14] = [
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
        "lightpath" => IntegratorDesc::LightPath { max_depth: max_depth(reader) },
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
            radius: reader.positive("radius", SppmDesc::default().radius),
            seed: reader.optional_integer("seed"),
        }),
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

fn mlt(reader: &mut Reader) -> MltDesc {
    let default = MltDesc::default();
    MltDesc {
        max_depth: max_depth(reader),
        bootstrap_samples: reader.integer("bootstrapsamples", default.bootstrap_samples, 1..=i32::MAX),
        chains: reader.integer("chains", default.chains, 1..=i32::MAX),
        mutations_per_pixel: reader.integer("mutationsperpixel", default.mutations_per_pixel, 1..=i32::MAX),
        large_step_probability: reader.float("largestepprobability", default.large_step_probability),
        sigma: reader.positive("sigma", default.sigma),
        regularize: reader.boolean("regularize", default.regularize),
    }
}
