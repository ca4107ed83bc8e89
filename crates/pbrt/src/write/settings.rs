//! Settings by their schema: those that do not have their default.

use std::collections::BTreeSet;

use description::schema::{Kind, Setting, SettingType, Settings, Value};
use description::{OptionsDesc, SceneDesc, SpectrumDesc};
use math::Point3;

use crate::write::names::Names;
use crate::write::number::decimal;
use crate::write::statement::{Statement, quoted};
use crate::write::text::Text;

/// The algorithms of pbrt-v4.
const INTEGRATORS: [&str; 11] = [
    "ambientocclusion",
    "bdpt",
    "function",
    "lightpath",
    "mlt",
    "path",
    "randomwalk",
    "simplepath",
    "simplevolpath",
    "sppm",
    "volpath",
];

/// Settings that pbrt-v4 does not know, where they are not those of an algorithm of ours.
const OWN_SETTINGS: [&str; 4] = ["engine", "quality", "schedule", "technique"];

/// A member of a set of settings as a statement; nothing if it is the default of the set.
pub(crate) fn member<T: Settings + Clone + Default>(
    directive: &str,
    desc: &T,
    text: &mut Text,
    extensions: &mut BTreeSet<String>,
) {
    let statement = statement(directive, desc, extensions);
    if !statement.parameters.is_empty() || desc.name() != T::default().name() {
        text.statement(statement);
    }
}

/// A member of a set of settings as a statement. It has the format's name, which is the last one.
pub(crate) fn statement<T: Settings + Clone + Default>(
    directive: &str,
    desc: &T,
    extensions: &mut BTreeSet<String>,
) -> Statement {
    let kind = desc.member().and_then(|member| member.names.last()).copied().unwrap_or_default();
    let is_own = match directive {
        "Integrator" => !INTEGRATORS.contains(&kind),
        "Accelerator" => kind == "none",
        _ => false,
    };
    if is_own {
        extensions.insert(format!("{} {kind}", directive.to_lowercase()));
    }
    let mut statement = Statement::new(directive, kind);
    for setting in changed(desc) {
        let name = setting.field.name;
        if OWN_SETTINGS.contains(&name) && !is_own {
            extensions.insert(format!("{} {name}", directive.to_lowercase()));
        }
        write(&mut statement, &setting, None);
    }
    statement
}

/// Notes a member that the format of pbrt-v4 does not have.
pub(crate) fn note_extension(set: &str, desc: &impl Settings, extensions: &mut BTreeSet<String>) {
    let name = desc.member().filter(|member| member.is_extension).map(|member| member.names[0]);
    extensions.extend(name.map(|name| format!("{set} {name}")));
}

/// The parameters of a member of a scene that differ from its defaults.
pub(crate) fn parameters<T: Settings + Clone + Default>(to: &mut Statement, desc: &T, names: &Names) {
    for (setting, usual) in with_defaults(desc) {
        match (&setting.value, &usual.value) {
            // The white of the colour space in force.
            (
                Value::Spectrum(SpectrumDesc::Illuminant(space)),
                Value::Spectrum(SpectrumDesc::Illuminant(_)),
            ) => to.space = Some(*space),
            (value, usual) if value == usual => (),
            _ => write(to, &setting, Some(names)),
        }
    }
}

/// The member of a set that a parameter names, and its parameters.
pub(crate) fn part<T: Settings + Clone + Default>(to: &mut Statement, name: &str, desc: &T, names: &Names) {
    to.choice(name, desc.name(), T::default().name());
    parameters(to, desc, names);
}

/// A parameter with its value.
fn write(to: &mut Statement, setting: &Setting, names: Option<&Names>) {
    let Setting { field, kind, value } = setting;
    let name = field.name;
    match (value, names) {
        (Value::Spectrum(SpectrumDesc::Constant(index)), _)
            if field.domain.is_index && *kind == Kind::Spectrum =>
        {
            to.floats(name, [*index]);
        }
        (Value::Point(vector), _) if field.domain.is_vector => to.triples("vector3", name, &[*vector]),
        (Value::Point(point), _) => to.triples("point3", name, &[*point]),
        (Value::List(values), _) if matches!(values[..], [Value::Point(_), ..]) => {
            let points: Vec<Point3> = values.iter().filter_map(Point3::from_value).collect();
            to.triples("point3", name, &points);
        }
        (Value::Spectrum(spectrum), _) => to.spectrum(name, spectrum),
        (Value::FloatTexture(texture), Some(names)) => {
            to.push("texture", name, vec![quoted(names.float_texture(texture.typed()))]);
        }
        (Value::SpectrumTexture(texture), Some(names)) => {
            to.push("texture", name, vec![quoted(names.spectrum_texture(texture.typed()))]);
        }
        // The value of an alternative that is not the one chosen.
        (Value::Automatic, Some(_)) => (),
        (value, _) => match written(value) {
            Some((kind, values)) => to.push(kind, name, values),
            None => to.fail(format!("`{name}` cannot be {value}")),
        },
    }
}

/// The settings that differ from those of the same member with its defaults.
fn changed<T: Settings + Clone + Default>(desc: &T) -> Vec<Setting> {
    let settings = with_defaults(desc);
    settings.filter(|(own, usual)| own.value != usual.value).map(|(own, _)| own).collect()
}

/// The settings, each with that of the same member with its defaults.
fn with_defaults<T: Settings + Clone + Default>(desc: &T) -> impl Iterator<Item = (Setting, Setting)> {
    desc.settings().into_iter().zip(T::called(desc.name()).unwrap_or_default().settings())
}

/// The type of a value in the format, and its numbers or texts; nothing if it cannot be written.
fn written(value: &Value) -> Option<(&'static str, Vec<String>)> {
    Some(match value {
        Value::Bool(value) => ("bool", vec![value.to_string()]),
        Value::Integer(value) => ("integer", vec![value.to_string()]),
        Value::Number(value) => ("float", vec![Some(decimal(*value)).filter(|_| value.is_finite())?]),
        Value::Text(value) => ("string", vec![quoted(value)]),
        Value::List(values) => {
            let values: Vec<_> = values.iter().map(written).collect::<Option<_>>()?;
            let kind = values.first().map_or("float", |(kind, _)| kind);
            (kind, values.into_iter().flat_map(|(_, values)| values).collect())
        }
        Value::Point(_)
        | Value::Spectrum(_)
        | Value::FloatTexture(_)
        | Value::SpectrumTexture(_)
        | Value::Automatic => {
            return None;
        }
    })
}

/// The options, each a statement without a type.
pub(crate) fn options(desc: &SceneDesc, text: &mut Text, extensions: &mut BTreeSet<String>) {
    let options: &OptionsDesc = &desc.options;
    for Setting { field, value, .. } in changed(options) {
        let Some((_, values)) = written(&value) else {
            text.fail(format!("the option `{}` cannot be {value}", field.name));
            continue;
        };
        if OWN_SETTINGS.contains(&field.name) {
            extensions.insert(format!("option {}", field.name));
        }
        text.line(&format!("Option {} {}", quoted(field.name), values.join(" ")));
    }
}
