//! `alhazen doctor`: what the program finds on this machine, and what that means for a render.

use std::path::Path;

#[cfg(feature = "gpu")]
use alhazen::device::Device;
use alhazen::lanes::InstructionSet;
use alhazen::{available_threads, most_threads};
use serde_json::{Map, Value, json};

use crate::args::Doctor;
use crate::console::say;
use crate::failure::Failure;
use crate::limits::{Memory, MemoryLimit};
use crate::numbers::bytes;
use crate::output;

/// Less free space than this is reported: a picture of many layers may not fit.
const LITTLE_SPACE: u64 = 1 << 30;

/// The program of Open Image Denoise.
const DENOISER: &str = "oidnDenoise";

/// Something that was looked for.
struct Finding {
    name: &'static str,
    /// What was found.
    text: String,
    /// What follows from it, where it is not what is best.
    note: Option<String>,
    /// The same as `text`, for programs.
    values: Value,
}

/// Reports what was found.
pub fn doctor(arguments: &Doctor) -> Result<(), Failure> {
    let found = [build(), threads(), instruction_set(), memory(), folder(), gpu(), denoiser()];
    if arguments.json {
        let mut checks = Map::new();
        for Finding { name, note, mut values, .. } in found {
            values["note"] = json!(note);
            checks.insert(name.replace(' ', "_"), values);
        }
        let version = env!("ALHAZEN_VERSION");
        return Ok(say(json!({ "status": "done", "version": version, "checks": checks }))?);
    }
    let mut text = format!("alhazen {}", env!("ALHAZEN_VERSION"));
    for Finding { name, text: value, note, .. } in found {
        text += &format!("\n  {name:<16} {value}");
        if let Some(note) = note {
            text += &format!("\n  {:<16} → {note}", "");
        }
    }
    Ok(say(text)?)
}

fn build() -> Finding {
    let (system, architecture) = (std::env::consts::OS, std::env::consts::ARCH);
    let has_assertions = cfg!(debug_assertions);
    let kind = if has_assertions { "with assertions" } else { "for release" };
    Finding {
        name: "build",
        text: format!("{kind}, {system}, {architecture}"),
        note: has_assertions.then(|| "slower than `cargo build --release`; pictures are the same".into()),
        values: json!({ "assertions": has_assertions, "system": system, "architecture": architecture }),
    }
}

fn threads() -> Finding {
    let (threads, most) = (available_threads(), most_threads());
    Finding {
        name: "threads",
        text: format!("{threads}, --threads up to {most}"),
        note: None,
        values: json!({ "available": threads, "most": most }),
    }
}

fn instruction_set() -> Finding {
    let name = |set: InstructionSet| format!("{set:?}").to_lowercase();
    let used = InstructionSet::detect();
    let best = InstructionSet::ALL.into_iter().find(|set| set.is_available()).unwrap_or(used);
    let note = (used != best)
        .then(|| format!("chosen by {}; {} is the best here", InstructionSet::VARIABLE, name(best)));
    Finding {
        name: "instruction set",
        text: format!("{}; pictures have the same bits with all", name(used)),
        note,
        values: json!({ "used": name(used), "best": name(best) }),
    }
}

fn memory() -> Finding {
    let Memory { total, available, limit } = Memory::of_system(Path::new("/"));
    let text = match (total, available) {
        (Some(total), Some(available)) => format!("{}, {} available", bytes(total), bytes(available)),
        _ => "unknown: the system does not tell".into(),
    };
    let (text, note) = match limit {
        None => (text, None),
        Some(MemoryLimit::ControlGroup(most)) => (
            format!("{text}; {} for this control group", bytes(most)),
            Some("the system kills a render that needs more; --checkpoint keeps what was done".to_owned()),
        ),
        Some(MemoryLimit::AddressSpace(most)) => (
            format!("{text}; {} of addresses (ulimit -v)", bytes(most)),
            Some("a render that needs more ends with an error, and with the picture so far".to_owned()),
        ),
    };
    let (kind, most) = match limit {
        None => (None, None),
        Some(MemoryLimit::ControlGroup(most)) => (Some("control-group"), Some(most)),
        Some(MemoryLimit::AddressSpace(most)) => (Some("address-space"), Some(most)),
    };
    Finding {
        name: "memory",
        text,
        note,
        values: json!({
            "total_bytes": total, "available_bytes": available, "limit": kind, "limit_bytes": most,
        }),
    }
}

/// The folder where pictures are written unless --output names another.
fn folder() -> Finding {
    let path = std::env::current_dir().unwrap_or_default();
    let problem = output::check_place(&path.join("alhazen.exr")).err();
    let free = free_space(&path);
    let writable = if problem.is_none() { "writable" } else { "not writable" };
    let space = free.map_or(String::new(), |free| format!(", {} free", bytes(free)));
    let note = match &problem {
        Some(problem) => Some(format!("{problem}; --output names a file elsewhere")),
        None if free.is_some_and(|free| free < LITTLE_SPACE) => {
            Some("large pictures and film files may not fit; --output names a file elsewhere".into())
        }
        None => None,
    };
    let shown = path.display().to_string();
    Finding {
        name: "folder",
        text: format!("{shown}, {writable}{space}"),
        note,
        values: json!({ "path": shown, "writable": problem.is_none(), "free_bytes": free }),
    }
}

#[cfg(unix)]
fn free_space(folder: &Path) -> Option<u64> {
    let space = rustix::fs::statvfs(folder).ok()?;
    Some(space.f_bavail.saturating_mul(space.f_frsize))
}

#[cfg(not(unix))]
fn free_space(_: &Path) -> Option<u64> {
    None
}

#[cfg(feature = "gpu")]
fn gpu() -> Finding {
    let (text, note, name) = match Device::open("") {
        Ok(device) if device.is_software() => {
            let note = "it is no faster than the processor, which renders by default";
            (format!("{}, in software", device.name()), Some(note), Some(device.name().to_owned()))
        }
        Ok(device) => {
            let note = "--device gpu renders with it; what it cannot draw is left to the processor";
            (device.name().to_owned(), Some(note), Some(device.name().to_owned()))
        }
        Err(error) => (error.to_string(), Some("all algorithms run on the processor"), None),
    };
    Finding { name: "GPU", text, note: note.map(str::to_owned), values: json!({ "name": name }) }
}

#[cfg(not(feature = "gpu"))]
fn gpu() -> Finding {
    Finding {
        name: "GPU",
        text: "not used by this build".into(),
        note: Some("all algorithms run on the processor; builds with the feature `gpu` use GPUs, too".into()),
        values: json!({ "name": null }),
    }
}

/// Open Image Denoise, whose program removes noise from finished pictures.
fn denoiser() -> Finding {
    let file = format!("{DENOISER}{}", std::env::consts::EXE_SUFFIX);
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let program =
        std::env::split_paths(&folders).map(|folder| folder.join(&file)).find(|path| path.is_file());
    let (text, note) = match &program {
        Some(path) => (
            path.display().to_string(),
            "it reads pictures that are written with --output in the format .pfm",
        ),
        None => (
            format!("`{DENOISER}` is not in the search path"),
            "nothing here needs it; more samples remove noise",
        ),
    };
    let path = program.map(|path| path.display().to_string());
    Finding { name: "denoiser", text, note: Some(note.into()), values: json!({ "path": path }) }
}
