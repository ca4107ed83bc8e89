//! Checks, and the tests that a plain `cargo test` leaves out, cheapest first; the first failure
//! ends the run.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use super::command::{QUICK_KERNELS, cargo, succeed};
use super::{gallery, python, tidy};

/// The features of all that is checked, and of all that is tested.
const CHECKED: &str = "alhazen-cli/full,alhazen-bench/gpu";
const TESTED: &str = "alhazen-cli/portable,alhazen-cli/gpu";

/// Crates beside the program, and those of the program whose tests depend on features.
const TESTS: &str = "-p alhazen-bench -p alhazen-cli -p alhazen-gpu -p alhazen-import -p alhazen-python \
                     -p alhazen-showcase -p alhazen-translate -p alhazen-view -p xtask";

/// The names of steps, and what they ask of cargo. All have the profile of `cargo test`, so that
/// what both build is built once. Lints and documentation share one check of the workspace, which
/// has the window; tests do without.
fn steps() -> [(&'static str, String); 5] {
    let lints = "--all-targets --keep-going -- -D warnings";
    [
        ("format", "fmt --all --check".into()),
        ("lints", format!("clippy --quiet --workspace --features {CHECKED} {lints}")),
        ("documentation", format!("doc --quiet --workspace --features {CHECKED} --no-deps --lib")),
        ("lints without features", format!("clippy --quiet {lints}")),
        ("tests", format!("test {TESTS} --features {TESTED} --no-fail-fast")),
    ]
}

/// What steps find in their environment.
const ENVIRONMENT: [(&str, &str); 2] = [("RUSTDOCFLAGS", "-D warnings"), QUICK_KERNELS];

/// One more than there are cores, because a test may wait for a kernel that another one compiles.
fn test_threads() -> usize {
    std::thread::available_parallelism().map_or(1, |cores| cores.get()) + 1
}

/// Runs all steps in the workspace at `root`.
pub fn run(root: &Path) -> Result<(), String> {
    let start = Instant::now();
    install_components(root)?;
    install_vulkan();
    step("source rules", || tidy::run(root))?;
    for (name, arguments) in steps() {
        let mut cargo = cargo(root);
        cargo.args(arguments.split_whitespace()).envs(ENVIRONMENT);
        step(name, || succeed(cargo.env("RUST_TEST_THREADS", test_threads().to_string())))?;
    }
    step("gallery", || gallery::check(root))?;
    step("tests of the Python package", || python::test(root))?;
    println!("all passed in {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Shows a step's name before it and its time after it.
fn step(name: &str, work: impl FnOnce() -> Result<(), String>) -> Result<(), String> {
    println!("== {name}");
    let start = Instant::now();
    work().map_err(|error| format!("{name}: {error}"))?;
    println!("== {name}: {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Adds the formatter and the linter where Rust was installed without them.
fn install_components(root: &Path) -> Result<(), String> {
    for (command, component) in [("fmt", "rustfmt"), ("clippy", "clippy")] {
        let found = cargo(root).args([command, "--version"]).output();
        if !found.is_ok_and(|output| output.status.success()) {
            println!("== installing {component}");
            succeed(Command::new("rustup").args(["component", "add", component]).current_dir(root))?;
        }
    }
    Ok(())
}

/// Installs a Vulkan driver in software, for the tests of the GPU engine, where there is no driver
/// and this may install one; else those tests say that they are skipped.
fn install_vulkan() {
    let drivers = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"].map(Path::new);
    if !cfg!(target_os = "linux") || drivers.iter().any(|folder| folder.exists()) {
        return;
    }
    println!("== installing Vulkan in software");
    let packages = ["mesa-vulkan-drivers", "libvulkan1"];
    let install = |arguments: &[&str]| {
        let mut command = Command::new("apt-get");
        succeed(command.args(arguments).stdout(Stdio::null()).env("DEBIAN_FRONTEND", "noninteractive"))
    };
    let installed = install(&["install", "--yes", packages[0], packages[1]]).or_else(|_| {
        install(&["update"])?;
        install(&["install", "--yes", packages[0], packages[1]])
    });
    if let Err(error) = installed {
        println!("== no Vulkan: {error}");
    }
}
