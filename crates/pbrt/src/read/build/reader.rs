//! Reads the parameters of one statement by name and type, and records the names that were looked
//! up: a parameter that was not is an error, and the recorded names are the candidates for its
//! correction.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::sync::Arc;

use bytemuck::allocation::try_cast_slice_arc;
use description::schema::{Field, Kind, SettingType, Settings, Value};
use description::{
    ColorSpaceDesc, Diagnostic, EncodingDesc, FloatParameter, Handle, ImageDesc, Origin, Parameter, Span,
    Spanned, SpectrumDesc, SpectrumParameter,
};
use math::{Vec2, Vec3};

use super::Builder;
use super::asked::{Asked, Listed, Within};
use crate::read::names;
use crate::read::parameter::{ParameterType, RawParameter, Values};
use crate::read::statement::Statement;
use description::{closest, did_you_mean};

/// Reads the parameters of a statement.
pub(crate) struct Reader<'b, 'a> {
    pub(crate) builder: &'b mut Builder<'a>,
    pub(crate) span: Span,
    pub(crate) kind: Spanned<String>,
    pub(crate) color_space: ColorSpaceDesc,
    pub(super) given: Vec<Given>,
    pub(super) asked: Vec<Asked>,
    origin: Origin,
}

/// A parameter that was given.
pub(super) struct Given {
    pub(super) parameter: RawParameter,
    used: bool,
    /// It comes from `Attribute`; being unused is no error.
    default: bool,
}

impl<'b, 'a> Reader<'b, 'a> {
    pub(crate) fn new(builder: &'b mut Builder<'a>, statement: Statement) -> Self {
        let mut given: Vec<Given> = Vec::with_capacity(statement.parameters.len());
        given.extend(statement.parameters.into_iter().map(|parameter| Given {
            parameter,
            used: false,
            default: false,
        }));
        for parameter in statement.defaults.iter() {
            if given.iter().all(|earlier| earlier.parameter.name != parameter.name) {
                given.push(Given { parameter: parameter.clone(), used: false, default: true });
            }
        }
        Self {
            builder,
            span: statement.span,
            kind: statement.kind,
            color_space: statement.color_space,
            given,
            asked: Vec::new(),
            origin: Origin::new(statement.span),
        }
    }

    /// Reports every parameter that was not looked up; returns the spans of statement and
    /// parameters.
    pub(crate) fn finish(self) -> Origin {
        for Given { parameter, used, default } in &self.given {
            if *used || *default {
                continue;
            }
            let name = parameter.name.as_str();
            let message = format!("`{}` has no parameter `{name}`", self.kind.value);
            let known = self.asked.iter().map(|asked| asked.name);
            let diagnostic = match (closest(name, known.clone()), names::replaced("parameter", name)) {
                (None, Some(replacement)) => Diagnostic::error("old-name", message, parameter.declaration)
                    .with_help(format!("`{name}` {replacement}")),
                _ => Diagnostic {
                    help: did_you_mean(name, known),
                    ..Diagnostic::error("unknown-parameter", message, parameter.declaration)
                },
            };
            self.builder.report.push(diagnostic);
        }
        self.origin
    }

    /// [`Reader::finish`] without the report, where the type of the statement is not known.
    pub(crate) fn abandon(self) -> Origin {
        self.origin
    }

    /// Reports an unknown type.
    pub(crate) fn unknown_type(&mut self, set: &str, what: &str, known: &[&str]) {
        let Spanned { value, span } = self.kind.clone();
        let message = format!("there is no {what} `{value}`");
        self.builder.report.push(match names::replaced(set, &value) {
            Some(replacement) => Diagnostic::error("old-name", message, span).with_help(replacement),
            None => Diagnostic {
                help: did_you_mean(&value, known.iter().copied()),
                ..Diagnostic::error("unknown-type", message, span)
            },
        });
    }

