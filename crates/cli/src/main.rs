//! The program `alhazen`.

use std::process::ExitCode;

fn main() -> ExitCode {
    alhazen_cli::run(std::env::args_os().collect())
}
