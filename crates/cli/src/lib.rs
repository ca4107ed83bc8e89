//! The command line of alhazen, which its program and the Python package run.

mod args;
mod bar;
mod checkpoint;
mod compare;
mod console;
#[cfg(feature = "gpu")]
mod device;
mod diagnostics;
mod doctor;
mod drive;
mod failure;
mod help;
mod image;
mod inspect;
mod interrupt;
mod limits;
mod live;
mod manual;
mod merge;
mod numbers;
mod output;
mod pack;
mod render;
mod results;
mod resume;
mod scene;
#[cfg(feature = "gpu")]
mod split;
mod summary;
mod threads;
mod trace;
mod values;
mod view;

use std::ffi::OsString;
use std::io::ErrorKind;
use std::process::ExitCode;

use alhazen::lanes::InstructionSet;
use args::{Cli, Command};
use clap::Parser;
use failure::Failure;

/// Runs the program with its arguments, of which the first is its name.
pub fn run(arguments: Vec<OsString>) -> ExitCode {
    #[cfg(feature = "gpu")]
    device::silence_layers();
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(error) => return usage(&error, &arguments),
    };
    if let Err(message) = InstructionSet::requested() {
        return Failure::Usage(message).report(cli.command.json());
    }
    let done = |()| ExitCode::SUCCESS;
    let result = match &cli.command {
        Command::Render(arguments) => render::render(arguments),
        Command::Resume(arguments) => resume::resume(arguments),
        Command::Merge(arguments) => merge::merge(arguments).map(done),
        Command::Compare(arguments) => compare::compare(arguments),
        Command::View(arguments) => view::view(arguments),
        Command::Scene(args::Scene::Check(arguments)) => scene::check(arguments).map(done),
        Command::Scene(args::Scene::Convert(arguments)) => scene::convert(arguments).map(done),
        Command::Scene(args::Scene::Pack(arguments)) => pack::pack(arguments).map(done),
        Command::Image(args::Image::Info(arguments)) => image::info(arguments).map(done),
        Command::Image(args::Image::Diff(arguments)) => image::diff(arguments).map(done),
        Command::Image(args::Image::Convert(arguments)) => image::convert(arguments).map(done),
        Command::TracePixel(arguments) => trace::trace(arguments),
        Command::Doctor(arguments) => doctor::doctor(arguments).map(done),
        Command::Completions(arguments) => manual::completions(arguments).map(done),
        Command::Man(arguments) => manual::man(arguments).map(done),
    };
    result.unwrap_or_else(|failure| failure.report(cli.command.json()))
}

/// Reports an error of the command line, or prints help or version.
fn usage(error: &clap::Error, arguments: &[OsString]) -> ExitCode {
    let wrong = error.use_stderr();
    if wrong && arguments.iter().any(|argument| argument == "--json") {
        return Failure::Usage(error.render().to_string().trim().to_owned()).report(true);
    }
    match error.print() {
        Err(error) if !wrong && error.kind() != ErrorKind::BrokenPipe => {
            Failure::Input(format!("cannot write to standard output: {error}")).report(false)
        }
        _ => ExitCode::from(if wrong { 2 } else { 0 }),
    }
}
