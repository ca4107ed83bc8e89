//! The progress bar: passes, samples, rays per second, noise, elapsed and remaining time. Shown on
//! a terminal only.

use std::time::Duration;

use alhazen::integrators::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::numbers::count;

/// Times a second that the bar is redrawn at most.
const REFRESH_RATE: u8 = 10;

/// A progress bar.
pub struct Bar(ProgressBar);

impl Bar {
    /// A bar that is `shown`, or not.
    pub fn new(shown: bool) -> Self {
        Self::named(shown, "")
    }

    /// A bar with a name before it.
    pub fn named(shown: bool, name: &str) -> Self {
        let target = if shown {
            ProgressDrawTarget::stderr_with_hz(REFRESH_RATE)
        } else {
            ProgressDrawTarget::hidden()
        };
        let prefix = if name.is_empty() { String::new() } else { format!("{name} ") };
        let bar = ProgressBar::with_draw_target(Some(0), target).with_prefix(prefix);
        let style = ProgressStyle::with_template(
            "{prefix}{wide_bar} pass {pos} of {len}{msg}  {elapsed} elapsed, {eta} left",
        )
        .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style.progress_chars("=> "));
        bar.enable_steady_tick(Duration::from_millis(250));
        Self(bar)
    }

    /// Shows how far the render is.
    pub fn show(&self, progress: &Progress) {
        let rays_per_second = progress.stats.rays as f64 / progress.elapsed.as_secs_f64().max(1e-9);
        // Where time or noise is the limit, the number of passes is an estimate that changes.
        let passes = if progress.passes == u32::MAX { progress.pass } else { progress.passes };
        self.0.set_length(passes.into());
        self.0.set_position(progress.pass.into());
        let [samples, rays] = [progress.samples as f64, rays_per_second].map(count);
        let noise = progress.noise.map_or(String::new(), |noise| format!(", noise {noise:.4}"));
        self.0.set_message(format!(", {samples} samples, {rays} rays/s{noise}"));
    }

    /// Writes to the terminal while the bar is not there.
    pub fn suspend<R>(&self, write: impl FnOnce() -> R) -> R {
        self.0.suspend(write)
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
