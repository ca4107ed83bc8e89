//! Participating media.

use std::sync::Arc;

use math::Point3;

use crate::names::names;
use crate::{ColorSpaceDesc, Handle, SpectrumDesc, TransformDesc, VoxelsDesc};

/// A medium.
#[derive(Clone, Debug)]
pub struct MediumDesc {
    /// Its name.
    pub name: String,
    /// Which one.
    pub kind: MediumKind,
    /// From the medium's space to the world.
    pub world_from_medium: TransformDesc,
    /// Henyey–Greenstein asymmetry, −1 to 1.
    pub g: f32,
}

/// The media on the two sides of a surface; `None` is empty space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MediumInterface {
    /// Behind the surface normal.
    pub inside: Option<Handle<MediumDesc>>,
    /// Before it.
    pub outside: Option<Handle<MediumDesc>>,
}

/// Absorption and scattering per unit of length.
#[derive(Clone, Debug, PartialEq)]
pub enum CoefficientsDesc {
    /// A predefined measured substance of the format, in 1/mm.
    Preset {
        /// Its name.
        name: String,
        /// Factor on both.
        scale: f32,
    },
    /// Explicit coefficients.
    Given {
        /// Absorption.
        sigma_a: SpectrumDesc,
        /// Scattering.
        sigma_s: SpectrumDesc,
        /// Factor on both.
        scale: f32,
    },
}

impl Default for CoefficientsDesc {
    fn default() -> Self {
        Self::Given { sigma_a: 1.0.into(), sigma_s: 1.0.into(), scale: 1.0 }
    }
}

/// Values on a regular grid over a box, x fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct GridDesc<T> {
    /// Counts in x, y and z.
    pub resolution: [i32; 3],
    /// One value per cell.
    pub values: Arc<[T]>,
}

/// How stored values become temperatures: `(value − offset) · scale`, in kelvin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TemperatureDesc {
    /// Subtracted.
    pub offset: f32,
    /// Factor.
    pub scale: f32,
}

impl Default for TemperatureDesc {
    fn default() -> Self {
        Self { offset: 0.0, scale: 1.0 }
    }
}

/// The media of the format.
#[expect(clippy::large_enum_variant, reason = "scenes have few media")]
#[derive(Clone, Debug)]
pub enum MediumKind {
    /// Constant coefficients.
    Homogeneous {
        /// Absorption and scattering.
        coefficients: CoefficientsDesc,
        /// Emission.
        le: Option<SpectrumDesc>,
        /// Factor on the emission.
        le_scale: f32,
    },
    /// Densities on a grid.
    UniformGrid {
        /// Corners of the box.
        bounds: [Point3; 2],
        /// Absorption and scattering at density one.
        coefficients: CoefficientsDesc,
        /// Densities.
        density: GridDesc<f32>,
        /// Temperatures that make it emit.
        temperature: Option<GridDesc<f32>>,
        /// Their conversion to kelvin.
        temperature_scale: TemperatureDesc,
        /// Emission, if not by temperature.
        le: Option<SpectrumDesc>,
        /// Factor on the emission per cell.
        le_scale: Option<GridDesc<f32>>,
        /// Factor on the emission.
        emission_scale: f32,
    },
    /// Colours on a grid.
    RgbGrid {
        /// Corners of the box.
        bounds: [Point3; 2],
        /// Absorption.
        sigma_a: Option<GridDesc<[f32; 3]>>,
        /// Scattering.
        sigma_s: Option<GridDesc<[f32; 3]>>,
        /// Factor on both.
        scale: f32,
        /// Emission.
        le: Option<GridDesc<[f32; 3]>>,
        /// Factor on the emission.
        le_scale: f32,
        /// The space of the colours.
        space: ColorSpaceDesc,
    },
    /// A procedural cloud.
    Cloud {
        /// Corners of the box.
        bounds: [Point3; 2],
        /// Absorption and scattering at density one.
        coefficients: CoefficientsDesc,
        /// Factor on the density.
        density: f32,
        /// Amount of noise on its shape.
        wispiness: f32,
        /// Frequency of the noise.
        frequency: f32,
    },
    /// Densities on sparse voxels, from a NanoVDB file.
    NanoVdb {
        /// Densities.
        density: VoxelsDesc,
        /// Temperatures that make it emit.
        temperature: Option<VoxelsDesc>,
        /// Absorption and scattering at density one.
        coefficients: CoefficientsDesc,
        /// Conversion of temperatures to kelvin.
        temperature_scale: TemperatureDesc,
        /// Factor on the emission.
        le_scale: f32,
    },
}

names! {
    /// The names of media.
    MediumType of MediumKind {
        Homogeneous = "homogeneous",
        UniformGrid = "uniformgrid",
        RgbGrid = "rgbgrid",
        Cloud = "cloud",
        NanoVdb = "nanovdb",
    }
}
