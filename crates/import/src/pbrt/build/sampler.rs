//! Samplers.

use description::{Randomization, SamplerDesc, SamplerKind, Stated};

use super::Builder;
use crate::pbrt::reader::Reader;
use crate::pbrt::statement::Statement;

const TYPES: [&str; 7] = ["independent", "stratified", "halton", "paddedsobol", "sobol", "zsobol", "pmj02bn"];

impl Builder<'_> {
    pub(super) fn sampler(&mut self, statement: Statement) -> Stated<SamplerDesc> {
        self.read_or_default(statement, sampler)
    }
}

fn sampler(reader: &mut Reader) -> Option<SamplerDesc> {
    let (kind, default_samples) = match reader.kind.value.as_str() {
        "independent" => (SamplerKind::Independent, 4),
        "stratified" => {
            let strata =
                [reader.integer("xsamples", 4, 1..=30_000), reader.integer("ysamples", 4, 1..=30_000)];
            let kind = SamplerKind::Stratified { strata, jitter: reader.boolean("jitter", true) };
            let seed = reader.optional_integer("seed");
            return Some(SamplerDesc { kind, pixel_samples: strata[0] * strata[1], seed });
        }
        "halton" => {
            let randomization = reader.choice(
                "randomization",
                Randomization::PermuteDigits,
                &[
                    ("none", Randomization::None),
                    ("permutedigits", Randomization::PermuteDigits),
                    ("owen", Randomization::Owen),
                ],
            );
            (SamplerKind::Halton { randomization }, 16)
        }
        "paddedsobol" => (SamplerKind::PaddedSobol { randomization: sobol_randomization(reader) }, 16),
        "sobol" => (SamplerKind::Sobol { randomization: sobol_randomization(reader) }, 16),
        "zsobol" => (SamplerKind::ZSobol { randomization: sobol_randomization(reader) }, 16),
        "pmj02bn" => (SamplerKind::Pmj02Bn, 16),
        _ => {
            reader.unknown_type("sampler", "sampler", &TYPES);
            return None;
        }
    };
    Some(SamplerDesc {
        kind,
        pixel_samples: reader.integer("pixelsamples", default_samples, 1..=i32::MAX),
        seed: reader.optional_integer("seed"),
    })
}

fn sobol_randomization(reader: &mut Reader) -> Randomization {
    reader.choice(
        "randomization",
        Randomization::FastOwen,
        &[
            ("none", Randomization::None),
            ("permutedigits", Randomization::PermuteDigits),
            ("fastowen", Randomization::FastOwen),
            ("owen", Randomization::Owen),
        ],
    )
}
