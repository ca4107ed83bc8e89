//! The description of a scene: plain typed data as given by its author, without derived data.
//!
//! Importers fill a [`SceneDesc`] from files; tests and other programs can build one directly:
//! [`SceneDesc::default`] is a valid empty scene, and everything else is pushed into its arenas.
//!
//! All families have the same structure: `XDesc` holds the parameters that all members share, and
//! its field `kind`, an `XKind`, is the member with its own parameters. Defaults are those of the
//! pbrt-v4 format.
//!
//! All of the format can be described, including features that are not supported yet.

mod accelerator;
mod arena;
mod camera;
mod color;
mod diagnostic;
mod film;
mod filter;
mod image;
mod imported;
mod inside;
mod integrator;
mod light;
mod material;
mod medium;
mod microsurface;
mod open_pbr;
mod options;
mod sampler;
mod scene;
pub mod schema;
mod shape;
mod source;
mod substance;
mod suggest;
mod texture;
mod transform;
mod voxels;

pub use self::image::ImageDesc;
pub use ::image::EdgeMode;
pub use accelerator::{AcceleratorDesc, BuildQualityDesc, BvhSplit};
pub use arena::{Arena, Handle, Origin, Stated};
pub use camera::{
    ApertureDesc, CameraDesc, CameraKind, LensDesc, LensElement, RealisticCameraDesc, ScreenDesc,
    SphericalMapping,
};
pub use color::{ColorSpaceDesc, SpectrumDesc};
pub use diagnostic::{Diagnostic, DiagnosticList, Severity};
pub use film::{FilmDesc, FilmKind, GBufferSpace, SensorDesc};
pub use filter::FilterDesc;
pub use imported::Imported;
pub use inside::{HairColor, SubsurfaceScattering};
pub use integrator::{
    AmbientOcclusionDesc, BdptDesc, Connected, FormFactorsDesc, FunctionDesc, FunctionKind, IntegratorDesc,
    IntegratorFacts, LightSamplerDesc, LightTracingDesc, MltDesc, MltTechnique, PathDesc, PhotonKernel,
    PhotonMappingDesc, PhotonMappingShow, RadiosityDesc, RandomWalkDesc, ReflectionsDesc, SimplePathDesc,
    SimpleVolPathDesc, SppmDesc, VcmDesc, WhittedDesc, merging_radius,
};
pub use light::{AreaLightDesc, InfiniteRadiance, LightDesc, LightKind, LightType};
pub use material::{
    CoatedConductorDesc, CoatedDiffuseDesc, LayersDesc, MaterialDesc, MaterialKind, MaterialType,
};
pub use medium::{
    CoefficientsDesc, GridDesc, MediumDesc, MediumInterface, MediumKind, MediumType, TemperatureDesc,
};
pub use microsurface::{ConductorDesc, ConductorReflectance, RoughnessDesc};
pub use open_pbr::{OpenPbrDesc, OpenPbrNumber};
pub use options::{Engine, OptionsDesc, RenderSpace, Schedule};
pub use sampler::{HaltonRandomization, Randomization, SamplerDesc, SamplerKind};
pub use scene::SceneDesc;
pub use shape::{
    CurveBasis, CurveDesc, CurveProfile, InstanceDesc, MeshDesc, MeshKey, ObjectDesc, PatchMeshDesc,
    ShapeDesc, ShapeKind, ShapeTraits, ShapeType, SolidOperation, SpheresDesc,
};
pub use source::{FileId, Position, SourceMap, Span, Spanned};
pub use substance::Substance;
pub use suggest::{closest, did_you_mean};
pub use texture::{
    EncodingDesc, FloatParameter, FloatTextureDesc, ImageChannel, ImageTextureDesc, MappingDesc, Parameter,
    SpectrumParameter, SpectrumTextureDesc, TextureDesc, TextureFilter, TextureKind, TextureType,
    TextureValue, UvImageDesc, UvImageNames, WrapMode,
};
pub use transform::TransformDesc;
pub use voxels::VoxelsDesc;
