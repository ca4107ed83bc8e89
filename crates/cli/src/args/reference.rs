//! The page about the command line, made from its definition.

use clap::{Arg, ArgAction, Command, CommandFactory};
use testkit::check_generated;

use super::Cli;

#[test]
fn the_page_about_the_command_line_is_generated() {
    let mut root = Cli::command();
    root.build();
    let mut page = String::from("## Commands\n\n| command | |\n|---|---|\n");
    let commands = leaves(&root);
    for command in &commands {
        let about = command.get_about().expect("every command is described");
        page += &format!("| [`{}`](#{}) | {about} |\n", name(command), anchor(command));
    }
    for command in commands {
        page += &section(command);
    }
    check_generated("docs/cli.md", ["## Commands\n", ""], &page);
}

/// The commands that have no commands below them.
fn leaves(command: &Command) -> Vec<&Command> {
    let below: Vec<_> = command.get_subcommands().filter(|command| command.get_name() != "help").collect();
    if below.is_empty() { vec![command] } else { below.into_iter().flat_map(leaves).collect() }
}

/// The command as it is typed.
fn name(command: &Command) -> &str {
    command.get_bin_name().expect("a command that is built has one")
}

fn anchor(command: &Command) -> String {
    name(command).replace(' ', "-")
}

fn section(command: &Command) -> String {
    let about = command.get_long_about().or(command.get_about()).map(ToString::to_string).unwrap_or_default();
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ");
    let mut text =
        format!("\n### `{}`\n\n{about}\n\n```\n{usage}\n```\n\n| argument | |\n|---|---|\n", name(command));
    for argument in command.get_arguments().filter(|argument| argument.get_id() != "help") {
        let help = argument.get_long_help().or(argument.get_help()).map(ToString::to_string);
        let help = help.unwrap_or_default().replace('|', "\\|").replace('\n', " ");
        text += &format!("| {} | {help}{} |\n", spelt(argument), values(argument));
    }
    text
}

/// The argument as it is typed, with the names of its values.
fn spelt(argument: &Arg) -> String {
    let value = match argument.get_action() {
        ArgAction::Set | ArgAction::Append => {
            let names = argument.get_value_names().unwrap_or_default();
            names.first().map_or(argument.get_id().to_string().to_uppercase(), ToString::to_string)
        }
        _ => String::new(),
    };
    let value = value.replace('|', "\\|");
    let Some(long) = argument.get_long() else { return format!("`{value}`") };
    let is_optional = argument.get_num_args().is_some_and(|range| range.min_values() == 0);
    let long = match (value.as_str(), is_optional) {
        ("", _) => format!("`--{long}`"),
        (_, true) => format!("`--{long}[={value}]`"),
        _ => format!("`--{long} {value}`"),
    };
    argument.get_short().map_or(long.clone(), |short| format!("`-{short}`, {long}"))
}

/// Values of a closed set, and the default.
fn values(argument: &Arg) -> String {
    let mut text = String::new();
    let possible: Vec<_> = match argument.get_action() {
        ArgAction::Set | ArgAction::Append => argument.get_possible_values(),
        _ => Vec::new(),
    };
    if !possible.is_empty() && !argument.is_hide_possible_values_set() {
        let list = possible.iter().map(|value| match value.get_help() {
            Some(help) => format!("`{}`: {}", value.get_name(), help.to_string().trim_end_matches('.')),
            None => format!("`{}`", value.get_name()),
        });
        let separator = if possible.iter().any(|value| value.get_help().is_some()) { "; " } else { ", " };
        text += &format!(" [{}]", list.collect::<Vec<_>>().join(separator));
    }
    let default = argument.get_default_values().first().and_then(|value| value.to_str());
    if let Some(default) = default.filter(|_| argument.get_action().takes_values()) {
        text += &format!(" [default: {default}]");
    }
    text
}