    /// The index of the parameter of a name, if it is given with one of the types; any other type
    /// is reported.
    pub(super) fn find(&mut self, name: &'static str, types: &'static [ParameterType]) -> Option<usize> {
        self.asked.push(Asked::new(name, types));
        let index = self.given.iter().position(|given| given.parameter.name == name)?;
        let given = &mut self.given[index];
        let already = std::mem::replace(&mut given.used, true);
        given.parameter.adopt(types);
        let parameter = &given.parameter;
        if !types.contains(&parameter.kind) {
            if given.default {
                given.used = already;
                return None;
            }
            let expected: Vec<_> = types.iter().map(|kind| format!("`{}`", kind.name())).collect();
            let message =
                format!("`{name}` is of type {}, not `{}`", expected.join(" or "), parameter.kind.name());
            let error = Diagnostic::error("parameter-type", message, parameter.declaration);
            self.builder.report.push(match parameter.is_typed {
                true => error.with_help(format!("write `\"{} {name}\"`", types[0].name())),
                false => error,
            });
            return None;
        }
        if given.default {
            self.builder.used_attributes.insert(parameter.declaration);
        }
        self.origin.parameters.push((name, parameter.span));
        Some(index)
    }

    /// The values of a parameter, taken out of it, if there is any value.
    fn take(
        &mut self,
        name: &'static str,
        types: &'static [ParameterType],
    ) -> Option<(ParameterType, Values, Span)> {
        let index = self.find(name, types)?;
        self.take_at(index, name)
    }

    /// [`Self::take`] for the parameter of an index.
    pub(super) fn take_at(&mut self, index: usize, name: &str) -> Option<(ParameterType, Values, Span)> {
        let parameter = &mut self.given[index].parameter;
        let values = std::mem::replace(&mut parameter.values, Values::Bools(Vec::new()));
        let (kind, span, length) = (parameter.kind, parameter.span, values.len());
        if let Values::Floats(floats) = &values
            && floats.iter().any(|value| !value.is_finite())
        {
            self.builder.report.error(
                "parameter-value",
                format!("`{name}` has a value that is not finite"),
                span,
            );
            return None;
        }
        if kind != ParameterType::Spectrum && length % kind.arity() != 0 {
            let message = match kind {
                ParameterType::Rgb => {
                    format!("`{name}` has {length} numbers; a colour has three: linear red, green and blue")
                }
                _ => format!("`{name}` has {length} numbers, which is not a multiple of {}", kind.arity()),
            };
            self.builder.report.error("parameter-count", message, span);
            return None;
        }
        if kind.arity() > 1 && !self.has_rows_of(name, kind.arity()) {
            return None;
        }
        Some((kind, values, span))
    }

    /// Whether an array has rows of this length, or none; other rows are reported.
    pub(super) fn has_rows_of(&mut self, name: &str, length: usize) -> bool {
        let given = self.given.iter().find(|given| given.parameter.name == name);
        let Some(row) = given.and_then(|given| given.parameter.row).filter(|&row| row != length) else {
            return true;
        };
        self.refuse(name, format!("`{name}` is an array with rows of {length}, not of {row}"));
        false
    }

    /// Reports a wrong number of values.
    pub(super) fn count(&mut self, name: &str, expected: usize, found: usize, span: Span) {
        let values = if expected == 1 { "one value" } else { &format!("{expected} values") };
        let message = format!("`{name}` takes {values}, not {found}");
        self.builder.report.error("parameter-count", message, span);
    }

    /// The place of a parameter that was read.
    pub(crate) fn place(&self, name: &str) -> Span {
        self.origin.parameter(name)
    }

    /// Reports an invalid value.
    pub(crate) fn refuse(&mut self, name: &str, message: impl Into<String>) {
        let span = self.origin.parameter(name);
        self.builder.report.error("parameter-value", message, span);
    }

    /// Reports a parameter that has no effect.
    pub(crate) fn ignored(&mut self, name: &str, message: impl Into<String>) {
        let span = self.origin.parameter(name);
        self.builder.report.warning("ignored", message, span);
    }

    /// Notes the default and the allowed values of the parameter that was looked up last.
    pub(crate) fn note(&mut self, default: impl Display, values: impl Display) {
        self.asked.last_mut().into_iter().for_each(|asked| asked.note(&default, &values));
    }

    /// Reports that a required parameter is missing.
    pub(crate) fn missing(&mut self, name: &str) {
        self.asked.iter_mut().filter(|asked| asked.name == name).for_each(Asked::require);
        let message = format!("`{}` needs the parameter `{name}`", self.kind.value);
        self.builder.report.error("missing-parameter", message, self.kind.span);
    }

