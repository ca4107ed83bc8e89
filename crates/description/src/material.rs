//! Materials: how surfaces scatter light.

use std::sync::Arc;

use scattering::{MeasuredTable, SubsurfaceMethod};

use crate::names::names;
use crate::{FloatParameter, Handle, OpenPbrDesc, SpectrumDesc, SpectrumParameter, UvImageDesc};

/// A material.
#[derive(Clone, Debug)]
pub struct MaterialDesc {
    /// Its name; may be empty.
    pub name: String,
    /// Which one.
    pub kind: MaterialKind,
    /// A tangent-space normal map.
    pub normal_map: Option<UvImageDesc>,
    /// A bump map: a displacement along the normal that only shading sees. It has no effect beside
    /// a normal map.
    pub displacement: Option<FloatParameter>,
}

impl From<MaterialKind> for MaterialDesc {
    fn from(kind: MaterialKind) -> Self {
        Self { name: String::new(), kind, normal_map: None, displacement: None }
    }
}

impl Default for MaterialDesc {
    fn default() -> Self {
        MaterialKind::Diffuse { reflectance: 0.5.into() }.into()
    }
}

/// Roughness of a microfacet surface.
#[derive(Clone, Debug, PartialEq)]
pub struct RoughnessDesc {
    /// Along the surface's u direction.
    pub u: FloatParameter,
    /// Along v.
    pub v: FloatParameter,
    /// The values are perceptual: α is their square root.
    pub remap: bool,
}

impl RoughnessDesc {
    /// The same roughness both ways, remapped.
    pub fn isotropic(roughness: f32) -> Self {
        Self { u: roughness.into(), v: roughness.into(), remap: true }
    }
}

impl Default for RoughnessDesc {
    fn default() -> Self {
        Self::isotropic(0.0)
    }
}

/// Reflectance of a conductor.
#[derive(Clone, Debug, PartialEq)]
pub enum ConductorReflectance {
    /// By its complex index of refraction.
    Index {
        /// Real part.
        eta: SpectrumParameter,
        /// Imaginary part.
        k: SpectrumParameter,
    },
    /// By its reflectance at normal incidence.
    Reflectance(SpectrumParameter),
}

impl Default for ConductorReflectance {
    fn default() -> Self {
        Self::Index {
            eta: SpectrumDesc::Named("metal-Cu-eta".into()).into(),
            k: SpectrumDesc::Named("metal-Cu-k".into()).into(),
        }
    }
}

/// The materials of the format.
#[derive(Clone, Debug)]
pub enum MaterialKind {
    /// Lambertian reflection.
    Diffuse {
        /// Albedo.
        reflectance: SpectrumParameter,
    },
    /// Lambertian reflection and transmission.
    DiffuseTransmission {
        /// Reflected share.
        reflectance: SpectrumParameter,
        /// Transmitted share.
        transmittance: SpectrumParameter,
        /// Factor on both.
        scale: f32,
    },
    /// Metal.
    Conductor(ConductorDesc),
    /// Glass, water.
    Dielectric {
        /// Index of refraction.
        eta: SpectrumDesc,
        /// Roughness of the interface.
        roughness: RoughnessDesc,
    },
    /// A thin sheet of glass, both interfaces in one surface.
    ThinDielectric {
        /// Index of refraction.
        eta: SpectrumDesc,
    },
    /// A diffuse surface under a dielectric coat.
    CoatedDiffuse(CoatedDiffuseDesc),
    /// A metal under a dielectric coat.
    CoatedConductor(CoatedConductorDesc),
    /// A fibre.
    Hair {
        /// Its absorption, given in one of three ways.
        color: HairColor,
        /// Index of refraction.
        eta: FloatParameter,
        /// Longitudinal roughness.
        beta_m: FloatParameter,
        /// Azimuthal roughness.
        beta_n: FloatParameter,
        /// Angle of the scales in degrees.
        alpha: FloatParameter,
    },
    /// A dielectric surface with subsurface scattering.
    Subsurface {
        /// The scattering inside, given in one of three ways.
        scattering: SubsurfaceScattering,
        /// Factor on the coefficients (1/scene unit for coefficients in 1/mm).
        scale: f32,
        /// Index of refraction.
        eta: f32,
        /// Henyey–Greenstein asymmetry.
        g: f32,
        /// Roughness of the interface.
        roughness: RoughnessDesc,
        /// How light is followed.
        method: SubsurfaceMethod,
    },
    /// A measured surface.
    Measured {
        /// The measurements.
        table: Arc<MeasuredTable>,
    },
    /// A principled surface.
    OpenPbr(Box<OpenPbrDesc>),
    /// One of two materials, chosen at random.
    Mix {
        /// The two materials.
        materials: [Handle<MaterialDesc>; 2],
        /// Probability of the second.
        amount: FloatParameter,
    },
    /// An interface between media, which does not scatter.
    Interface,
}

