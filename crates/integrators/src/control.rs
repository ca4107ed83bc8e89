//! What a caller says to a render while it runs, and what it hears from it.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

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

/// What a caller holds of a render. The default never stops it and hears nothing.
#[derive(Default)]
pub struct Control {
    /// Set it, from any thread, and the render ends before its next tile.
    pub cancel: Arc<AtomicBool>,
    /// Hears of each pass when it is done.
    pub progress: Option<ProgressSink>,
}

impl Control {
    /// Whether to go on.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancel.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
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
