//! Editable parameters of a scene that is shown: numbers and colours of lights and materials, as
//! far as they are constants. The declarations of their parameters say which there are.

use alhazen::description::schema::{self, Field, Settings, Slot};
use alhazen::description::{ColorSpaceDesc, SceneDesc, Span, SpectrumDesc};
use alhazen::scene::texture::{SpectrumType, compile_spectrum};
use alhazen::spectrum::{DenselySampled, RgbColorSpace, Spectrum};

/// A light or a material.
pub struct Thing<'a> {
    /// Its name, or its kind and number.
    pub name: String,
    settings: &'a mut dyn Settings,
    is_light: bool,
    /// A parameter that has no effect.
    hidden: &'static str,
}

/// A value that can be changed.
pub struct Knob<'a> {
    /// Its declaration.
    pub field: &'static Field,
    /// The value.
    pub value: Value,
    slot: &'a mut dyn Slot,
}

/// The value of a knob.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A colour, whose parts are from 0 to 1.
    Color([f32; 3]),
    /// A colour that has no upper limit.
    Light([f32; 3]),
    /// A number.
    Number(f32),
}

/// The lights, first those that are not surfaces.
pub fn lights(desc: &mut SceneDesc) -> Vec<Thing<'_>> {
    let lights = desc.lights.iter_mut().map(|(handle, light)| {
        let name = format!("{} light {}", light.kind.name(), handle.index() + 1);
        Thing { name, settings: &mut light.value, is_light: true, hidden: "" }
    });
    let surfaces = desc.area_lights.iter_mut().map(|(handle, light)| {
        let name = format!("area light {}", handle.index() + 1);
        let hidden = if light.image.is_some() { "L" } else { "" };
        Thing { name, settings: &mut light.value, is_light: true, hidden }
    });
    lights.chain(surfaces).collect()
}

/// The materials that have something to change.
pub fn materials(desc: &mut SceneDesc) -> Vec<Thing<'_>> {
    let things = desc.materials.iter_mut().map(|(handle, material)| {
        let name = match material.name.as_str() {
            // As the paths of a pixel call it.
            "" => format!("material-{} ({})", handle.index(), material.kind.name()),
            name => name.to_owned(),
        };
        Thing { name, settings: &mut material.value.kind, is_light: false, hidden: "" }
    });
    let has_knobs = |thing: &mut Thing| {
        let mut count = 0;
        thing.visit(|_| count += 1);
        count > 0
    };
    things.filter_map(|mut thing| has_knobs(&mut thing).then_some(thing)).collect()
}

impl Thing<'_> {
    /// Calls a function for each value that can be changed.
    pub fn visit(&mut self, mut visitor: impl FnMut(Knob)) {
        self.settings.visit(&mut |field, slot| {
            if field.name != self.hidden
                && let Some(value) = value(field, &slot.get(), self.is_light)
            {
                visitor(Knob { field, value, slot });
            }
        });
    }
}

impl Knob<'_> {
    /// Replaces the value, if the new one is allowed. A colour is in the colour space that the
    /// spectrum had.
    pub fn set(&mut self, value: Value) {
        let value = match (value, self.slot.get()) {
            (Value::Number(number), schema::Value::Spectrum(_)) => schema::Value::Spectrum(number.into()),
            (Value::Number(number), _) => schema::Value::Number(number),
            (Value::Color(rgb) | Value::Light(rgb), before) => {
                use SpectrumDesc::{Illuminant, Rgb};
                let space = match before {
                    schema::Value::Spectrum(Rgb { space, .. } | Illuminant(space)) => space,
                    _ => ColorSpaceDesc::Srgb,
                };
                schema::Value::Spectrum(Rgb { rgb, space })
            }
        };
        // Of a value that is not allowed nothing follows: the control shows the one before.
        self.field.assign(self.slot, &value).ok();
    }
}

/// The value of a parameter, if it can be changed.
fn value(field: &Field, value: &schema::Value, is_light: bool) -> Option<Value> {
    let is_share = field.domain.bounds()[1] <= 1.0;
    match value {
        schema::Value::Number(number) => Some(Value::Number(*number)),
        schema::Value::Spectrum(SpectrumDesc::Constant(number)) if field.domain.is_index => {
            Some(Value::Number(*number))
        }
        schema::Value::Spectrum(_) if field.domain.is_index => None,
        schema::Value::Spectrum(spectrum) if is_share => Some(Value::Color(rgb(spectrum, is_light))),
        schema::Value::Spectrum(spectrum) => Some(Value::Light(rgb(spectrum, is_light))),
        _ => None,
    }
}

/// Linear red, green and blue; of a measured spectrum those of the colour that it looks like, in
/// sRGB.
fn rgb(spectrum: &SpectrumDesc, is_light: bool) -> [f32; 3] {
    match *spectrum {
        SpectrumDesc::Constant(value) if !is_light => [value; 3],
        SpectrumDesc::Rgb { rgb, .. } => rgb,
        SpectrumDesc::Illuminant(_) => [1.0; 3],
        _ => looks_like(spectrum, is_light),
    }
}

/// The colour of a light of the luminance 1, or of a surface in white light.
fn looks_like(spectrum: &SpectrumDesc, is_light: bool) -> [f32; 3] {
    let (space, kind) = (RgbColorSpace::srgb(), SpectrumType::Unbounded);
    let spectrum = compile_spectrum(spectrum, kind, Span::NONE, &mut Vec::new());
    let white = space.illuminant();
    let (xyz, luminance) = if is_light {
        let xyz = spectrum.to_xyz();
        (xyz, xyz.y)
    } else {
        let reflected = DenselySampled::from_fn(|lambda| spectrum.at(lambda) * white.at(lambda));
        (Spectrum::from(reflected).to_xyz(), white.to_xyz().y)
    };
    let rgb = space.to_rgb(xyz).to_array();
    rgb.map(|part| (part / luminance.max(f32::MIN_POSITIVE)).max(0.0))
}
