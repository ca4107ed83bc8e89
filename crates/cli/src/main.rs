//! The command line of alhazen.

mod args;
mod console;
mod diagnostics;
mod failure;
mod image;
mod output;

use std::process::ExitCode;

use args::{Cli, Command};
use clap::Parser;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    let result = match &cli.command {
        Command::Image(args::Image::Diff(diff)) => image::diff(diff),
        Command::Image(args::Image::Convert(convert)) => image::convert(convert),
        _ => Ok(()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(cli.command.json()),
    }
}

/// Tells what is wrong with the command line, or the help that was asked for.
fn usage(error: &clap::Error) -> ExitCode {
    let asked_for_json = std::env::args().any(|argument| argument == "--json");
    if error.use_stderr() && asked_for_json {
        return failure::Failure::Usage(error.render().to_string().trim().to_owned()).report(true);
    }
    // If nobody listens, there is nobody to tell.
    let _ = error.print();
    ExitCode::from(if error.use_stderr() { 2 } else { 0 })
}