    /// A parameter that the statement needs, by its reader: one that is absent is reported.
    pub(crate) fn needed<T>(
        &mut self,
        name: &'static str,
        read: impl FnOnce(&mut Self, &'static str) -> Option<T>,
    ) -> Option<T> {
        let value = read(self, name);
        if value.is_none() && !self.has(name) {
            self.missing(name);
        }
        value
    }

    /// Whether a parameter is given by the statement itself or by `Attribute`.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.given.iter().any(|given| given.parameter.name == name)
    }

    /// The member of a set that the statement's type names, with its settings.
    pub(crate) fn member<T: Settings + Default>(&mut self, set: &str, what: &str) -> Option<T> {
        let Some(mut desc) = T::called(&self.kind.value) else {
            let members = T::members();
            let known: Vec<&str> = members
                .iter()
                .filter_map(Settings::member)
                .flat_map(|member| member.names)
                .copied()
                .collect();
            self.unknown_type(set, what, &known);
            return None;
        };
        self.settings(&mut desc);
        Some(desc)
    }

    /// Reads those settings that are given.
    pub(crate) fn settings(&mut self, desc: &mut impl Settings) {
        desc.visit(&mut |field, slot| {
            // The white of the colour space in force.
            if let Value::Spectrum(SpectrumDesc::Illuminant(_)) = slot.get() {
                slot.set(&Value::Spectrum(SpectrumDesc::Illuminant(self.color_space)));
            }
            let value = self.setting(field, slot.kind());
            self.asked.last_mut().into_iter().for_each(|asked| asked.note_setting(field, slot));
            let Some(value) = value else { return };
            // In the format, a number that counts nothing leaves a count to the renderer.
            let is_count = slot.kind() == Kind::Count && slot.get() == Value::Automatic;
            if is_count && matches!(value, Value::Integer(..=0)) {
                return;
            }
            if let Err(values) = field.assign(slot, &value) {
                self.refuse(field.name, format!("`{}` is {values}, not {value}", field.name));
            }
        });
    }

    fn setting(&mut self, field: &Field, kind: Kind) -> Option<Value> {
        let name = field.name;
        match kind {
            Kind::Bool => self.boolean(name).map(Value::Bool),
            Kind::Integer | Kind::Count => {
                self.optional_integer(name).map(|value| Value::Integer(value.into()))
            }
            Kind::Number => self.optional_float(name).map(Value::Number),
            Kind::Choice(names) => self.name_of(name, names).map(Value::Text),
            Kind::Text if !field.domain.names.is_empty() => {
                self.name_of(name, field.domain.names).map(Value::Text)
            }
            Kind::Text => self.string(name).map(|text| Value::Text(text.value)),
            Kind::Point => {
                let points = match field.domain.is_vector {
                    true => self.vectors3(name)?,
                    false => self.points3(name)?,
                };
                let &[point] = &*points else {
                    self.count(name, 3, 3 * points.len(), self.origin.parameter(name));
                    return None;
                };
                Some(Value::Point(point))
            }
            Kind::Spectrum if field.domain.is_index => self.index_or_spectrum(name).map(Value::Spectrum),
            Kind::Spectrum => self.spectrum(name).map(Value::Spectrum),
            Kind::FloatParameter => self.optional_float_parameter(name).map(|value| value.to_value()),
            Kind::SpectrumParameter => self.optional_spectrum_parameter(name).map(|value| value.to_value()),
            Kind::List(kind, count) => {
                let (kind, row) = if let Kind::List(kind, row) = kind { (*kind, *row) } else { (kind, 1) };
                let values: Vec<Value> = match kind {
                    Kind::Point => self.points3(name)?.iter().map(|&point| Value::Point(point)).collect(),
                    Kind::Number => self.floats(name)?.iter().map(|&value| Value::Number(value)).collect(),
                    _ => self.integers(name)?.iter().map(|&value| Value::Integer(value.into())).collect(),
                };
                if values.len() != row * count {
                    self.count(name, row * count, values.len(), self.origin.parameter(name));
                    return None;
                }
                let rows = || values.chunks(row).map(|row| Value::List(row.to_vec())).collect();
                Some(Value::List(if row == 1 { values } else { rows() }))
            }
        }
    }

    /// Numbers.
    pub(crate) fn floats(&mut self, name: &'static str) -> Option<Arc<[f32]>> {
        match self.take(name, &[ParameterType::Float])? {
            (_, Values::Floats(values), _) => Some(values),
            _ => None,
        }
    }

