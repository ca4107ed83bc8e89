//! The system clock, for platforms that have one.

use std::sync::Arc;
use std::time::Instant;

use integrators::Clock;

/// A clock that starts now.
pub fn system_clock() -> Clock {
    let start = Instant::now();
    Arc::new(move || start.elapsed())
}
