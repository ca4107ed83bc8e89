//! Sources of random numbers: the kind and the hash of the seed; of `zsobol` then the binary
//! logarithm of the number of samples, the digits of a pixel's code, and the randomisation. Of
//! `paddedsobol` the kind, the seed, the number of samples, and the randomisation.

use description::Span;
use sampling::Sampler;
use sampling::sampler::Randomize;

use super::Flattener;

const INDEPENDENT: u32 = 0;
const ZSOBOL: u32 = 1;
const PADDED_SOBOL: u32 = 2;

impl Flattener<'_> {
    /// A sampler; its offset.
    pub fn sampler(&mut self, sampler: &Sampler) -> u32 {
        let name = match sampler {
            Sampler::Independent(sampler) => return self.slab.add([INDEPENDENT, sampler.key()]),
            Sampler::ZSobol(sampler) => {
                let (samples, side, randomize, key) = sampler.parts();
                return self.slab.add([ZSOBOL, key, samples, side, randomize_word(randomize)]);
            }
            Sampler::PaddedSobol(padded) => {
                self.parts.padded_sobol = true;
                let (randomize, seed) = padded.parts();
                let samples = sampler.samples_per_pixel();
                return self.slab.add([PADDED_SOBOL, seed, samples, randomize_word(randomize)]);
            }
            Sampler::Stratified(_) => "stratified",
            Sampler::Halton(_) => "halton",
            Sampler::Sobol(_) => "sobol",
            Sampler::Pmj02Bn(_) => "pmj02bn",
            Sampler::PrimarySample(_) => "of mutations",
        };
        self.refuse(format!("sampler `{name}`"), Span::NONE);
        0
    }
}

/// The place of a member in its enum, as the translation has it.
fn randomize_word(randomize: Randomize) -> u32 {
    match randomize {
        Randomize::None => 0,
        Randomize::PermuteDigits => 1,
        Randomize::FastOwen => 2,
        Randomize::Owen => 3,
    }
}
