//! Control of a running render by its caller: cancellation and the clock.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use geometry::RayStats;
use image::ImageError;

/// The time since some fixed moment. It is injected because not every platform has a clock:
/// `std::time::Instant` does not exist in a browser.
pub type Clock = Arc<dyn Fn() -> Duration + Send + Sync>;

/// Cancels a render and measures its time. The default never cancels and has no clock.
#[derive(Clone, Default)]
pub struct Control {
    /// Any thread may set it; the render then ends before its next tile.
    pub cancel: Arc<AtomicBool>,
    /// Measures elapsed time. Without a clock no time passes, and a limit on time is never reached.
    pub clock: Option<Clock>,
    /// Rays of the pass in progress, counted by integrators. They would be lost with the result of
    /// a cancelled pass.
    under_way: Arc<Mutex<RayStats>>,
}

impl Control {
    /// A control with a cancellation flag and a clock.
    pub fn new(cancel: Arc<AtomicBool>, clock: Clock) -> Self {
        Self { cancel, clock: Some(clock), ..Self::default() }
    }

    /// An error if the render was cancelled.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancel.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Counts rays of the pass in progress.
    pub(crate) fn count(&self, stats: &RayStats) {
        *self.under_way.lock().unwrap_or_else(PoisonError::into_inner) += *stats;
    }

    /// Takes the rays counted since the last pass.
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
    /// Memory ran out; the text says what for. The film is unchanged by the pass.
    OutOfMemory(String),
    /// The device that renders has failed; the text says how. The film is valid, but may hold a
    /// part of the pass.
    Device(String),
}

impl fmt::Display for PassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cancelled => Cancelled.fmt(f),
            Self::OutOfMemory(problem) | Self::Device(problem) => f.write_str(problem),
        }
    }
}

impl std::error::Error for PassError {}

impl From<Cancelled> for PassError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// Within a pass, the only error of a film is a lack of memory.
impl From<ImageError> for PassError {
    fn from(error: ImageError) -> Self {
        match error {
            ImageError::Limits(problem) => Self::OutOfMemory(problem),
            error => Self::OutOfMemory(error.to_string()),
        }
    }
}
