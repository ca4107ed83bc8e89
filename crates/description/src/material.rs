//! Materials: how surfaces scatter light.

use std::sync::Arc;

use scattering::{MeasuredTable, SubsurfaceMethod};

use crate::microsurface::{REMAP, conductor_fields, roughness_fields};
use crate::schema::{
    Field, MEAN_COSINE, SHARE, Settings, Visitor, at_least, index_of_refraction, members, settings,
};
use crate::{
    ConductorDesc, FloatParameter, HairColor, Handle, OpenPbrDesc, RoughnessDesc, SpectrumDesc,
    SpectrumParameter, SubsurfaceScattering, UvImageDesc,
};

/// A material.
#[derive(Clone, Debug)]
pub struct MaterialDesc {
    /// Its name; may be empty.
    pub name: String,
    /// The member of the set.
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
        MaterialKind::default().into()
    }
}

members! {
    /// The materials of the format.
    #[derive(Clone, Debug)]
    pub enum MaterialKind: MaterialType = Diffuse {
        /// Lambertian reflection.
        Diffuse = "diffuse" {
            /// Reflected share, 0 to 1.
            reflectance: SpectrumParameter = 0.5.into() => ["reflectance": SHARE];
        },
        /// A diffuse surface under a dielectric coat.
        CoatedDiffuse(CoatedDiffuseDesc) = "coateddiffuse",
        /// A metal under a dielectric coat.
        CoatedConductor(CoatedConductorDesc) = "coatedconductor",
        /// A metal.
        Conductor(ConductorDesc) = "conductor",
        /// Glass, water.
        Dielectric = "dielectric" {
            /// Index of refraction.
            eta: SpectrumDesc = 1.5.into() => ["eta": index_of_refraction()];
            /// Roughness of the interface.
            roughness: RoughnessDesc = RoughnessDesc::default() => ..;
        },
        /// A thin sheet of glass, both its sides in one surface.
        ThinDielectric = "thindielectric" {
            /// Index of refraction.
            eta: SpectrumDesc = 1.5.into() => ["eta": index_of_refraction()];
        },
        /// Lambertian reflection and transmission.
        DiffuseTransmission = "diffusetransmission" {
            /// Reflected share, 0 to 1.
            reflectance: SpectrumParameter = 0.25.into() => ["reflectance": SHARE];
            /// Transmitted share, 0 to 1.
            transmittance: SpectrumParameter = 0.25.into() => ["transmittance": SHARE];
            /// Factor on both.
            scale: f32 = 1.0 => ["scale"];
        },
        /// A fibre. `sigma_a` takes precedence over `reflectance`, and that over melanin.
        Hair = "hair" {
            /// Its absorption, given in one of three ways.
            color: HairColor = HairColor::default() => ..;
            /// Index of refraction.
            eta: FloatParameter = 1.55.into() => ["eta"];
            /// Longitudinal roughness, 0 to 1.
            beta_m: FloatParameter = 0.3.into() => ["beta_m": SHARE];
            /// Azimuthal roughness, 0 to 1.
            beta_n: FloatParameter = 0.3.into() => ["beta_n": SHARE];
            /// Tilt of the scales, degrees.
            alpha: FloatParameter = 2.0.into() => ["alpha"];
        },
        /// A translucent substance, by tabulated photon beam diffusion or a random walk.
        Subsurface = "subsurface" {
            /// The scattering inside, given in one of three ways.
            scattering: SubsurfaceScattering = SubsurfaceScattering::default() => ..;
            /// Factor on the coefficients (1/scene unit for coefficients in 1/mm).
            scale: f32 = 1.0 => ["scale"];
            /// Index of refraction.
            eta: f32 = 1.33 => ["eta"];
            /// Henyey–Greenstein asymmetry, −1 to 1.
            g: f32 = 0.0 => ["g": MEAN_COSINE];
            /// Roughness of the interface.
            roughness: RoughnessDesc = RoughnessDesc::default() => ..;
            /// How light is followed under the surface: by a diffusion profile, which holds for
            /// flat and thick bodies, or by a random walk.
            method: SubsurfaceMethod = SubsurfaceMethod::Diffusion => ["method"];
        },
        /// A measured surface of the RGL database.
        Measured = "measured" by hand {
            /// The measurements.
            table: Arc<MeasuredTable>;
        },
        /// A principled surface after OpenPBR Surface 1.1, with its names of parameters.
        OpenPbr(Box<OpenPbrDesc>) = "openpbr" [extension],
        /// One of two materials at each point, chosen at random.
        Mix = "mix" {
            /// The two materials; the first one of the scene, if they are not set.
            materials: [Handle<MaterialDesc>; 2] = [Handle::new(0); 2];
            /// Probability of the second.
            amount: FloatParameter = 0.5.into() => ["amount": SHARE];
        },
        /// No surface at all: a border of media.
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

settings! {
    /// Simulation of the layers of a coated material.
    #[derive(Clone, Debug, PartialEq)]
    pub struct LayersDesc {
        /// Optical thickness of the coat, 0 or more.
        thickness: FloatParameter = 0.01.into() => ["thickness"];
        /// Single-scattering albedo of the medium in the coat; with 0 it only absorbs.
        albedo: SpectrumParameter = 0.0.into() => ["albedo": SHARE];
        /// Henyey–Greenstein asymmetry of that medium, −1 to 1.
        g: FloatParameter = 0.0.into() => ["g": MEAN_COSINE];
        /// Maximum number of events of a random walk in the coat.
        max_depth: i32 = 10 => ["maxdepth": at_least(1.0)];
        /// Random walks averaged for each value.
        samples: i32 = 1 => ["nsamples": at_least(1.0)];
    }
}

settings! {
    /// A diffuse surface under a dielectric coat.
    #[derive(Clone, Debug, PartialEq)]
    pub struct CoatedDiffuseDesc {
        /// Reflected share of the surface, 0 to 1.
        reflectance: SpectrumParameter = 0.5.into() => ["reflectance": SHARE];
        /// Index of refraction of the coat.
        eta: SpectrumDesc = 1.5.into() => ["eta": index_of_refraction()];
        /// Roughness of the coat.
        roughness: RoughnessDesc = RoughnessDesc::default() => ..;
        /// The inside of the coat.
        layers: LayersDesc = LayersDesc::default() => ..;
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
            eta: 1.5.into(),
            roughness: RoughnessDesc::default(),
            layers: LayersDesc::default(),
        }
    }
}

/// The parameters of metal and coat have prefixes; one `remaproughness` is that of both.
impl Settings for CoatedConductorDesc {
    fn visit(&mut self, visitor: Visitor) {
        const METAL: &[Field; 3] = &conductor_fields!("conductor.");
        const ROUGHNESS: &[Field; 3] = &roughness_fields!("conductor.", " of the metal");
        const COAT: &[Field; 3] = &roughness_fields!("interface.", " of the coat");
        const ETA: &Field =
            &Field::new("interface.eta", "Index of refraction of the coat.").within(index_of_refraction());
        let Self { conductor, eta, roughness, layers } = self;
        conductor.reflectance.visit_as(METAL, visitor);
        conductor.roughness.visit_axes(ROUGHNESS, visitor);
        visitor(ETA, eta);
        roughness.visit_axes(COAT, visitor);
        let mut remap =
            if conductor.roughness.is_smooth() { roughness.remap } else { conductor.roughness.remap };
        visitor(REMAP, &mut remap);
        (conductor.roughness.remap, roughness.remap) = (remap, remap);
        layers.visit(visitor);
    }
}