    /// A fixed count of numbers.
    pub(crate) fn float_array<const N: usize>(&mut self, name: &'static str) -> Option<[f32; N]> {
        let values = self.floats(name)?;
        <[f32; N]>::try_from(&*values)
            .map_err(|_| self.count(name, N, values.len(), self.origin.parameter(name)))
            .ok()
    }

    /// A number that may be absent.
    pub(crate) fn optional_float(&mut self, name: &'static str) -> Option<f32> {
        self.float_array::<1>(name).map(|[value]| value)
    }

    /// A number.
    pub(crate) fn float(&mut self, name: &'static str, default: f32) -> f32 {
        let value = self.optional_float(name).unwrap_or(default);
        self.note(default, "");
        value
    }

    /// Integers.
    pub(crate) fn integers(&mut self, name: &'static str) -> Option<Arc<[i32]>> {
        match self.take(name, &[ParameterType::Integer])? {
            (_, Values::Integers(values), _) => Some(values),
            _ => None,
        }
    }

    /// A fixed count of integers.
    pub(crate) fn integer_array<const N: usize>(&mut self, name: &'static str) -> Option<[i32; N]> {
        let values = self.integers(name)?;
        <[i32; N]>::try_from(&*values)
            .map_err(|_| self.count(name, N, values.len(), self.origin.parameter(name)))
            .ok()
    }

    /// An integer that may be absent.
    pub(crate) fn optional_integer(&mut self, name: &'static str) -> Option<i32> {
        self.integer_array::<1>(name).map(|[value]| value)
    }

    /// An integer in a range.
    pub(crate) fn integer(&mut self, name: &'static str, default: i32, range: RangeInclusive<i32>) -> i32 {
        let value = self.optional_integer(name).unwrap_or(default);
        let allowed = Within(range);
        self.note(default, &allowed);
        if allowed.0.contains(&value) {
            return value;
        }
        self.refuse(name, format!("`{name}` must be {allowed}"));
        default
    }

    /// A Boolean.
    fn boolean(&mut self, name: &'static str) -> Option<bool> {
        match self.take(name, &[ParameterType::Bool])? {
            (_, Values::Bools(values), span) => match values[..] {
                [value] => Some(value),
                _ => {
                    self.count(name, 1, values.len(), span);
                    None
                }
            },
            _ => None,
        }
    }

    /// Strings with their spans.
    pub(crate) fn strings(&mut self, name: &'static str) -> Option<Vec<Spanned<String>>> {
        match self.take(name, &[ParameterType::String])? {
            (_, Values::Strings(values), _) => Some(values),
            _ => None,
        }
    }

    /// A string that may be absent.
    pub(crate) fn string(&mut self, name: &'static str) -> Option<Spanned<String>> {
        let mut values = self.strings(name)?;
        if values.len() != 1 {
            self.count(name, 1, values.len(), self.origin.parameter(name));
            return None;
        }
        values.pop()
    }

    /// One of some values that have names.
    pub(crate) fn choice<T: Copy + PartialEq>(
        &mut self,
        name: &'static str,
        default: T,
        known: &[(&str, T)],
    ) -> T {
        let names: Vec<&str> = known.iter().map(|&(choice, _)| choice).collect();
        let given = self.name_of(name, &names);
        let usual = known.iter().find(|(_, value)| *value == default).map_or("", |(choice, _)| choice);
        self.note(usual, Listed(&names));
        let Some(given) = given else { return default };
        known.iter().find(|(choice, _)| *choice == given).map_or(default, |&(_, value)| value)
    }

    /// A value that has a name in the format.
    pub(crate) fn named<T: SettingType>(&mut self, name: &'static str) -> Option<T> {
        let Kind::Choice(known) = T::KIND else { return None };
        let given = self.name_of(name, known);
        self.note("", Listed(known));
        T::from_value(&Value::Text(given?))
    }

    /// The member of a set that a parameter names, with its settings, or the default.
    pub(crate) fn part<T: Settings + Default>(&mut self, name: &'static str) -> T {
        let known: Vec<&str> = T::members().iter().map(Settings::name).collect();
        let given = self.name_of(name, &known);
        self.note(T::default().name(), Listed(&known));
        let mut part = given.and_then(|given| T::called(&given)).unwrap_or_default();
        self.settings(&mut part);
        part
    }

