//! `rays`: alhazen's ray engine compared with Embree on the same meshes and rays.

use alhazen_bench::embree::Embree;
use alhazen_bench::mesh::BenchMesh;
use alhazen_bench::{building, tracing};
use clap::Parser;
use clap::builder::{PossibleValuesParser, RangedU64ValueParser};
use std::error::Error;
use std::ffi::OsString;
use std::process::ExitCode;

/// Million rays per second on one thread, build times and memory: alhazen's, Embree's and their
/// ratios.
#[derive(Parser)]
#[command(name = "cargo xtask bench rays")]
struct Arguments {
    /// Meshes to measure; by default all of them, and spheres.
    #[arg(value_name = "MESH", value_parser = PossibleValuesParser::new(BenchMesh::NAMES))]
    meshes: Vec<String>,
    /// Number of measurements, of which the median is reported.
    #[arg(long, default_value_t = 7, value_parser = RangedU64ValueParser::<usize>::new().range(1..))]
    repeats: usize,
    /// Trace a sixteenth of the rays.
    #[arg(long)]
    quick: bool,
    /// Embree's shared library; without it, alhazen alone is measured.
    #[arg(long, value_name = "FILE")]
    embree: Option<OsString>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let embree = arguments.embree.as_deref().map(Embree::load).transpose()?;
    if embree.is_none() {
        println!("Embree's library is not given: alhazen alone is measured.\n");
    }
    let wanted =
        |name: &&str| arguments.meshes.is_empty() || arguments.meshes.iter().any(|mesh| mesh == name);
    let width = if arguments.quick { 256 } else { 1024 };
    for mesh in BenchMesh::NAMES.into_iter().filter(wanted).filter_map(BenchMesh::named) {
        println!("{}: {} triangles, medians of {}\n", mesh.name, mesh.indices.len(), arguments.repeats);
        println!("{}", building::table(&mesh, embree.as_ref(), arguments.repeats)?);
        let tracing = tracing::measure(&mesh, embree.as_ref(), width, arguments.repeats)?;
        println!("{}\n{}", tracing.rates(), tracing.answers());
        tracing.check()?;
    }
    if arguments.meshes.is_empty() {
        println!("{}", building::spheres_table(arguments.repeats)?);
    }
    Ok(())
}
