//! Samples of pixels.

use std::slice::from_ref;

use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::{FirstHit, Parts};

/// A sample of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// Radiance, at one or more groups of wavelengths that count alike.
    pub l: &'a [SampledSpectrum],
    /// The wavelengths of each group.
    pub lambda: &'a [SampledWavelengths],
    /// Weight in the pixel, by its filter.
    pub weight: f32,
    /// Opacity of what the sample sees, from 0 to 1.
    pub alpha: f32,
    /// The sample's first hit; only films with a layer of it use it.
    pub first_hit: Option<FirstHit>,
    /// The parts of its radiance, at the first group of wavelengths; only films with a layer of
    /// them use them.
    pub parts: Option<&'a Parts>,
}

impl<'a> Sample<'a> {
    /// A sample of radiance alone, with opacity 0.
    pub fn new(l: &'a SampledSpectrum, lambda: &'a SampledWavelengths, weight: f32) -> Self {
        Self { l: from_ref(l), lambda: from_ref(lambda), weight, alpha: 0.0, first_hit: None, parts: None }
    }
}
