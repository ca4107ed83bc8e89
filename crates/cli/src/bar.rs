//! The progress bar: passes, samples, rays per second, elapsed and remaining time. Shown on a
//! terminal only.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use alhazen::integrators::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::numbers::count;

/// Times a second that the bar is redrawn at most.
const REFRESH_RATE: u8 = 10;

/// A progress bar, and the last progress that was told to it.
pub struct Bar {
    bar: ProgressBar,
    last: Mutex<Progress>,
}

impl Bar {
    /// A bar of `passes` passes that is `shown`, or not.
    pub fn new(shown: bool, passes: u32) -> Self {
        Self::with_prefix(shown, passes, "")
    }

    /// A bar with a name before it, whose passes are not known yet.
    pub fn named(shown: bool, name: &str) -> Self {
        Self::with_prefix(shown, 0, &format!("{name} "))
    }

    fn with_prefix(shown: bool, passes: u32, prefix: &str) -> Self {
        let target = if shown {
            ProgressDrawTarget::stderr_with_hz(REFRESH_RATE)
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(passes.into()), target).with_prefix(prefix.to_owned());
        let style = ProgressStyle::with_template(
            "{prefix}{wide_bar} pass {pos} of {len}{msg}  {elapsed} gone, {eta} left",
        )
        .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style.progress_chars("=> "));
        bar.enable_steady_tick(Duration::from_millis(250));
        Self { bar, last: Mutex::new(Progress { passes, ..Progress::default() }) }
    }

    /// Shows how far the render is.
    pub fn show(&self, progress: &Progress) {
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = *progress;
        let rays_per_second = progress.stats.rays as f64 / progress.elapsed.as_secs_f64().max(1e-9);
        // Where time is the limit, the number of passes is a guess that grows better.
        self.bar.set_length(progress.passes.into());
        self.bar.set_position(progress.pass.into());
        let [samples, rays] = [progress.samples as f64, rays_per_second].map(count);
        self.bar.set_message(format!(", {samples} samples, {rays} rays/s"));
    }

    /// Takes the bar away; tells how far the render came.
    pub fn finish(&self) -> Progress {
        self.bar.finish_and_clear();
        *self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
