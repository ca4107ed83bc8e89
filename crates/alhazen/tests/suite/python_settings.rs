//! The module `alhazen.settings` of the Python package, which is generated from the schema.

use std::fmt::Write;

use alhazen::description::schema::{Kind, Member, Setting, Value};
use alhazen::{Group, PARTS, Part};

const HEAD: &str = r#""""Settings of a scene, with their types and ranges: generated from the schema of settings.

    alhazen.render(scene, integrator=settings.integrator.path(maxdepth=8))
    alhazen.render(scene, settings=[settings.film(iso=200), settings.sampler.sobol()])
    builder.integrator(settings.integrator.bdpt())

A setting that is not given keeps the value of the scene, or its default.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal


@dataclass(frozen=True)
class Settings:
    """Some settings of a part of a scene."""

    #: The part, such as "integrator".
    part: str
    #: The chosen member of a set, such as "path"; None if there is no choice.
    name: str | None
    #: Values by name.
    values: dict[str, Any] = field(default_factory=dict)


def _given(part: str, name: str | None, values: dict[str, Any]) -> Settings:
    given = {key.replace("_", "-"): value for key, value in values.items() if value is not None}
    return Settings(part, name, given)
"#;

/// The most characters of a line.
const WIDTH: usize = 100;

fn type_of(kind: Kind, names: &[&str]) -> String {
    let choice = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
        format!("Literal[{}]", names.join(", "))
    };
    match kind {
        Kind::Bool => "bool".into(),
        Kind::Integer | Kind::Count => "int".into(),
        Kind::Number => "float".into(),
        Kind::Choice(names) => choice(names),
        Kind::Text if !names.is_empty() => choice(names),
        Kind::Text => "str".into(),
        Kind::Point | Kind::Spectrum | Kind::FloatParameter | Kind::SpectrumParameter => {
            unreachable!("settings have no colours or textures")
        }
        Kind::List(kind, _) => format!("Sequence[{}]", type_of(*kind, names)),
    }
}

/// A paragraph in lines, indented by so many spaces.
fn wrapped(paragraph: &str, indent: usize) -> String {
    let (pad, mut text, mut width) = (" ".repeat(indent), String::new(), WIDTH);
    for word in paragraph.split(' ') {
        let length = word.chars().count();
        if width + 1 + length > WIDTH {
            text += if text.is_empty() { "" } else { "\n" };
            text += &pad;
            width = indent + length;
        } else {
            text.push(' ');
            width += 1 + length;
        }
        text += word;
    }
    text + "\n"
}

/// A function of settings, indented by so many spaces.
fn function(indent: usize, part: &Part, member: Option<&Member>, help: &str, settings: &[Setting]) -> String {
    let pad = " ".repeat(indent);
    let name = member.map_or(part.name, |member| member.names[0]);
    let mut text = format!("{pad}def {}(", name.replace('-', "_"));
    if settings.is_empty() {
        text += ") -> Settings:\n";
    } else {
        writeln!(text).unwrap();
        writeln!(text, "{pad}    *,").unwrap();
        for Setting { field, kind, .. } in settings {
            let types = type_of(*kind, field.domain.names);
            assert!(!field.name.contains('_'), "`_` stands for `-` in Python");
            let name = field.name.replace('-', "_");
            writeln!(text, "{pad}    {name}: {types} | None = None,").unwrap();
        }
        writeln!(text, "{pad}) -> Settings:").unwrap();
    }
    let mut paragraphs = vec![help.to_owned()];
    for Setting { field, kind, value } in settings {
        let unit = field.domain.unit;
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let default = match value {
            Value::Automatic => String::new(),
            value => format!(", by default {value}"),
        };
        let values = field.domain.describe(*kind);
        let name = field.name.replace('-', "_");
        paragraphs.push(format!("{name}: {values}{unit}{default}. {}", field.help));
    }
    paragraphs[0].insert_str(0, "\"\"\"");
    let end = if paragraphs.len() == 1 { "\"\"\"" } else { "" };
    paragraphs[0] += end;
    let paragraphs: Vec<String> = paragraphs.iter().map(|paragraph| wrapped(paragraph, indent + 4)).collect();
    text += &paragraphs.join("\n");
    if end.is_empty() {
        writeln!(text, "{pad}    \"\"\"").unwrap();
    }
    let member = member.map_or("None".to_owned(), |member| format!("{:?}", member.names[0]));
    writeln!(text, "{pad}    return _given({:?}, {member}, dict(locals()))", part.name).unwrap();
    text
}

/// The text of the module.
fn module() -> String {
    let mut text = HEAD.to_owned();
    for part in &PARTS {
        let groups = part.groups();
        let common = &groups[0].settings;
        // Members of the film and the camera are those of the scene.
        let is_chosen = !matches!(part.name, "film" | "camera" | "options");
        if !is_chosen {
            let all: Vec<Setting> = groups.iter().flat_map(|group| &group.settings).fold(
                Vec::new(),
                |mut all: Vec<Setting>, setting| {
                    if all.iter().all(|known| known.field.name != setting.field.name) {
                        all.push(setting.clone());
                    }
                    all
                },
            );
            let help = format!("Settings of the scene's {}.", part.name);
            text += &format!("\n\n{}", function(0, part, None, &help, &all));
            continue;
        }
        text +=
            &format!("\n\nclass {}:\n    \"\"\"A choice of the {0}, with its settings.\"\"\"\n", part.name);
        for Group { member, settings } in &groups[1..] {
            let member = member.expect("a choice has members");
            let settings: Vec<Setting> = settings.iter().chain(common).cloned().collect();
            text += "\n    @staticmethod\n";
            text += &function(4, part, Some(member), member.help, &settings);
        }
    }
    text
}

#[test]
fn the_module_of_settings_is_generated() {
    testkit::check_generated("crates/python/python/alhazen/settings.py", ["", ""], &module());
}
