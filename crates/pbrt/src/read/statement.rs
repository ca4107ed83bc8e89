//! The statements of a scene, each with its graphics state. Names are not resolved yet: a file may
//! use a material before its definition.

use std::collections::HashMap;
use std::sync::Arc;

use description::{ColorSpaceDesc, Span, Spanned, TransformDesc};
use math::DMat4;

use super::parameter::RawParameter;
use super::state::{MaterialReference, TransformSet};

/// A statement of a type and its parameters.
#[derive(Clone, Debug)]
pub(crate) struct Statement {
    /// The directive with its type and parameters.
    pub(crate) span: Span,
    /// The type.
    pub(crate) kind: Spanned<String>,
    /// The given parameters.
    pub(crate) parameters: Vec<RawParameter>,
    /// Defaults of parameters that are not given, from `Attribute`.
    pub(crate) defaults: Arc<Vec<RawParameter>>,
    /// The current colour space.
    pub(crate) color_space: ColorSpaceDesc,
}

#[derive(Clone, Debug)]
pub(crate) struct CameraStatement {
    pub(crate) statement: Statement,
    pub(crate) camera_from_world: TransformSet,
    pub(crate) medium: Option<Spanned<String>>,
}

#[derive(Clone, Debug)]
pub(crate) struct TextureStatement {
    pub(crate) statement: Statement,
    pub(crate) name: Spanned<String>,
    pub(crate) world_from_texture: DMat4,
}

#[derive(Clone, Debug)]
pub(crate) struct MaterialStatement {
    pub(crate) statement: Statement,
    /// Absent for `Material`.
    pub(crate) name: Option<Spanned<String>>,
}

#[derive(Clone, Debug)]
pub(crate) struct MediumStatement {
    pub(crate) statement: Statement,
    pub(crate) name: Spanned<String>,
    pub(crate) world_from_medium: TransformDesc,
}

#[derive(Clone, Debug)]
pub(crate) struct LightStatement {
    pub(crate) statement: Statement,
    pub(crate) world_from_light: TransformDesc,
    pub(crate) medium: Option<Spanned<String>>,
}

#[derive(Clone, Debug)]
pub(crate) struct ShapeStatement {
    pub(crate) statement: Statement,
    pub(crate) world_from_object: TransformDesc,
    pub(crate) reverse_orientation: bool,
    pub(crate) material: MaterialReference,
    pub(crate) area_light: Option<u32>,
    pub(crate) medium_interface: Option<[Spanned<String>; 2]>,
}

#[derive(Clone, Debug)]
pub(crate) struct ObjectStatement {
    pub(crate) name: Spanned<String>,
    pub(crate) shapes: Vec<ShapeStatement>,
    pub(crate) instances: Vec<InstanceStatement>,
}

#[derive(Clone, Debug)]
pub(crate) struct InstanceStatement {
    pub(crate) object: Spanned<String>,
    pub(crate) span: Span,
    pub(crate) world_from_object: TransformDesc,
}

/// All statements of a scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct Statements {
    pub(crate) options: Vec<RawParameter>,
    pub(crate) film: Option<Statement>,
    pub(crate) camera: Option<CameraStatement>,
    pub(crate) sampler: Option<Statement>,
    pub(crate) filter: Option<Statement>,
    pub(crate) integrator: Option<Statement>,
    pub(crate) accelerator: Option<Statement>,
    /// Parameters of `Attribute`, by name and declaration.
    pub(crate) attributes: Vec<Spanned<String>>,
    pub(crate) transform_times: Option<[f32; 2]>,
    pub(crate) float_textures: Vec<TextureStatement>,
    pub(crate) spectrum_textures: Vec<TextureStatement>,
    /// The order of all textures: `true` for a spectrum texture.
    pub(crate) texture_order: Vec<bool>,
    /// Where each texture is named; `true` for a spectrum texture.
    pub(crate) texture_names: HashMap<(bool, String), Span>,
    pub(crate) materials: Vec<MaterialStatement>,
    pub(crate) media: Vec<MediumStatement>,
    pub(crate) lights: Vec<LightStatement>,
    pub(crate) area_lights: Vec<Statement>,
    pub(crate) shapes: Vec<ShapeStatement>,
    pub(crate) objects: Vec<ObjectStatement>,
    pub(crate) instances: Vec<InstanceStatement>,
}
