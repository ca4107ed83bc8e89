//! What a render has done: the closing words to people, and the JSON object to programs.

use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use alhazen::film::Film;
use alhazen::integrators::Progress;
use serde_json::{Value, json};

use crate::numbers::{bytes, count, duration};

/// What a render has done.
pub struct Summary<'a> {
    /// Whether it was stopped before its end.
    pub interrupted: bool,
    /// The scene file.
    pub scene: &'a Path,
    /// The pictures.
    pub outputs: &'a [PathBuf],
    /// What was written beside them.
    pub beside: &'a [PathBuf],
    /// What the algorithm tells of itself.
    pub notes: &'a [(&'static str, String)],
    /// The algorithm's name.
    pub integrator: &'static str,
    /// Samples per pixel of the whole picture.
    pub samples_per_pixel: u32,
    /// The film with what came in.
    pub film: &'a Film,
    /// How far the render came.
    pub progress: Progress,
    /// Threads that rendered.
    pub threads: usize,
    /// How long each stage took.
    pub seconds: Seconds,
    /// The most memory that was in use, in bytes; `None` where the system does not tell.
    pub peak_memory: Option<u64>,
}

/// How long each stage took, in seconds.
pub struct Seconds {
    /// Reading files.
    pub import: f64,
    /// Making the scene.
    pub compile: f64,
    /// Following light.
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
    /// The summary as one JSON object; `warnings` are those about the scene.
    pub fn to_json(&self, warnings: Value) -> Value {
        let bounds = self.film.pixel_bounds();
        let [width, height] = self.film.full_resolution();
        let stats = self.progress.stats;
        let rejected = self.film.rejected();
        json!({
            "status": if self.interrupted { "interrupted" } else { "done" },
            "scene": self.scene.display().to_string(),
            "outputs": self.outputs.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
            "by_products": self.beside.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
            "notes": self.notes.iter().map(|(name, note)| ((*name).to_owned(), json!(note))).collect::<serde_json::Map<_, _>>(),
            "integrator": self.integrator,
            "samples_per_pixel": self.samples_per_pixel,
            "resolution": [width, height],
            "pixel_bounds": [bounds.min[0], bounds.max[0], bounds.min[1], bounds.max[1]],
            "passes": self.progress.pass,
            "samples": self.film.sample_count(),
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

    /// What is to say where the render was stopped before its end.
    pub fn interruption(&self) -> Option<String> {
        let (done, all) = (self.progress.pass, self.progress.passes);
        self.interrupted
            .then(|| format!("interrupted after {done} of {all} passes; the picture is written as it stands"))
    }

    fn rays_per_second(&self) -> f64 {
        self.progress.stats.rays as f64 / self.progress.elapsed.as_secs_f64().max(1e-9)
    }
}

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bounds = self.film.pixel_bounds();
        let [width, height] = self.film.full_resolution();
        if let Some(interruption) = self.interruption() {
            writeln!(f, "{interruption}")?;
        }
        write!(f, "{}: {}, ", self.scene.display(), self.integrator)?;
        let plural = if self.samples_per_pixel == 1 { "" } else { "s" };
        write!(f, "{} sample{plural} per pixel, {width} × {height} pixels", self.samples_per_pixel)?;
        if bounds.area() != width as usize * height as usize {
            let [[x0, y0], [x1, y1]] = [bounds.min, bounds.max];
            write!(f, ", of them x {x0} to {}, y {y0} to {}", x1 - 1, y1 - 1)?;
        }
        writeln!(f)?;
        for output in self.outputs {
            writeln!(f, "  picture  {}", output.display())?;
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
        let stats = self.progress.stats;
        let rays = stats.rays as f64;
        let samples = self.film.sample_count();
        if samples > 0 {
            writeln!(f, "  samples  {}", count(samples as f64))?;
        }
        write!(
            f,
            "  rays     {}, {} a second; {:.1} extent tests and {:.1} primitive tests a ray",
            count(rays),
            count(self.rays_per_second()),
            stats.extents as f64 / rays.max(1.0),
            stats.primitives as f64 / rays.max(1.0),
        )?;
        for (name, note) in self.notes {
            write!(f, "\n  {name:<8} {note}")?;
        }
        let rejected = self.film.rejected();
        if rejected.count > 0 {
            let pixels: Vec<_> = rejected.pixels().map(|[x, y]| format!("{x},{y}")).collect();
            let first = if pixels.len() as u64 == rejected.count { "at" } else { "among them at" };
            write!(f, "\n  warning  {} samples were no numbers and are left out, {first} ", rejected.count)?;
            write!(f, "{}; `--pixel X,Y` renders one alone", pixels.join(" "))?;
        }
        Ok(())
    }
}

/// The most memory that this process has had in use, in bytes; Linux tells it.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}
