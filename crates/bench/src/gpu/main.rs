//! `gpu`: what alhazen does with a GPU in a second, and beside the CPU.
//!
//! One program without files beside it, so that it can be carried to a machine with a GPU.

mod frames;
mod many_lights;
mod pictures;
mod rays;
mod scenes;
mod spheres;

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use alhazen::device::{Device, Kernels};
use clap::Parser;
use clap::builder::PossibleValuesParser;
use serde_json::{Value, json};

/// What a GPU does, as JSON: rays, triangles and spheres in a second, light samples that pixels
/// share, and pictures beside the CPU's.
#[derive(Parser)]
#[command(name = "cargo xtask bench gpu")]
struct Arguments {
    /// Parts to measure; by default all of them.
    #[arg(value_name = "PART", value_parser = PossibleValuesParser::new(PARTS.map(|(name, _)| name)))]
    parts: Vec<String>,
    /// Small pictures and few spheres, for a GPU in software.
    #[arg(long)]
    quick: bool,
    /// A part of the GPU's name. [default: the fastest kind]
    #[arg(long, value_name = "NAME", default_value = "", hide_default_value = true)]
    device: String,
    /// The file of the report, written again after each part. [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// How much is measured.
pub struct Size {
    /// Width and height of pictures.
    resolution: [u32; 2],
    /// Frames of which medians are reported.
    frames: u32,
    /// The square root of the number of camera rays, and how often they are traced.
    rays: usize,
    repeats: u32,
    /// How long they are traced before they are timed.
    warming: Duration,
    /// Spheres that move.
    spheres: usize,
    /// Frames that are the reference of many lights.
    reference: u32,
    /// Passes of pictures by the GPU and by the CPU.
    passes: [u32; 2],
}

const FULL: Size = Size {
    resolution: [1920, 1080],
    frames: 60,
    rays: 1920,
    repeats: 20,
    warming: Duration::from_millis(400),
    spheres: 1_000_000,
    reference: 100,
    passes: [16, 2],
};

const QUICK: Size = Size {
    resolution: [96, 54],
    frames: 3,
    rays: 128,
    repeats: 2,
    warming: Duration::ZERO,
    spheres: 10_000,
    reference: 20,
    passes: [2, 1],
};

/// Measures a part.
type Measure = fn(&Arc<Kernels>, &Size) -> Result<Value, String>;

const PARTS: [(&str, Measure); 5] = [
    ("rays", rays::measure),
    ("triangles", frames::measure),
    ("spheres", spheres::measure),
    ("lights", many_lights::measure),
    ("pictures", pictures::measure),
];

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let device = Device::open(&arguments.device).map_err(|error| error.to_string())?;
    let size = if arguments.quick { QUICK } else { FULL };
    let mut report = json!({
        "device": device.name(),
        "is_software": device.is_software(),
        "is_quick": arguments.quick,
        "cpu_threads": rayon::current_num_threads(),
    });
    let kernels = Arc::new(Kernels::new(device));
    for (name, measure) in PARTS {
        if !arguments.parts.is_empty() && arguments.parts.iter().all(|part| part != name) {
            continue;
        }
        eprintln!("{name} …");
        // What one part cannot do does not keep others from being measured.
        report[name] = measure(&kernels, &size).unwrap_or_else(|error| json!({ "error": error }));
        if let Some(file) = &arguments.output {
            let written = fs::write(file, format!("{report:#}\n"));
            written.map_err(|error| format!("{}: {error}", file.display()))?;
        }
    }
    if arguments.output.is_none() {
        println!("{report:#}");
    }
    Ok(())
}

/// The median, the upper one of two; 0 of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}
