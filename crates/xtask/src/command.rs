//! Running other programs.

use std::path::{Path, PathBuf};
use std::process::Command;

/// What tests find in their environment. Vulkan in software takes most of the time of a test for
/// compiling kernels that run for a moment; Mesa's does that faster without optimising them.
pub const QUICK_KERNELS: (&str, &str) = ("GALLIVM_PERF", "nopt");

/// The cargo that runs this program, so that one toolchain does all, in the workspace at `root`.
pub fn cargo(root: &Path) -> Command {
    let mut command = Command::new(std::env::var("CARGO").unwrap_or_else(|_| "cargo".into()));
    command.current_dir(root);
    command
}

/// The folder of everything that is built, for the workspace at `root`.
pub fn target(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), |folder| root.join(folder))
}

/// Runs a command and waits for it.
pub fn succeed(command: &mut Command) -> Result<(), String> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?} ended with {status}")),
        Err(error) => Err(format!("{command:?} did not start: {error}")),
    }
}

/// The interpreter of a Python environment with these packages, which is made if it is missing.
pub fn python_environment(folder: &Path, packages: &[&str]) -> Result<PathBuf, String> {
    let (python, programs) = if cfg!(windows) { ("python", "Scripts") } else { ("python3", "bin") };
    let own = folder.join(programs).join(python);
    let complete = folder.join("complete");
    let installed = std::fs::read_to_string(&complete).unwrap_or_default();
    if installed != packages.join("\n") {
        eprintln!("installing {} into {}", packages.join(", "), folder.display());
        succeed(Command::new(python).args(["-m", "venv"]).arg(folder))?;
        succeed(Command::new(&own).args(["-m", "pip", "install", "--quiet"]).args(packages))?;
        std::fs::write(&complete, packages.join("\n")).map_err(|error| error.to_string())?;
    }
    Ok(own)
}