    /// One of some names.
    fn name_of(&mut self, name: &'static str, known: &[&str]) -> Option<String> {
        let given = self.string(name)?;
        if known.contains(&given.value.as_str()) {
            return Some(given.value);
        }
        let message = format!("`{name}` cannot be `{}`", given.value);
        self.builder.report.push(Diagnostic {
            help: did_you_mean(&given.value, known.iter().copied()),
            ..Diagnostic::error("unknown-choice", message, given.span)
        });
        None
    }

    /// Pairs of numbers.
    pub(crate) fn points2(&mut self, name: &'static str) -> Option<Arc<[Vec2]>> {
        match self.take(name, &[ParameterType::Point2, ParameterType::Vector2])? {
            (_, Values::Floats(values), _) => {
                Some(values.as_chunks::<2>().0.iter().map(|&pair| Vec2::from_array(pair)).collect())
            }
            _ => None,
        }
    }

    fn triples(&mut self, name: &'static str, types: &'static [ParameterType]) -> Option<Arc<[Vec3]>> {
        match self.take(name, types)? {
            (_, Values::Floats(values), _) => {
                Some(values.as_chunks::<3>().0.iter().map(|&triple| Vec3::from_array(triple)).collect())
            }
            _ => None,
        }
    }

    /// Points.
    pub(crate) fn points3(&mut self, name: &'static str) -> Option<Arc<[Vec3]>> {
        self.triples(name, &[ParameterType::Point3])
    }

    /// Vectors.
    pub(crate) fn vectors3(&mut self, name: &'static str) -> Option<Arc<[Vec3]>> {
        self.triples(name, &[ParameterType::Vector3])
    }

    /// Normals.
    pub(crate) fn normals(&mut self, name: &'static str) -> Option<Arc<[Vec3]>> {
        self.triples(name, &[ParameterType::Normal])
    }

    /// Colours, in the space in force where they were given.
    pub(crate) fn rgbs(&mut self, name: &'static str) -> Option<Arc<[[f32; 3]]>> {
        match self.take(name, &[ParameterType::Rgb])? {
            (_, Values::Floats(values), _) => try_cast_slice_arc(values).ok(),
            _ => None,
        }
    }

    /// A spectrum that may be absent.
    pub(crate) fn spectrum(&mut self, name: &'static str) -> Option<SpectrumDesc> {
        self.spectrum_of(name, ParameterType::of(Kind::Spectrum))
    }

    /// An index of refraction: a number or a spectrum.
    fn index_or_spectrum(&mut self, name: &'static str) -> Option<SpectrumDesc> {
        const TYPES: &[ParameterType] =
            &[ParameterType::Float, ParameterType::Spectrum, ParameterType::Rgb, ParameterType::Blackbody];
        self.spectrum_of(name, TYPES)
    }

    /// A number or a texture of numbers, which may be absent.
    pub(crate) fn optional_float_parameter(&mut self, name: &'static str) -> Option<FloatParameter> {
        match self.take(name, ParameterType::of(Kind::FloatParameter))? {
            (_, Values::Floats(values), _) if values.len() == 1 => Some(FloatParameter::Value(values[0])),
            (_, Values::Strings(names), _) if names.len() == 1 => {
                self.builder.float_texture(&names[0]).map(Parameter::Texture)
            }
            (_, values, span) => {
                self.count(name, 1, values.len(), span);
                None
            }
        }
    }

    /// A spectrum or a texture of spectra, which may be absent.
    pub(crate) fn optional_spectrum_parameter(&mut self, name: &'static str) -> Option<SpectrumParameter> {
        let index = self.find(name, ParameterType::of(Kind::SpectrumParameter))?;
        if self.given[index].parameter.kind != ParameterType::Texture {
            return self.spectrum_at(index, name).map(Parameter::Value);
        }
        let (_, values, span) = self.take_at(index, name)?;
        match values {
            Values::Strings(names) if names.len() == 1 => {
                self.builder.spectrum_texture(&names[0]).map(Parameter::Texture)
            }
            values => {
                self.count(name, 1, values.len(), span);
                None
            }
        }
    }

    /// An image file that may be absent.
    pub(crate) fn image(
        &mut self,
        name: &'static str,
        encoding: Option<EncodingDesc>,
    ) -> Option<Handle<ImageDesc>> {
        let file = self.string(name)?;
        Some(self.builder.image(&file, encoding))
    }
}
