//! The graphics state: what applies to the following statements of a block.

use std::sync::Arc;

use description::{ColorSpaceDesc, Span, Spanned, TransformDesc};
use math::DMat4;

use super::parameter::RawParameter;

/// The current transform at the start and at the end of the shutter time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TransformSet(pub(crate) [DMat4; 2]);

impl TransformSet {
    pub(crate) const IDENTITY: Self = Self([DMat4::IDENTITY; 2]);

    pub(crate) fn inverse(self) -> Self {
        Self(self.0.map(|matrix| matrix.inverse()))
    }

    pub(crate) fn over(self, times: [f32; 2]) -> TransformDesc {
        TransformDesc { start: self.0[0], end: self.0[1], times }
    }
}

/// A material, referred to by its name or by its index among all materials of the scene.
#[derive(Clone, Debug)]
pub(crate) enum MaterialReference {
    Default,
    Named(Spanned<String>),
    Nth(u32),
}

/// Default parameters from `Attribute`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attributes {
    pub(crate) shape: Arc<Vec<RawParameter>>,
    pub(crate) light: Arc<Vec<RawParameter>>,
    pub(crate) material: Arc<Vec<RawParameter>>,
    pub(crate) medium: Arc<Vec<RawParameter>>,
    pub(crate) texture: Arc<Vec<RawParameter>>,
}

impl Attributes {
    pub(crate) const TARGETS: [&'static str; 5] = ["shape", "light", "material", "medium", "texture"];

    /// The list of a target.
    pub(crate) fn target(&mut self, name: &str) -> Option<&mut Arc<Vec<RawParameter>>> {
        Some(match name {
            "shape" => &mut self.shape,
            "light" => &mut self.light,
            "material" => &mut self.material,
            "medium" => &mut self.medium,
            "texture" => &mut self.texture,
            _ => return None,
        })
    }
}

/// What `AttributeBegin` saves and `AttributeEnd` restores.
#[derive(Clone, Debug)]
pub(crate) struct GraphicsState {
    pub(crate) ctm: TransformSet,
    /// Which of the two transforms are changed by transform directives.
    pub(crate) active: [bool; 2],
    pub(crate) reverse_orientation: bool,
    pub(crate) color_space: ColorSpaceDesc,
    pub(crate) material: MaterialReference,
    /// The area light of the following shapes, by its index among all.
    pub(crate) area_light: Option<u32>,
    /// Names of the media inside and outside; empty for none, absent if not set.
    pub(crate) medium_interface: Option<[Spanned<String>; 2]>,
    pub(crate) attributes: Attributes,
}

impl Default for GraphicsState {
    fn default() -> Self {
        Self {
            ctm: TransformSet::IDENTITY,
            active: [true; 2],
            reverse_orientation: false,
            color_space: ColorSpaceDesc::Srgb,
            material: MaterialReference::Default,
            area_light: None,
            medium_interface: None,
            attributes: Attributes::default(),
        }
    }
}

impl GraphicsState {
    /// Applies a change to the active transforms.
    pub(crate) fn change_ctm(&mut self, change: impl Fn(DMat4) -> DMat4) {
        for (matrix, active) in self.ctm.0.iter_mut().zip(self.active) {
            if active {
                *matrix = change(*matrix);
            }
        }
    }

    /// The name of the medium outside.
    pub(crate) fn outside(&self) -> Option<Spanned<String>> {
        self.medium_interface.as_ref().map(|[_, outside]| outside.clone())
    }
}

/// What opened a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BlockKind {
    Attribute,
    Object,
}

impl BlockKind {
    pub(crate) fn begin(self) -> &'static str {
        match self {
            Self::Attribute => "AttributeBegin",
            Self::Object => "ObjectBegin",
        }
    }

    pub(crate) fn end(self) -> &'static str {
        match self {
            Self::Attribute => "AttributeEnd",
            Self::Object => "ObjectEnd",
        }
    }
}

/// An open block and the state to restore at its end.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) kind: BlockKind,
    pub(crate) span: Span,
    pub(crate) state: GraphicsState,
}
