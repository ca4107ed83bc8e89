//! Surfaces: what shapes are of.

use description::{
    AreaLightDesc, FloatParameter, Handle, MaterialDesc, MediumInterface, OpenPbrDesc, SpectrumParameter,
};
use math::DAffine2;

/// A surface of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    pub material: Handle<MaterialDesc>,
    pub area_light: Option<Handle<AreaLightDesc>>,
    pub alpha: Option<FloatParameter>,
    pub media: Option<MediumInterface>,
    /// Whether the camera sees its front alone.
    pub single_sided: bool,
    /// The coordinates that meshes have.
    pub coordinates: Coordinates,
    /// By how much tangents are turned, counter-clockwise.
    pub tangent_rotation: f32,
}

/// Which texture coordinates of a file those of a mesh are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coordinates {
    pub set: usize,
    /// From those of the file with v up.
    pub transform: DAffine2,
}

/// A principled surface whose parameters are set by name.
#[derive(Default)]
pub(crate) struct Principled {
    pub desc: Box<OpenPbrDesc>,
}

impl Principled {
    pub fn number(&mut self, name: &str, value: FloatParameter) {
        let index = OpenPbrDesc::number(name);
        self.desc.numbers[index.expect("invariant: a name of OpenPBR")] = value;
    }

    pub fn color(&mut self, name: &str, value: SpectrumParameter) {
        let index = OpenPbrDesc::color(name);
        self.desc.colors[index.expect("invariant: a name of OpenPBR")] = value;
    }
}
