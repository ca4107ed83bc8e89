//! Participating media.

use std::sync::Arc;

use math::{Point3, Vec3};

use crate::schema::{Field, MEAN_COSINE, Settings, Visitor, members, settings};
use crate::{ColorSpaceDesc, Handle, SpectrumDesc, TransformDesc, VoxelsDesc};

settings! {
    /// A medium.
    #[derive(Clone, Debug)]
    pub struct MediumDesc {
        /// Its name.
        name: String = String::new();
        /// The member of the set.
        kind: MediumKind = MediumKind::default() => ..;
        /// From the medium's space to the world.
        world_from_medium: TransformDesc = TransformDesc::default();
        /// Henyey–Greenstein asymmetry, −1 to 1.
        g: f32 = 0.0 => ["g": MEAN_COSINE];
    }
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

/// A preset has precedence over coefficients.
impl Settings for CoefficientsDesc {
    fn visit(&mut self, visitor: Visitor) {
        const FIELDS: &[Field; 4] = &[
            Field::new("preset", "A measured substance, in 1/mm, instead of `sigma_a` and `sigma_s`."),
            Field::new("sigma_a", "Absorption, 1/scene unit."),
            Field::new("sigma_s", "Scattering, 1/scene unit."),
            Field::new("scale", "Factor on absorption and scattering."),
        ];
        let (mut preset, mut sigma, mut scale) = match self.clone() {
            Self::Preset { name, scale } => (Some(name), [None, None], scale),
            Self::Given { sigma_a, sigma_s, scale } => (None, [Some(sigma_a), Some(sigma_s)], scale),
        };
        visitor(&FIELDS[0], &mut preset);
        visitor(&FIELDS[1], &mut sigma[0]);
        visitor(&FIELDS[2], &mut sigma[1]);
        visitor(&FIELDS[3], &mut scale);
        let [sigma_a, sigma_s] = sigma.map(|sigma| sigma.unwrap_or(1.0.into()));
        *self = match preset {
            Some(name) => Self::Preset { name, scale },
            None => Self::Given { sigma_a, sigma_s, scale },
        };
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

impl<T> Default for GridDesc<T> {
    /// A grid without cells.
    fn default() -> Self {
        Self { resolution: [0; 3], values: Arc::new([]) }
    }
}

settings! {
    /// How stored values become temperatures: `(value − offset) · scale`, in kelvin.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct TemperatureDesc {
        /// Number that is subtracted from temperatures. If absent, `temperaturecutoff`.
        offset: f32 = 0.0 => ["temperatureoffset"];
        /// Factor on temperatures less the offset, which are then in kelvin.
        scale: f32 = 1.0 => ["temperaturescale"];
    }
}

/// The corners of the box of a medium.
const CUBE: [Point3; 2] = [Vec3::ZERO, Vec3::ONE];

members! {
    /// The media of the format.
    #[derive(Clone, Debug)]
    #[expect(clippy::large_enum_variant, reason = "scenes have few media")]
    pub enum MediumKind: MediumType = Homogeneous {
        /// The same everywhere.
        Homogeneous = "homogeneous" {
            /// Absorption and scattering.
            coefficients: CoefficientsDesc = CoefficientsDesc::default() => ..;
            /// Emission. If absent, none.
            le: Option<SpectrumDesc> = None => ["Le"];
            /// Factor on the emission.
            le_scale: f32 = 1.0 => ["Lescale"];
        },
        /// Densities on a grid.
        UniformGrid = "uniformgrid" {
            /// Corners of the box.
            bounds: [Point3; 2] = CUBE => ["p0"[0], "p1"[1]];
            /// Absorption and scattering at density one.
            coefficients: CoefficientsDesc = CoefficientsDesc::default() => ..;
            /// Densities.
            density: GridDesc<f32> = GridDesc::default();
            /// Temperatures that make it emit.
            temperature: Option<GridDesc<f32>> = None;
            /// Their conversion to kelvin.
            temperature_scale: TemperatureDesc = TemperatureDesc::default() => ..;
            /// Emission, if not by temperature.
            le: Option<SpectrumDesc> = None => ["Le"];
            /// Factor on the emission per cell.
            le_scale: Option<GridDesc<f32>> = None;
            /// Factor on the emission.
            emission_scale: f32 = 1.0;
        },
        /// Colours on a grid.
        RgbGrid = "rgbgrid" {
            /// Corners of the box.
            bounds: [Point3; 2] = CUBE => ["p0"[0], "p1"[1]];
            /// Absorption.
            sigma_a: Option<GridDesc<[f32; 3]>> = None;
            /// Scattering.
            sigma_s: Option<GridDesc<[f32; 3]>> = None;
            /// Factor on absorption and scattering.
            scale: f32 = 1.0 => ["scale"];
            /// Emission.
            le: Option<GridDesc<[f32; 3]>> = None;
            /// Factor on the emission.
            le_scale: f32 = 1.0 => ["Lescale"];
            /// The space of the colours.
            space: ColorSpaceDesc = ColorSpaceDesc::Srgb;
        },
        /// A procedural cloud.
        Cloud = "cloud" {
            /// Corners of the box.
            bounds: [Point3; 2] = CUBE => ["p0"[0], "p1"[1]];
            /// Absorption and scattering at density one.
            coefficients: CoefficientsDesc = CoefficientsDesc::default() => ..;
            /// Factor on the density.
            density: f32 = 1.0 => ["density"];
            /// Amount of noise on its shape.
            wispiness: f32 = 1.0 => ["wispiness"];
            /// Frequency of the noise.
            frequency: f32 = 5.0 => ["frequency"];
        },
        /// Densities on sparse voxels, from a NanoVDB file.
        NanoVdb = "nanovdb" {
            /// Densities.
            density: VoxelsDesc = VoxelsDesc::default();
            /// Temperatures that make it emit.
            temperature: Option<VoxelsDesc> = None;
            /// Absorption and scattering at density one.
            coefficients: CoefficientsDesc = CoefficientsDesc::default() => ..;
            /// Conversion of temperatures to kelvin.
            temperature_scale: TemperatureDesc = TemperatureDesc::default() => ..;
            /// Factor on the emission.
            le_scale: f32 = 1.0 => ["Lescale"];
        },
    }
}
