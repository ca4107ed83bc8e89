//! What can be changed of a scene while it is shown: lights and materials, as far as they are
//! constants.

use alhazen::description::{
    ColorSpaceDesc, ConductorReflectance, FloatParameter, InfiniteRadiance, LightKind, MaterialKind,
    OpenPbrDesc, Parameter, RoughnessDesc, SceneDesc, Span, SpectrumDesc, SpectrumParameter,
};
use alhazen::scene::texture::{SpectrumType, compile_spectrum};
use alhazen::spectrum::{DenselySampled, RgbColorSpace, Spectrum};

/// A thing with what can be changed of it.
pub struct Thing<'a> {
    /// Its name, or its kind and number.
    pub name: String,
    /// What can be changed.
    pub knobs: Vec<Knob<'a>>,
}

/// A value that can be changed.
pub struct Knob<'a> {
    /// What it is.
    pub label: &'static str,
    /// The value.
    pub value: Value<'a>,
}

/// The value of a knob.
pub enum Value<'a> {
    /// A colour, whose parts are from 0 to 1.
    Color(ColorKnob<'a>),
    /// The colour of a light, which has no upper limit.
    Light(ColorKnob<'a>),
    /// A factor of 0 or more.
    Scale(&'a mut f32),
    /// A number from 0 to 1.
    Share(&'a mut f32),
}

/// A spectrum as a colour.
pub struct ColorKnob<'a> {
    spectrum: &'a mut SpectrumDesc,
    is_light: bool,
}

impl ColorKnob<'_> {
    /// Linear red, green and blue; of a measured spectrum those of the colour that it looks like,
    /// in sRGB.
    pub fn rgb(&self) -> [f32; 3] {
        match *self.spectrum {
            SpectrumDesc::Constant(value) if !self.is_light => [value; 3],
            SpectrumDesc::Rgb { rgb, .. } => rgb,
            SpectrumDesc::Illuminant(_) => [1.0; 3],
            _ => self.looks_like(),
        }
    }

    /// Replaces the spectrum by a colour, in the colour space that it has.
    pub fn set(&mut self, rgb: [f32; 3]) {
        let space = match *self.spectrum {
            SpectrumDesc::Rgb { space, .. } | SpectrumDesc::Illuminant(space) => space,
            _ => ColorSpaceDesc::Srgb,
        };
        *self.spectrum = SpectrumDesc::Rgb { rgb, space };
    }

    /// The colour of a light of the luminance 1, or of a surface in white light.
    fn looks_like(&self) -> [f32; 3] {
        let (space, kind) = (RgbColorSpace::srgb(), SpectrumType::Unbounded);
        let spectrum = compile_spectrum(self.spectrum, kind, Span::NONE, &mut Vec::new());
        let white = space.illuminant();
        let (xyz, luminance) = if self.is_light {
            let xyz = spectrum.to_xyz();
            (xyz, xyz.y)
        } else {
            let reflected = DenselySampled::from_fn(|lambda| spectrum.at(lambda) * white.at(lambda));
            (Spectrum::from(reflected).to_xyz(), white.to_xyz().y)
        };
        let rgb = space.to_rgb(xyz).to_array();
        rgb.map(|part| (part / luminance.max(f32::MIN_POSITIVE)).max(0.0))
    }
}

/// The lights, first those that are not surfaces.
pub fn lights(desc: &mut SceneDesc) -> Vec<Thing<'_>> {
    let lights = desc.lights.iter_mut().map(|(handle, light)| {
        let light = &mut light.value;
        let name = format!("{} light {}", light.kind.name(), handle.index() + 1);
        let color = match &mut light.kind {
            LightKind::Point { intensity, .. }
            | LightKind::Spot { intensity, .. }
            | LightKind::Goniometric { intensity, .. } => Some(intensity),
            LightKind::Distant { radiance, .. }
            | LightKind::Infinite { radiance: InfiniteRadiance::Constant(radiance), .. } => Some(radiance),
            LightKind::Projection { .. } | LightKind::Infinite { .. } => None,
        };
        Thing { name, knobs: light_knobs(color, &mut light.scale) }
    });
    let surfaces = desc.area_lights.iter_mut().map(|(handle, light)| {
        let light = &mut light.value;
        let color = light.image.is_none().then_some(&mut light.radiance);
        let name = format!("area light {}", handle.index() + 1);
        Thing { name, knobs: light_knobs(color, &mut light.scale) }
    });
    lights.chain(surfaces).collect()
}

