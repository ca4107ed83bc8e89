//! The summary of a render, as text and as a JSON object.

use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use alhazen::integrators::{Progress, Session, Stop};
use serde_json::{Value, json};

use crate::numbers::{bytes, count, duration};

/// The summary of a render.
pub struct Summary<'a> {
    /// The limit that ended it; `None` where it was interrupted.
    pub ended_by: Option<Stop>,
    /// The scene file.
    pub scene: &'a Path,
    /// The pictures.
    pub outputs: &'a [PathBuf],
    /// What was written beside them.
    pub beside: &'a [PathBuf],
    /// The film file from which the render can be resumed.
    pub checkpoint: Option<&'a Path>,
    /// Notes on the render, by the algorithm or others.
    pub notes: &'a [(&'static str, String)],
    /// The algorithm's name.
    pub integrator: &'static str,
    /// The render.
    pub session: &'a Session,
    /// Threads that rendered.
    pub threads: usize,
    /// The time of each stage.
    pub seconds: Seconds,
    /// The peak memory use in bytes; `None` where the system does not report it.
    pub peak_memory: Option<u64>,
}

/// The time of each stage, in seconds.
pub struct Seconds {
    /// Reading files.
    pub import: f64,
    /// Compiling the scene.
    pub compile: f64,
    /// Rendering.
    pub render: f64,
    /// Writing pictures.
    pub write: f64,
}

impl Seconds {
    fn total(&self) -> f64 {
        self.import + self.compile + self.render + self.write
    }
}

impl Summary<'_> {
    fn progress(&self) -> Progress {
        self.session.progress()
    }

    /// The noise of the picture, where it was estimated.
    fn noise(&self) -> Option<f64> {
        self.session.state().noise()
    }

    /// The summary as one JSON object; `warnings` are those about the scene.
    pub fn to_json(&self, warnings: Value) -> Value {
        let (progress, state) = (self.progress(), self.session.state());
        let bounds = state.film.pixel_bounds();
        let [width, height] = state.film.full_resolution();
        let stats = progress.stats;
        let (samples, rejected) = (state.sample_count(), state.rejected());
        let path = |path: &Path| path.display().to_string();
        json!({
            "status": if self.ended_by.is_some() { "done" } else { "interrupted" },
            "ended_by": match self.ended_by {
                Some(Stop::Passes) => "passes",
                Some(Stop::Time) => "time",
                Some(Stop::Noise) => "noise",
                None => "interrupt",
            },
            "scene": path(self.scene),
            "outputs": self.outputs.iter().map(|output| path(output)).collect::<Vec<_>>(),
            "by_products": self.beside.iter().map(|output| path(output)).collect::<Vec<_>>(),
            "checkpoint": self.checkpoint.map(path),
            "notes": self.notes.iter().map(|(name, note)| ((*name).to_owned(), json!(note))).collect::<serde_json::Map<_, _>>(),
            "integrator": self.integrator,
            "samples_per_pixel": state.done.count(),
            "noise": self.noise(),
            "resolution": [width, height],
            "pixel_bounds": [bounds.min[0], bounds.max[0], bounds.min[1], bounds.max[1]],
            "passes": progress.pass,
            "samples": samples,
            "non_finite_samples": rejected.count,
            "non_finite_pixels": rejected.pixels().collect::<Vec<_>>(),
            "rays": stats.rays,
            "rays_per_second": self.rays_per_second(),
            "extent_tests": stats.extents,
            "primitive_tests": stats.primitives,
            "threads": self.threads,
            "seconds": {
                "import": self.seconds.import,
                "compile": self.seconds.compile,
                "render": self.seconds.render,
                "write": self.seconds.write,
                "total": self.seconds.total(),
            },
            "peak_memory_bytes": self.peak_memory,
            "warnings": warnings,
        })
    }

    /// The message about an interruption, if there was one.
    pub fn interruption(&self) -> Option<String> {
        let Progress { pass, passes, .. } = self.progress();
        let picture = if self.outputs.is_empty() { "" } else { "; the picture so far is written" };
        let all = if passes == u32::MAX { String::new() } else { format!(" of {passes}") };
        let goes_on = match self.checkpoint {
            Some(path) => format!("; `alhazen resume {}` continues from the last checkpoint", path.display()),
            None => String::new(),
        };
        self.ended_by.is_none().then(|| format!("interrupted after {pass}{all} passes{picture}{goes_on}"))
    }

    fn rays_per_second(&self) -> f64 {
        let Progress { stats, elapsed, .. } = self.progress();
        stats.rays as f64 / elapsed.as_secs_f64().max(1e-9)
    }
}

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (progress, state) = (self.progress(), self.session.state());
        let bounds = state.film.pixel_bounds();
        let [width, height] = state.film.full_resolution();
        if let Some(interruption) = self.interruption() {
            writeln!(f, "{interruption}")?;
        }
        write!(f, "{}: {}, ", self.scene.display(), self.integrator)?;
        let samples_per_pixel = state.done.count();
        let plural = if samples_per_pixel == 1 { "" } else { "s" };
        write!(f, "{samples_per_pixel} sample{plural} per pixel, {width} × {height} pixels")?;
        if bounds.area() != width as usize * height as usize {
            let [[x0, y0], [x1, y1]] = [bounds.min, bounds.max];
            write!(f, ", of them x {x0} to {}, y {y0} to {}", x1 - 1, y1 - 1)?;
        }
        writeln!(f)?;
        for output in self.outputs {
            writeln!(f, "  picture  {}", output.display())?;
        }
        if let Some(path) = self.checkpoint {
            writeln!(f, "  film     {}", path.display())?;
        }
        if let [first, .., last] = self.beside {
            writeln!(
                f,
                "  beside   {} files, from {} to {}",
                self.beside.len(),
                first.display(),
                last.display()
            )?;
        } else if let [only] = self.beside {
            writeln!(f, "  beside   {}", only.display())?;
        }
        let Seconds { import, compile, render, write } = self.seconds;
        let [total, import, compile, render, write] = [self.seconds.total(), import, compile, render, write]
            .map(|seconds| duration(Duration::from_secs_f64(seconds)));
        writeln!(
            f,
            "  time     {total} (import {import}, compile {compile}, render {render}, write {write})"
        )?;
        if let Some(memory) = self.peak_memory {
            writeln!(f, "  memory   {} at most", bytes(memory))?;
        }
        match (self.ended_by, self.noise()) {
            (_, None) => (),
            (Some(Stop::Noise), Some(noise)) => writeln!(f, "  noise    {noise:.4}, limit reached")?,
            (_, Some(noise)) => writeln!(f, "  noise    {noise:.4}")?,
        }
        let stats = progress.stats;
        let rays = stats.rays as f64;
        let (samples, rejected) = (state.sample_count(), state.rejected());
        if samples > 0 {
            writeln!(f, "  samples  {}", count(samples as f64))?;
        }
        write!(
            f,
            "  rays     {}, {} per second; {:.1} extent tests and {:.1} primitive tests per ray",
            count(rays),
            count(self.rays_per_second()),
            stats.extents as f64 / rays.max(1.0),
            stats.primitives as f64 / rays.max(1.0),
        )?;
        for (name, note) in self.notes {
            write!(f, "\n  {name:<8} {note}")?;
        }
        if rejected.count > 0 {
            write!(f, "\n  warning  {rejected}; `--pixel X,Y` renders one alone")?;
        }
        Ok(())
    }
}

/// The peak memory use of this process in bytes, as Linux reports it.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}
