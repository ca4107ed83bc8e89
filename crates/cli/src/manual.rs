//! Shell completions and man pages, made from the definition of the command line.

use std::path::Path;

use clap::CommandFactory;

use crate::args::{Cli, Completions, Man};
use crate::console::say;
use crate::failure::{Failure, about_file};

/// Writes a script that completes commands and options in a shell.
pub fn completions(arguments: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "alhazen", &mut script);
    Ok(say(String::from_utf8_lossy(&script).trim_end())?)
}

/// Writes one man page, or those of all commands into a folder.
pub fn man(arguments: &Man) -> Result<(), Failure> {
    match &arguments.folder {
        Some(folder) => pages(folder).map_err(|error| about_file(folder, error)),
        None => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Cli::command())
                .render(&mut page)
                .map_err(|error| Failure::Input(format!("cannot make the man page: {error}")))?;
            Ok(say(String::from_utf8_lossy(&page).trim_end())?)
        }
    }
}

fn pages(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    clap_mangen::generate_to(Cli::command(), folder)
}
