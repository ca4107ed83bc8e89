//! Settings by their schema: those that do not have their default.

use std::collections::BTreeSet;

use description::schema::{Setting, Settings, Value};
use description::{OptionsDesc, SceneDesc};

use crate::number::decimal;
use crate::statement::{Statement, quoted};
use crate::text::Text;

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
const OWN_SETTINGS: [&str; 3] = ["engine", "quality", "technique"];

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
    for Setting { field, value, .. } in changed(desc) {
        let Some((kind, values)) = written(&value) else {
            statement.fail(format!("`{}` cannot be {value}", field.name));
            continue;
        };
        if OWN_SETTINGS.contains(&field.name) && !is_own {
            extensions.insert(format!("{} {}", directive.to_lowercase(), field.name));
        }
        statement.push(kind, field.name, values);
    }
    statement
}

/// The settings that differ from those of the same member with its defaults.
fn changed<T: Settings + Clone + Default>(desc: &T) -> Vec<Setting> {
    let default = T::called(desc.name()).unwrap_or_default().settings();
    let settings = desc.settings().into_iter();
    settings.zip(default).filter(|(own, usual)| own.value != usual.value).map(|(own, _)| own).collect()
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
        Value::Automatic => return None,
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
