//! How many threads a render can have.

use std::num::NonZero;
use std::thread::available_parallelism;

/// The most threads that are allowed on any machine. The time to start and to wake threads grows
/// faster than their number, and beyond the number of cores they do not help.
const ALWAYS_ALLOWED: usize = 256;

/// The most threads for each core.
const PER_CORE: usize = 4;

/// The threads that the system lets run at the same time, by its affinity masks and quotas.
pub fn available_threads() -> usize {
    available_parallelism().map_or(1, NonZero::get)
}

/// The most threads that are allowed on this machine.
pub fn most_threads() -> usize {
    ALWAYS_ALLOWED.max(PER_CORE * available_threads())
}
