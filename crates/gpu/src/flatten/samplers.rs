//! Sources of random numbers: the kind and numbers. Keys are hashes of
//! seeds, randomisations the members of `Randomize` as they are translated.
//!
//! | kind | numbers |
//! |---|---|
//! | independent | key |
//! | zsobol | key, binary logarithm of the samples of a round, digits of a pixel's code, randomisation |
//! | paddedsobol | seed, number of samples, randomisation |
//! | sobol | randomisation, binary logarithm of the side of the square of pixels, number of dimensions, offset of their hashes, offset of their matrices |
//! | halton | key, randomisation, number of bases, their offset |
//! | stratified | key, seed, columns, rows, 1 where positions in cells are random |
//! | pmj02bn | key, binary logarithm of the samples of a round |

use description::Span;
use sampling::Sampler;
use sampling::low_discrepancy::{PRIME_COUNT, prime};

use super::Flattener;
use crate::tags::SamplerTag;

impl Flattener<'_> {
    /// A sampler; its offset.
    pub fn sampler(&mut self, sampler: &Sampler) -> u32 {
        let is_zsobol = matches!(sampler, Sampler::ZSobol(_));
        self.parts.zsobol |= is_zsobol;
        self.parts.rare_samplers |= !is_zsobol && !matches!(sampler, Sampler::Independent(_));
        match sampler {
            Sampler::Independent(sampler) => self.slab.add([SamplerTag::Independent as u32, sampler.key()]),
            Sampler::ZSobol(sampler) => {
                let (samples, side, randomize, key) = sampler.parts();
                self.slab.add([SamplerTag::ZSobol as u32, key, samples, side, randomize as u32])
            }
            Sampler::PaddedSobol(padded) => {
                let (randomize, seed) = padded.parts();
                let samples = sampler.samples_per_pixel();
                self.slab.add([SamplerTag::PaddedSobol as u32, seed, samples, randomize as u32])
            }
            Sampler::Sobol(sobol) => {
                let (randomize, seeds, log2_side, matrices) = sobol.parts();
                let seeds_at = self.slab.add(seeds.iter().copied());
                let matrices_at = self.slab.add(matrices.as_flattened().as_flattened().iter().copied());
                let [randomize, dimensions] = [randomize as u32, seeds.len() as u32];
                self.slab.add([
                    SamplerTag::Sobol as u32,
                    randomize,
                    log2_side,
                    dimensions,
                    seeds_at,
                    matrices_at,
                ])
            }
            Sampler::Halton(halton) => {
                let (randomize, key) = halton.parts();
                let primes = self.slab.add((0..PRIME_COUNT).map(prime));
                self.slab.add([SamplerTag::Halton as u32, key, randomize as u32, PRIME_COUNT as u32, primes])
            }
            Sampler::Stratified(stratified) => {
                let ([columns, rows], seed, jitter) = stratified.parts();
                let key = jitter.unwrap_or_default();
                self.slab.add([
                    SamplerTag::Stratified as u32,
                    key,
                    seed,
                    columns,
                    rows,
                    jitter.is_some().into(),
                ])
            }
            Sampler::Pmj02Bn(sampler) => {
                let (log2_samples, key) = sampler.parts();
                self.slab.add([SamplerTag::Pmj02Bn as u32, key, log2_samples])
            }
            Sampler::PrimarySample(_) => {
                self.refuse("random numbers of mutations", Span::NONE);
                0
            }
        }
    }
}
