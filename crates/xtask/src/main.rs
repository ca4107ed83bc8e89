//! Development tasks of the project.

mod bench;
mod ci;
mod command;
mod dist;
mod gallery;
mod profile;
mod python;
mod rgb_table;
mod scenes;
mod tidy;
mod wgsl;

use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask TASK

  ci         all checks: format, source rules, lints, documentation, the gallery, and
             the tests that `cargo test` leaves out
  tidy       the source rules alone, in a second
  docs       write the pages that are made of the code
  bench rays [--help | OPTIONS]
             the ray engine beside Embree, on a million triangles
  bench render [--help | OPTIONS]
             whole renders beside Mitsuba 3: CPU time and error
  bench gpu [--help | OPTIONS]
             a GPU: rays, triangles and moving spheres in a second, and beside the CPU
  bench forest
             memory and time of forests of 10⁶ to 10⁸ triangles
  wheel      build the Python package, into target/wheels
  dist [--static] [--profile] [TARGET]
             archives of the program, and on Debian a package, into target/packages;
             with --static without window and GPU, for any Linux
  gallery [--words] [NAME…]
             the pages of docs/gallery with these in their names, with their pictures;
             with --words the pictures stay as they are
  scenes [NAME…]
             large scenes made of formulas, into target/scenes: car, forest, head,
             planet
  rgb-table  fit the tables that turn RGB into spectra, and write them into the spectrum crate
  wgsl       translate the laws that the GPU engine shares into its shaders";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match arguments[..] {
        ["ci"] => ci::run(workspace()),
        ["tidy"] => tidy::run(workspace()),
        ["bench", "rays", ref arguments @ ..] => bench::rays(workspace(), arguments),
        ["bench", "render", ref arguments @ ..] => bench::render(workspace(), arguments),
        ["bench", "gpu", ref arguments @ ..] => bench::gpu(workspace(), arguments),
        ["bench", "forest"] => bench::forest(workspace()),
        ["docs"] => docs(workspace()),
        ["wheel"] => python::wheel(workspace()),
        ["dist", ref arguments @ ..] => dist::run(workspace(), arguments),
        ["gallery", ref names @ ..] => gallery::make(workspace(), names),
        ["scenes", ref names @ ..] => scenes::run(workspace(), names, showcase::Size::Whole),
        ["wgsl"] => wgsl::run(workspace()),
        ["rgb-table"] => rgb_table::run().map_err(|error| error.to_string()),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Writes what is generated: the tests that compare the pages with the code write them instead.
fn docs(root: &Path) -> Result<(), String> {
    let suites: [&[&str]; 3] = [
        &["--package", "alhazen-pbrt", "--lib"],
        &["--package", "alhazen", "--test", "suite"],
        &["--package", "alhazen-cli", "--features", "gpu", "--lib"],
    ];
    for suite in suites {
        let mut tests = command::cargo(root);
        tests.arg("test").args(suite).arg("is_generated");
        command::succeed(tests.env("ALHAZEN_WRITE_DOCS", "1"))?;
    }
    Ok(())
}

/// The root of the workspace: two folders above this crate.
fn workspace() -> &'static Path {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    crate_folder.ancestors().nth(2).unwrap_or(crate_folder)
}
