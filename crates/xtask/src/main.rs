//! Chores of the project.

mod rgb_table;

use std::process::ExitCode;

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        Some("rgb-table") => report(rgb_table::run()),
        _ => {
            eprintln!("usage: cargo xtask rgb-table");
            ExitCode::from(2)
        }
    }
}

/// Success, or the error printed.
fn report(result: std::io::Result<()>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
