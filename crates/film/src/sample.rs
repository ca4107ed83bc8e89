//! Samples of pixels.

use std::slice::from_ref;

use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::Parts;

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

/// The first hit of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// As [`Layer::Depth`](crate::Layer::Depth) has it, in units of the scene.
    pub depth: f32,
    /// Position in world space.
    pub position: [f32; 3],
    /// Shading normal in world space, of unit length.
    pub normal: [f32; 3],
    /// Position in camera space.
    pub camera_position: [f32; 3],
    /// Shading normal in camera space, of unit length.
    pub camera_normal: [f32; 3],
    /// Geometric normal in world space, of unit length.
    pub geometric_normal: [f32; 3],
    /// Geometric normal in camera space, of unit length.
    pub camera_geometric_normal: [f32; 3],
    /// Derivatives of world z by film x and y, over the footprint of a sample.
    pub slope: [f32; 2],
    /// Derivatives of camera z by film x and y, over the footprint of a sample.
    pub camera_slope: [f32; 2],
    /// Reflectance at the sample's first group of wavelengths.
    pub albedo: SampledSpectrum,
    /// Surface parameters.
    pub uv: [f32; 2],
    /// Motion of the point on the film while the shutter is open, in pixels.
    pub motion: [f32; 2],
    /// Identifier of the object; [`id_of_name`](crate::id_of_name) makes one of a name.
    pub object: u32,
    /// Identifier of the material.
    pub material: u32,
    /// Identifier of the asset.
    pub asset: u32,
}
