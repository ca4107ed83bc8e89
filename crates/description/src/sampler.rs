//! Samplers: the sample points of pixels.

use crate::schema::{at_least, choices, from, settings};

choices! {
    /// How a low-discrepancy sequence is randomised.
    pub enum Randomization {
        /// Not at all.
        None = "none",
        /// A random permutation of each digit.
        PermuteDigits = "permutedigits",
        /// Owen scrambling by a hash.
        #[default]
        FastOwen = "fastowen",
        /// Owen scrambling.
        Owen = "owen",
    }
}

choices! {
    /// How the digits of the Halton sequence are randomised.
    pub enum HaltonRandomization {
        /// Not at all.
        None = "none",
        /// A random permutation of each digit.
        #[default]
        PermuteDigits = "permutedigits",
        /// Owen scrambling.
        Owen = "owen",
    }
}

settings! {
    /// A sampler.
    #[derive(Clone, Debug, PartialEq)]
    pub struct SamplerDesc {
        /// Which one.
        kind: SamplerKind = SamplerKind::default() => ..;
        /// Seed of the sampler. If absent, that of the options.
        seed: Option<i32> = None => ["seed"];
    }
}

settings! {
    /// The samplers of the format.
    #[derive(Clone, Debug, PartialEq)]
    pub enum SamplerKind = ZSobol {
        /// Uniform random points.
        Independent = "independent" {
            /// Samples per pixel.
            pixel_samples: u32 = 4 => ["pixelsamples": at_least(1.0)];
        },
        /// One point in each cell of a grid.
        Stratified = "stratified" {
            /// Cells along an axis of the grid. Their product is the number of samples per pixel.
            strata: [u32; 2] = [4, 4] => ["xsamples"[0]: from(1.0, 3e4), "ysamples"[1]: from(1.0, 3e4)];
            /// Random positions in the cells instead of their centres.
            jitter: bool = true => ["jitter"];
        },
        /// The Halton sequence.
        Halton = "halton" {
            /// Samples per pixel.
            pixel_samples: u32 = 16 => ["pixelsamples": at_least(1.0)];
            /// How the digits are randomised.
            randomization: HaltonRandomization = HaltonRandomization::PermuteDigits => ["randomization"];
        },
        /// Two-dimensional Sobol' points, padded.
        PaddedSobol = "paddedsobol" {
            /// Samples per pixel.
            pixel_samples: u32 = 16 => ["pixelsamples": at_least(1.0)];
            /// How the points are randomised.
            randomization: Randomization = Randomization::FastOwen => ["randomization"];
        },
        /// One Sobol' sequence over the image.
        Sobol = "sobol" {
            /// Samples per pixel.
            pixel_samples: u32 = 16 => ["pixelsamples": at_least(1.0)];
            /// How the sequence is randomised.
            randomization: Randomization = Randomization::FastOwen => ["randomization"];
        },
        /// Sobol' points in an order that leaves blue noise in the image.
        ZSobol = "zsobol" {
            /// Samples per pixel.
            pixel_samples: u32 = 16 => ["pixelsamples": at_least(1.0)];
            /// How the points are randomised.
            randomization: Randomization = Randomization::FastOwen => ["randomization"];
        },
        /// Progressive multi-jittered points with blue noise.
        Pmj02Bn = "pmj02bn" {
            /// Samples per pixel.
            pixel_samples: u32 = 16 => ["pixelsamples": at_least(1.0)];
        },
    }
}

impl SamplerKind {
    /// Samples per pixel.
    pub fn samples_per_pixel(&self) -> u32 {
        match *self {
            Self::Stratified { strata: [x, y], .. } => x.saturating_mul(y),
            Self::Independent { pixel_samples }
            | Self::Halton { pixel_samples, .. }
            | Self::PaddedSobol { pixel_samples, .. }
            | Self::Sobol { pixel_samples, .. }
            | Self::ZSobol { pixel_samples, .. }
            | Self::Pmj02Bn { pixel_samples } => pixel_samples,
        }
    }

    /// The samples per pixel for which they are arranged: sequences over the whole image, and
    /// filters of textures with them, are for the next power of two, of which the samples are the
    /// first.
    pub fn arranged_samples(&self) -> u32 {
        let samples = self.samples_per_pixel().max(1);
        match self {
            Self::Sobol { .. } | Self::ZSobol { .. } | Self::Pmj02Bn { .. } => {
                samples.checked_next_power_of_two().unwrap_or(1 << 31)
            }
            Self::Independent { .. }
            | Self::Stratified { .. }
            | Self::Halton { .. }
            | Self::PaddedSobol { .. } => samples,
        }
    }

    /// Sets the samples per pixel; strata become as nearly square as the number allows.
    pub fn set_samples_per_pixel(&mut self, samples: u32) {
        match self {
            Self::Stratified { strata, .. } => {
                let side =
                    (1..=samples.isqrt()).rev().find(|side| samples.is_multiple_of(*side)).unwrap_or(1);
                *strata = [samples / side, side];
            }
            Self::Independent { pixel_samples }
            | Self::Halton { pixel_samples, .. }
            | Self::PaddedSobol { pixel_samples, .. }
            | Self::Sobol { pixel_samples, .. }
            | Self::ZSobol { pixel_samples, .. }
            | Self::Pmj02Bn { pixel_samples } => *pixel_samples = samples,
        }
    }
}
