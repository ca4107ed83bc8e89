//! `--device`: which machine part renders.

use std::sync::Arc;

use alhazen::Job;
use alhazen::description::{Diagnostic, Span};
use alhazen::device::{Device, Kernels, Schedule};
use alhazen::realtime::Weights;
use clap::ValueEnum;

/// What renders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum DeviceChoice {
    /// The processor.
    #[default]
    Cpu,
    /// The graphics processor.
    Gpu,
    /// The graphics processor if it draws the scene, and is none in software.
    Auto,
}

/// How samples of direct light count that pixels and frames share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Restir {
    /// So that the picture is right in the mean.
    Unbiased,
    /// By their number alone.
    Biased,
}

impl From<Restir> for Weights {
    fn from(restir: Restir) -> Self {
        match restir {
            Restir::Unbiased => Self::Unbiased,
            Restir::Biased => Self::Biased,
        }
    }
}

/// Moves a job to the chosen device; the device and its memory, unless that is the CPU. Where it
/// cannot be, the job is as before, and the warnings say why.
pub fn choose(choice: DeviceChoice, job: &mut Job) -> Result<Option<String>, Vec<Diagnostic>> {
    let Some(kernels) = kernels(choice)? else { return Ok(None) };
    job.move_to(&kernels, Schedule::default())?;
    let notes = job.session.integrator().summary();
    Ok(Some(notes.iter().map(|(name, value)| format!("{name} {value}")).collect::<Vec<_>>().join(", ")))
}

/// The chosen device, unless that is the CPU; the warnings say why there is none.
pub fn kernels(choice: DeviceChoice) -> Result<Option<Arc<Kernels>>, Vec<Diagnostic>> {
    if choice == DeviceChoice::Cpu {
        return Ok(None);
    }
    let cannot = |problem: String| vec![Diagnostic::warning("not-on-gpu", problem, Span::NONE)];
    let device = Device::open("").map_err(|error| cannot(error.to_string()))?;
    if choice == DeviceChoice::Auto && device.is_software() {
        return Err(cannot(format!("{} is a GPU in software, slower than the CPU itself", device.name())));
    }
    Ok(Some(Arc::new(Kernels::new(device))))
}
