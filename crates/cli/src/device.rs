//! `--device`: which machine part renders.

use std::env;
use std::path::Path;
use std::sync::Arc;

use alhazen::Job;
use alhazen::description::{Diagnostic, Span};
use alhazen::device::{Device, Kernels};
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
    /// The same, whose hardware traces rays.
    RayQuery,
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

/// Turns off the layer of Mesa that asks displays which GPU is theirs, where no Wayland can be: its
/// library would print that it lacks `XDG_RUNTIME_DIR`. The program does this before all else.
#[expect(unsafe_code, reason = "only the environment reaches a layer of Vulkan")]
pub fn silence_layers() {
    let runtime = env::var_os("XDG_RUNTIME_DIR");
    if cfg!(target_os = "linux") && !runtime.is_some_and(|folder| Path::new(&folder).is_absolute()) {
        // SAFETY: no other thread uses the environment yet: Python has those of numpy at most.
        unsafe { env::set_var("NODEVICE_SELECT", "1") };
    }
}

/// Moves a job to the chosen device; the device and its memory, unless that is the CPU. Where it
/// cannot be, the job is as before, and the warnings say why.
pub fn choose(choice: DeviceChoice, job: &mut Job, warnings: &mut Vec<Diagnostic>) -> Option<String> {
    let kernels = kernels(choice, warnings)?;
    match job.move_to(&kernels) {
        Ok(of_move) => warnings.extend(of_move),
        Err(refusals) => {
            warnings.extend(refusals);
            return None;
        }
    }
    let notes = job.session.integrator().summary();
    Some(notes.iter().map(|(name, value)| format!("{name} {value}")).collect::<Vec<_>>().join(", "))
}

/// The chosen device, unless that is the CPU; the warnings say why there is none, or not all of it.
pub fn kernels(choice: DeviceChoice, warnings: &mut Vec<Diagnostic>) -> Option<Arc<Kernels>> {
    let mut warn = |code, problem| warnings.push(Diagnostic::warning(code, problem, Span::NONE));
    let opened = match choice {
        DeviceChoice::Cpu => return None,
        DeviceChoice::RayQuery => Device::for_ray_queries(""),
        DeviceChoice::Gpu | DeviceChoice::Auto => Device::open(""),
    };
    let device = opened.map_err(|error| warn("not-on-gpu", error.to_string())).ok()?;
    if choice == DeviceChoice::Auto && device.is_software() {
        let name = device.name();
        warn("not-on-gpu", format!("{name} is a GPU in software, slower than the CPU itself"));
        return None;
    }
    if choice == DeviceChoice::RayQuery && !device.has_ray_queries() {
        let name = device.name();
        warn("no-ray-queries", format!("{name} has no ray queries: its kernels trace rays themselves"));
    }
    Some(Arc::new(Kernels::new(device)))
}
