//! What a caller says to a render while it runs, and what it hears from it.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use film::Film;
use geometry::RayStats;

/// How far a render is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Passes done.
    pub pass: u32,
    /// Passes to do in all.
    pub passes: u32,
    /// Pixel samples taken in these passes.
    pub samples: u64,
    /// Rays traced in these passes, and what they met.
    pub stats: RayStats,
    /// Time since the render began.
    pub elapsed: Duration,
}

/// Hears how far a render is, on the thread that runs it.
pub type ProgressSink = Box<dyn Fn(&Progress) + Send + Sync>;

/// Sees the film as it stands between two passes, on the thread that runs the render.
pub type FilmSink = Box<dyn Fn(&Film) + Send + Sync>;

/// What a caller holds of a render. The default never stops it and hears nothing.
#[derive(Default)]
pub struct Control {
    /// Set it, from any thread, and the render ends before its next tile.
    pub cancel: Arc<AtomicBool>,
    /// Hears of each pass when it is done.
    pub progress: Option<ProgressSink>,
    /// Sees the film after each pass but the last.
    pub preview: Option<FilmSink>,
    /// Rays of the pass in the making, which would be lost with its result where it is cancelled;
    /// integrators count them.
    pub under_way: Mutex<RayStats>,
}

impl Control {
    /// Whether to go on.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancel.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Counts rays of the pass in the making.
    pub(crate) fn count(&self, stats: &RayStats) {
        *self.under_way.lock().unwrap_or_else(PoisonError::into_inner) += *stats;
    }

    /// What has been counted since the last pass.
    pub(crate) fn take_counted(&self) -> RayStats {
        std::mem::take(&mut *self.under_way.lock().unwrap_or_else(PoisonError::into_inner))
    }

    pub(crate) fn show(&self, film: &Film) {
        if let Some(sink) = &self.preview {
            sink(film);
        }
    }

    pub(crate) fn report(&self, progress: &Progress) {
        if let Some(sink) = &self.progress {
            sink(progress);
        }
    }
}

/// The render was told to stop. The film holds what has come in until then, and is valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

impl fmt::Display for Cancelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the render was cancelled")
    }
}

impl std::error::Error for Cancelled {}
