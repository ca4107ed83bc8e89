//! The threads of the program.

use alhazen::{available_threads, most_threads};

use crate::failure::Failure;

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
