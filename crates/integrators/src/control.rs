//! What a caller holds of a render while it runs: the request to stop, and the clock.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use geometry::RayStats;
use image::ImageError;

/// The time since some fixed moment. It is injected because not every platform has a clock:
/// `std::time::Instant` does not exist in a browser.
pub type Clock = Arc<dyn Fn() -> Duration + Send + Sync>;

/// What a caller holds of a render. The default never cancels it and has no clock.
#[derive(Clone, Default)]
pub struct Control {
    /// Set it, from any thread, and the render ends before its next tile.
    pub cancel: Arc<AtomicBool>,
    /// Measures elapsed time. Without a clock no time passes, and a limit on time is never reached.
    pub clock: Option<Clock>,
    /// Rays of the pass in progress, which would be lost with its result where it is cancelled;
    /// integrators count them.
    under_way: Arc<Mutex<RayStats>>,
}

impl Control {
    /// With a flag that cancels the render and a clock.
    pub fn new(cancel: Arc<AtomicBool>, clock: Clock) -> Self {
        Self { cancel, clock: Some(clock), ..Self::default() }
    }

    /// Whether to go on.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancel.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Counts rays of the pass in progress.
    pub(crate) fn count(&self, stats: &RayStats) {
        *self.under_way.lock().unwrap_or_else(PoisonError::into_inner) += *stats;
    }

    /// What has been counted since the last pass.
    pub(crate) fn take_counted(&self) -> RayStats {
        std::mem::take(&mut *self.under_way.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The clock's time.
    pub(crate) fn now(&self) -> Duration {
        self.clock.as_ref().map_or(Duration::ZERO, |clock| clock())
    }
}

/// The render was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

impl fmt::Display for Cancelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the render was cancelled")
    }
}

impl std::error::Error for Cancelled {}

/// Why a pass was not completed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PassError {
    /// The render was cancelled. The film is valid, but holds a part of the pass.
    Cancelled,
    /// There is no memory for what is named here. The film is as it was before the pass.
    OutOfMemory(String),
}

impl fmt::Display for PassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cancelled => Cancelled.fmt(f),
            Self::OutOfMemory(problem) => f.write_str(problem),
        }
    }
}

impl std::error::Error for PassError {}

impl From<Cancelled> for PassError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// Memory is all that a film may lack in a pass.
impl From<ImageError> for PassError {
    fn from(error: ImageError) -> Self {
        match error {
            ImageError::Limits(problem) => Self::OutOfMemory(problem),
            error => Self::OutOfMemory(error.to_string()),
        }
    }
}
