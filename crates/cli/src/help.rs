//! The lists of integrators and settings at the end of `--help`.

use alhazen::description::schema::{Setting, Value};
use alhazen::{Group, PARTS};

/// All settings with their values, units and defaults, by the part of the scene that has them.
pub fn settings() -> String {
    let mut text = String::from(
        "Settings (--set KEY=VALUE). Where two parts of a scene have a setting of the same name, \
         PART.KEY says which one is meant, as in filter.sigma.\n",
    );
    for part in &PARTS {
        let choice = match part.name {
            "integrator" => ", by --integrator NAME:",
            "accelerator" => ", by --accelerator NAME:",
            "sampler" => ", by --set sampler=NAME:",
            "filter" => ", by --set filter=NAME:",
            _ => ":",
        };
        text += &format!("\n{}{choice}\n", part.name);
        for Group { member, settings } in part.groups() {
            if let Some(member) = member {
                text += &format!("  {}: {}\n", member.names[0], member.help);
            }
            settings.iter().for_each(|setting| text += &line(setting));
        }
    }
    text
}

fn line(Setting { field, kind, value }: &Setting) -> String {
    let names = [field.name].iter().chain(field.aliases).copied().collect::<Vec<_>>().join(", ");
    let values = field.domain.describe(*kind);
    let unit = field.domain.unit;
    let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
    let default = match value {
        Value::Automatic => String::new(),
        value => format!("; default: {value}"),
    };
    format!("      {names:<22} {} [{values}{unit}{default}]\n", field.help)
}
