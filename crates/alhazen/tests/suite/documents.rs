//! The documents list the integrators and settings of the schema.

use std::path::Path;

use alhazen::description::schema::{Setting, Value};
use alhazen::film::Layer;
use alhazen::{Group, PARTS, integrator_names};

fn document(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn row(Setting { field, kind, value }: &Setting) -> String {
    let names: Vec<String> =
        [field.name].iter().chain(field.aliases).map(|name| format!("`{name}`")).collect();
    let unit = field.domain.unit;
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    let default = match value {
        Value::Automatic => String::new(),
        value => format!("`{value}`"),
    };
    let values = field.domain.describe(*kind);
    format!("| {} | {values}{unit} | {default} | {} |\n", names.join(", "), field.help)
}

/// The tables of all settings.
fn tables() -> String {
    let mut text = String::new();
    for part in &PARTS {
        text += &format!("## {}\n\n", part.name);
        for Group { member, settings } in part.groups() {
            if let Some(member) = member {
                text += &format!("`{}`: {}\n\n", member.names[0], member.help);
            }
            if !settings.is_empty() {
                text += "| setting | values | default | meaning |\n|---|---|---|---|\n";
                settings.iter().for_each(|setting| text += &row(setting));
                text += "\n";
            }
        }
    }
    text.trim_end().to_owned() + "\n"
}

#[test]
fn the_page_of_settings_is_generated() {
    testkit::check_generated("docs/settings.md", ["## integrator\n", ""], &tables());
}

#[test]
fn the_page_of_layers_names_every_layer() {
    let page = document("docs/layers.md");
    for layer in Layer::ALL {
        assert!(page.contains(&format!("`{layer}`")), "docs/layers.md does not name `{layer}`");
    }
}

#[test]
fn the_readme_names_every_integrator() {
    let readme = document("README.md");
    for name in integrator_names() {
        assert!(readme.contains(&format!("`{name}`")), "README.md does not name `{name}`");
    }
}
