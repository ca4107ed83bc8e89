//! Sources of random numbers: the kind and numbers. Keys are hashes of seeds.
//!
//! | kind | numbers |
//! |---|---|
//! | 0 independent | key |
//! | 1 zsobol | key, binary logarithm of the samples of a round, digits of a pixel's code, randomisation |
//! | 2 paddedsobol | seed, number of samples, randomisation |
//! | 3 sobol | randomisation, binary logarithm of the side of the square of pixels, number of dimensions, offset of their hashes, offset of their matrices |
//! | 4 halton | key, randomisation, number of bases, their offset |
//! | 5 stratified | key, seed, columns, rows, 1 where positions in cells are random |
//! | 6 pmj02bn | key, binary logarithm of the samples of a round |

use description::Span;
use sampling::low_discrepancy::{PRIME_COUNT, prime};
use sampling::{Randomize, Sampler};

use super::Flattener;

const INDEPENDENT: u32 = 0;
const ZSOBOL: u32 = 1;
const PADDED_SOBOL: u32 = 2;
const SOBOL: u32 = 3;
const HALTON: u32 = 4;
const STRATIFIED: u32 = 5;
const PMJ02BN: u32 = 6;

impl Flattener<'_> {
    /// A sampler; its offset.
    pub fn sampler(&mut self, sampler: &Sampler) -> u32 {
        let is_zsobol = matches!(sampler, Sampler::ZSobol(_));
        self.parts.zsobol |= is_zsobol;
        self.parts.rare_samplers |= !is_zsobol && !matches!(sampler, Sampler::Independent(_));
        match sampler {
            Sampler::Independent(sampler) => self.slab.add([INDEPENDENT, sampler.key()]),
            Sampler::ZSobol(sampler) => {
                let (samples, side, randomize, key) = sampler.parts();
                self.slab.add([ZSOBOL, key, samples, side, randomize_word(randomize)])
            }
            Sampler::PaddedSobol(padded) => {
                let (randomize, seed) = padded.parts();
                let samples = sampler.samples_per_pixel();
                self.slab.add([PADDED_SOBOL, seed, samples, randomize_word(randomize)])
            }
            Sampler::Sobol(sobol) => {
                let (randomize, seeds, log2_side, matrices) = sobol.parts();
                let seeds_at = self.slab.add(seeds.iter().copied());
                let matrices_at = self.slab.add(matrices.as_flattened().as_flattened().iter().copied());
                let [randomize, dimensions] = [randomize_word(randomize), seeds.len() as u32];
                self.slab.add([SOBOL, randomize, log2_side, dimensions, seeds_at, matrices_at])
            }
            Sampler::Halton(halton) => {
                let (randomize, key) = halton.parts();
                let primes = self.slab.add((0..PRIME_COUNT).map(prime));
                self.slab.add([HALTON, key, randomize_word(randomize), PRIME_COUNT as u32, primes])
            }
            Sampler::Stratified(stratified) => {
                let ([columns, rows], seed, jitter) = stratified.parts();
                let key = jitter.unwrap_or_default();
                self.slab.add([STRATIFIED, key, seed, columns, rows, jitter.is_some().into()])
            }
            Sampler::Pmj02Bn(sampler) => {
                let (log2_samples, key) = sampler.parts();
                self.slab.add([PMJ02BN, key, log2_samples])
            }
            Sampler::PrimarySample(_) => {
                self.refuse("random numbers of mutations", Span::NONE);
                0
            }
        }
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
