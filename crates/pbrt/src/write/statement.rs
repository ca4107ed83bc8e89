//! A statement of the format: its head and its parameters, of which those that have the format's
//! default are left out.

use description::{ColorSpaceDesc, FloatParameter, Parameter, SpectrumDesc};
use math::{Vec2, Vec3};

use crate::write::names::Names;
use crate::write::number::decimal;

/// The ends of the visible wavelengths, between which a constant spectrum is written.
const VISIBLE: [f32; 2] = [360.0, 830.0];

/// A parameter with its values.
pub(crate) struct Written {
    /// Its type and name.
    pub(crate) declaration: String,
    pub(crate) values: Vec<String>,
    /// The colour space that its values are in, if they are in one.
    pub(crate) space: Option<ColorSpaceDesc>,
}

/// A statement.
pub(crate) struct Statement {
    /// The directive, with the names that follow it.
    pub(crate) head: String,
    pub(crate) parameters: Vec<Written>,
    /// The colour space that must be in force for what is left out, if it matters.
    pub(crate) space: Option<ColorSpaceDesc>,
    /// What the format calls statements of its kind where it gives them defaults.
    pub(crate) target: &'static str,
    /// Why it cannot be written.
    pub(crate) problem: Option<String>,
}

/// A text in quotes.
pub(crate) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            '\n' => quoted += "\\n",
            '\r' => quoted += "\\r",
            '\t' => quoted += "\\t",
            _ => quoted.push(character),
        }
    }
    quoted + "\""
}

impl Statement {
    /// A directive and its type.
    pub(crate) fn new(directive: &str, kind: &str) -> Self {
        let head = format!("{directive} {}", quoted(kind));
        Self { head, parameters: Vec::new(), space: None, target: "", problem: None }
    }

    /// A statement that names something; its type is a parameter.
    pub(crate) fn named(directive: &str, name: &str, kind: &str) -> Self {
        let mut statement = Self::new(directive, name);
        statement.text("type", kind);
        statement
    }

    /// Sets what the format calls statements of its kind where it gives them defaults.
    pub(crate) fn target(self, target: &'static str) -> Self {
        Self { target, ..self }
    }

    /// Notes why it cannot be written.
    pub(crate) fn fail(&mut self, problem: impl Into<String>) {
        self.problem.get_or_insert(problem.into());
    }

    pub(crate) fn push(&mut self, kind: &str, name: &str, values: Vec<String>) {
        self.parameters.push(Written { declaration: format!("{kind} {name}"), values, space: None });
    }

    pub(crate) fn integer(&mut self, name: &str, value: i32, default: i32) {
        if value != default {
            self.integers(name, [value]);
        }
    }

    pub(crate) fn integers(&mut self, name: &str, values: impl IntoIterator<Item = i32>) {
        self.push("integer", name, values.into_iter().map(|value| value.to_string()).collect());
    }

    /// The corners of faces.
    pub(crate) fn indices<const N: usize>(&mut self, faces: &[[u32; N]]) {
        self.push("integer", "indices", faces.as_flattened().iter().map(u32::to_string).collect());
    }

    /// Numbers of a type.
    fn numbers(&mut self, kind: &str, name: &str, values: impl IntoIterator<Item = f32>) {
        let values: Vec<f32> = values.into_iter().collect();
        if values.iter().any(|value| !value.is_finite()) {
            self.fail(format!("`{name}` has a value that is not finite"));
        }
        self.push(kind, name, values.into_iter().map(decimal).collect());
    }

    pub(crate) fn float(&mut self, name: &str, value: f32, default: f32) {
        if value.to_bits() != default.to_bits() {
            self.floats(name, [value]);
        }
    }

    pub(crate) fn floats(&mut self, name: &str, values: impl IntoIterator<Item = f32>) {
        self.numbers("float", name, values);
    }

    /// Points, vectors or normals.
    pub(crate) fn triples(&mut self, kind: &str, name: &str, values: &[Vec3]) {
        self.numbers(kind, name, values.iter().flat_map(|value| value.to_array()));
    }

    /// Points of the plane, if there are any.
    pub(crate) fn pairs(&mut self, name: &str, values: &[Vec2]) {
        if !values.is_empty() {
            self.numbers("point2", name, values.iter().flat_map(|value| [value.x, value.y]));
        }
    }

    pub(crate) fn text(&mut self, name: &str, value: &str) {
        self.texts(name, [value]);
    }

    pub(crate) fn texts<'a>(&mut self, name: &str, values: impl IntoIterator<Item = &'a str>) {
        self.push("string", name, values.into_iter().map(quoted).collect());
    }

    /// A text, unless it is the default.
    pub(crate) fn choice(&mut self, name: &str, value: &str, default: &str) {
        if value != default {
            self.text(name, value);
        }
    }

    /// Colours in a space.
    pub(crate) fn colors(&mut self, name: &str, colors: &[[f32; 3]], space: ColorSpaceDesc) {
        self.numbers("rgb", name, colors.as_flattened().iter().copied());
        if let Some(last) = self.parameters.last_mut() {
            last.space = Some(space);
        }
    }

    /// A spectrum.
    pub(crate) fn spectrum(&mut self, name: &str, spectrum: &SpectrumDesc) {
        match spectrum {
            // What is read as a constant again.
            SpectrumDesc::Constant(value) => {
                self.numbers("spectrum", name, VISIBLE.into_iter().flat_map(|lambda| [lambda, *value]));
            }
            SpectrumDesc::Rgb { rgb, space } => self.colors(name, &[*rgb], *space),
            SpectrumDesc::Named(known) => self.push("spectrum", name, vec![quoted(known)]),
            SpectrumDesc::Samples(pairs) => {
                self.numbers("spectrum", name, pairs.iter().flat_map(|&(lambda, value)| [lambda, value]));
            }
            SpectrumDesc::Blackbody(kelvin) => self.numbers("blackbody", name, [*kelvin]),
            SpectrumDesc::Illuminant(space) => {
                let white = match space {
                    ColorSpaceDesc::Aces2065_1 => "illum-acesD60",
                    ColorSpaceDesc::Srgb | ColorSpaceDesc::DciP3 | ColorSpaceDesc::Rec2020 => "stdillum-D65",
                };
                self.push("spectrum", name, vec![quoted(white)]);
            }
        }
    }

    /// A spectrum whose default is the white of the colour space in force.
    pub(crate) fn white_or(&mut self, name: &str, spectrum: &SpectrumDesc) {
        match spectrum {
            SpectrumDesc::Illuminant(space) => self.space = Some(*space),
            spectrum => self.spectrum(name, spectrum),
        }
    }

    /// A number or a texture that has no default.
    pub(crate) fn optional_float_parameter(
        &mut self,
        name: &str,
        value: Option<&FloatParameter>,
        names: &Names,
    ) {
        match value {
            Some(Parameter::Value(value)) => self.floats(name, [*value]),
            Some(Parameter::Texture(texture)) => {
                self.push("texture", name, vec![quoted(names.float_texture(*texture))]);
            }
            None => (),
        }
    }
}