fn light_knobs<'a>(color: Option<&'a mut SpectrumDesc>, scale: &'a mut f32) -> Vec<Knob<'a>> {
    let color = color.map(|spectrum| {
        let value = Value::Light(ColorKnob { spectrum, is_light: true });
        Knob { label: "colour", value }
    });
    color.into_iter().chain([Knob { label: "scale", value: Value::Scale(scale) }]).collect()
}

/// The materials that have something to change.
pub fn materials(desc: &mut SceneDesc) -> Vec<Thing<'_>> {
    let things = desc.materials.iter_mut().map(|(handle, material)| {
        let material = &mut material.value;
        let name = match material.name.as_str() {
            // As the paths of a pixel call it.
            "" => format!("material-{} ({})", handle.index(), material.kind.name()),
            name => name.to_owned(),
        };
        Thing { name, knobs: material_knobs(&mut material.kind) }
    });
    things.filter(|thing| !thing.knobs.is_empty()).collect()
}

fn material_knobs(kind: &mut MaterialKind) -> Vec<Knob<'_>> {
    let mut knobs = Vec::new();
    match kind {
        MaterialKind::Diffuse { reflectance } => color(&mut knobs, "reflectance", reflectance),
        MaterialKind::DiffuseTransmission { reflectance, transmittance, .. } => {
            color(&mut knobs, "reflectance", reflectance);
            color(&mut knobs, "transmittance", transmittance);
        }
        MaterialKind::Conductor(metal) => {
            metal_color(&mut knobs, &mut metal.reflectance);
            roughness(&mut knobs, &mut metal.roughness);
        }
        MaterialKind::Dielectric { roughness: rough, .. }
        | MaterialKind::Subsurface { roughness: rough, .. } => {
            roughness(&mut knobs, rough);
        }
        MaterialKind::CoatedDiffuse(coated) => {
            color(&mut knobs, "reflectance", &mut coated.reflectance);
            roughness(&mut knobs, &mut coated.roughness);
        }
        MaterialKind::CoatedConductor(coated) => {
            metal_color(&mut knobs, &mut coated.conductor.reflectance);
            roughness(&mut knobs, &mut coated.conductor.roughness);
        }
        MaterialKind::OpenPbr(principled) => {
            let OpenPbrDesc { numbers, colors, .. } = &mut **principled;
            for ((field, _), value) in OpenPbrDesc::COLORS.iter().zip(colors) {
                if field.name == "base_color" {
                    color(&mut knobs, field.name, value);
                }
            }
            for (number, value) in OpenPbrDesc::NUMBERS.iter().zip(numbers) {
                if matches!(
                    number.field.name,
                    "base_metalness" | "specular_roughness" | "transmission_weight"
                ) {
                    share(&mut knobs, number.field.name, value);
                }
            }
        }
        MaterialKind::Mix { amount, .. } => share(&mut knobs, "amount", amount),
        MaterialKind::ThinDielectric { .. }
        | MaterialKind::Hair { .. }
        | MaterialKind::Measured { .. }
        | MaterialKind::Interface => (),
    }
    knobs
}

fn color<'a>(knobs: &mut Vec<Knob<'a>>, label: &'static str, parameter: &'a mut SpectrumParameter) {
    if let Parameter::Value(spectrum) = parameter {
        let value = Value::Color(ColorKnob { spectrum, is_light: false });
        knobs.push(Knob { label, value });
    }
}

fn metal_color<'a>(knobs: &mut Vec<Knob<'a>>, reflectance: &'a mut ConductorReflectance) {
    if let ConductorReflectance::Reflectance(parameter) = reflectance {
        color(knobs, "reflectance", parameter);
    }
}

fn roughness<'a>(knobs: &mut Vec<Knob<'a>>, roughness: &'a mut RoughnessDesc) {
    share(knobs, "roughness u", &mut roughness.u);
    share(knobs, "roughness v", &mut roughness.v);
}

fn share<'a>(knobs: &mut Vec<Knob<'a>>, label: &'static str, parameter: &'a mut FloatParameter) {
    if let Parameter::Value(value) = parameter {
        knobs.push(Knob { label, value: Value::Share(value) });
    }
}
