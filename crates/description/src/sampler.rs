//! Samplers: which points of the unit square a pixel's samples take.

/// How a low-discrepancy sequence is randomised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Randomization {
    /// Not at all.
    None,
    /// Each digit permuted by its place.
    PermuteDigits,
    /// Owen scrambling by a hash.
    FastOwen,
    /// Owen scrambling.
    Owen,
}

/// A sampler.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplerDesc {
    /// Which one.
    pub kind: SamplerKind,
    /// Samples per pixel; for the stratified sampler the product of its two numbers of strata.
    pub pixel_samples: i32,
    /// Its seed; the scene's if absent.
    pub seed: Option<i32>,
}

/// The samplers of the format.
#[derive(Clone, Debug, PartialEq)]
pub enum SamplerKind {
    /// Uniform random points.
    Independent,
    /// One point per cell of a grid.
    Stratified {
        /// Cells in x and y.
        strata: [i32; 2],
        /// Random places in the cells instead of their centres.
        jitter: bool,
    },
    /// The Halton sequence.
    Halton {
        /// Its randomisation; `FastOwen` does not occur.
        randomization: Randomization,
    },
    /// Two-dimensional Sobol' points, padded.
    PaddedSobol {
        /// Its randomisation.
        randomization: Randomization,
    },
    /// One Sobol' sequence over the image.
    Sobol {
        /// Its randomisation.
        randomization: Randomization,
    },
    /// Sobol' points in an order that leaves blue noise in the image.
    ZSobol {
        /// Its randomisation.
        randomization: Randomization,
    },
    /// Progressive multi-jittered points with blue noise.
    Pmj02Bn,
}

impl Default for SamplerDesc {
    fn default() -> Self {
        Self {
            kind: SamplerKind::ZSobol { randomization: Randomization::FastOwen },
            pixel_samples: 16,
            seed: None,
        }
    }
}
