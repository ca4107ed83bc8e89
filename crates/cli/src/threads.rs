//! The threads of the program.

use std::num::NonZero;
use std::thread::available_parallelism;

use crate::failure::Failure;

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

/// Starts the thread pool: the given number of threads, or one for each core.
pub fn start_threads(threads: Option<u16>) -> Result<(), Failure> {
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = threads.map(usize::from) {
        let (cores, most) = (available_threads(), most_threads());
        if threads > most {
            return Err(Failure::Usage(format!(
                "cannot start {threads} threads: this machine has {cores} cores, which allow {most} threads"
            )));
        }
        builder = builder.num_threads(threads);
    }
    builder.build_global().map_err(|error| Failure::Input(format!("cannot start threads: {error}")))
}