names! {
    /// The names of materials.
    MaterialType of MaterialKind {
        Diffuse = "diffuse",
        CoatedDiffuse = "coateddiffuse",
        CoatedConductor = "coatedconductor",
        Conductor = "conductor",
        Dielectric = "dielectric",
        ThinDielectric = "thindielectric",
        DiffuseTransmission = "diffusetransmission",
        Hair = "hair",
        Subsurface = "subsurface",
        Measured = "measured",
        OpenPbr = "openpbr",
        Mix = "mix",
        Interface = "interface",
    }
}

impl MaterialKind {
    /// Whether it scatters diffusely or not at all. Also true for a mix, whose parts have to be
    /// checked.
    pub fn is_diffuse(&self) -> bool {
        match self {
            Self::Diffuse { .. } | Self::DiffuseTransmission { .. } | Self::Mix { .. } | Self::Interface => {
                true
            }
            Self::Conductor(_)
            | Self::Dielectric { .. }
            | Self::ThinDielectric { .. }
            | Self::CoatedDiffuse(_)
            | Self::CoatedConductor(_)
            | Self::Hair { .. }
            | Self::Subsurface { .. }
            | Self::Measured { .. }
            | Self::OpenPbr(_) => false,
        }
    }
}

/// A metal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConductorDesc {
    /// Its reflectance.
    pub reflectance: ConductorReflectance,
    /// Its roughness.
    pub roughness: RoughnessDesc,
}

/// Simulation of the layers of a coated material.
#[derive(Clone, Debug, PartialEq)]
pub struct LayersDesc {
    /// Thickness of the coat.
    pub thickness: FloatParameter,
    /// Single-scattering albedo of the medium in it; 0 for no medium.
    pub albedo: SpectrumParameter,
    /// Henyey–Greenstein asymmetry of that medium.
    pub g: FloatParameter,
    /// Maximum number of events of a random walk.
    pub max_depth: i32,
    /// Random walks averaged per evaluation.
    pub samples: i32,
}

impl Default for LayersDesc {
    fn default() -> Self {
        Self { thickness: 0.01.into(), albedo: 0.0.into(), g: 0.0.into(), max_depth: 10, samples: 1 }
    }
}

/// A diffuse surface under a dielectric coat.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedDiffuseDesc {
    /// Albedo of the surface.
    pub reflectance: SpectrumParameter,
    /// Index of refraction of the coat.
    pub eta: SpectrumDesc,
    /// Roughness of the coat.
    pub roughness: RoughnessDesc,
    /// The inside of the coat.
    pub layers: LayersDesc,
}

impl Default for CoatedDiffuseDesc {
    fn default() -> Self {
        Self {
            reflectance: 0.5.into(),
            eta: SpectrumDesc::Constant(1.5),
            roughness: RoughnessDesc::default(),
            layers: LayersDesc::default(),
        }
    }
}

/// A metal under a dielectric coat.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedConductorDesc {
    /// The metal.
    pub conductor: ConductorDesc,
    /// Index of refraction of the coat.
    pub eta: SpectrumDesc,
    /// Roughness of the coat.
    pub roughness: RoughnessDesc,
    /// The inside of the coat.
    pub layers: LayersDesc,
}

impl Default for CoatedConductorDesc {
    fn default() -> Self {
        Self {
            conductor: ConductorDesc::default(),
            eta: SpectrumDesc::Constant(1.5),
            roughness: RoughnessDesc::default(),
            layers: LayersDesc::default(),
        }
    }
}

/// The absorption in a fibre.
#[derive(Clone, Debug, PartialEq)]
pub enum HairColor {
    /// Coefficient per fibre diameter.
    SigmaA(SpectrumParameter),
    /// The colour of a volume of hair.
    Reflectance(SpectrumParameter),
    /// Concentrations of pigment.
    Melanin {
        /// Brown.
        eumelanin: FloatParameter,
        /// Red.
        pheomelanin: FloatParameter,
    },
}

/// The scattering inside a subsurface material.
#[derive(Clone, Debug, PartialEq)]
pub enum SubsurfaceScattering {
    /// A predefined measured substance of the format.
    Named(String),
    /// Coefficients in 1/mm.
    Coefficients {
        /// Absorption.
        sigma_a: SpectrumParameter,
        /// Scattering.
        sigma_s: SpectrumParameter,
    },
    /// Effective reflectance.
    Reflectance {
        /// The colour.
        reflectance: SpectrumParameter,
        /// Mean free path in mm.
        mfp: SpectrumParameter,
    },
}
