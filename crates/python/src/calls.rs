//! Calls: what Python asks for, done without its lock and by threads of the call's own.
//!
//! These threads end with their call, so that a process between two calls has none, and what
//! `fork` makes of it is complete; multiprocessing forks by default on Linux up to Python 3.13. A
//! pool of the whole process, as that of rayon, would be waited for in vain. A process that is
//! forked in the midst of a call lacks its threads, and has the locks that they held: there, calls
//! are errors.

use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use alhazen::{available_threads, most_threads};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The number of calls that have not returned in the low half, and the process that they are of in
/// the high half.
static CALLS: AtomicU64 = AtomicU64::new(0);

/// The bits of the number of calls.
const COUNT: u64 = u32::MAX as u64;

/// The size of a stack, that of a program's first thread.
const STACK: usize = 8 << 20;

/// A call that has not returned.
pub struct Call {
    process: u64,
}

impl Call {
    /// Counts a call, with Python's lock, which a process is forked with, too. An error in a
    /// process that was forked in the midst of others.
    pub fn begin(_py: Python) -> PyResult<Self> {
        let process = u64::from(process::id()) << u32::BITS;
        let begun = CALLS.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |calls| match calls & COUNT {
            0 => Some(process + 1),
            _ => (calls & !COUNT == process).then_some(calls + 1),
        });
        begun.map(|_| Self { process }).map_err(|_| stranded())
    }

    /// An error in a process that was forked since the call began.
    pub fn check(&self) -> PyResult<()> {
        let is_same = u64::from(process::id()) << u32::BITS == self.process;
        if is_same { Ok(()) } else { Err(stranded()) }
    }
}

impl Drop for Call {
    fn drop(&mut self) {
        // In a process that was forked since, it goes on in the other one.
        if self.check().is_ok() {
            CALLS.fetch_sub(1, Ordering::SeqCst);
        }
    }
}

fn stranded() -> PyErr {
    PyRuntimeError::new_err(
        "this process was forked while alhazen was at work, and lacks the threads that were: fork before or \
         after that, or start processes by the method \"spawn\", as multiprocessing.get_context(\"spawn\")",
    )
}

/// Does something on threads of its own, one for each core, without Python's lock.
pub fn call<T: Send>(py: Python, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let _call = Call::begin(py)?;
    py.detach(|| with_pool(None, |pool| pool.install(work)))
}

/// Uses a pool of this number of threads, by default one for each core, which end with it.
pub fn with_pool<T>(threads: Option<usize>, work: impl FnOnce(&ThreadPool) -> T) -> PyResult<T> {
    let (cores, most) = (available_threads(), most_threads());
    if let Some(threads) = threads.filter(|threads| !(1..=most).contains(threads)) {
        let problem = format!("threads is from 1 to {most} on this machine of {cores} cores, not {threads}");
        return Err(PyValueError::new_err(problem));
    }
    let mut started = Vec::new();
    let pool = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).spawn_handler(|thread| {
        started.push(thread::Builder::new().stack_size(STACK).spawn(|| thread.run())?);
        Ok(())
    });
    let pool =
        pool.build().map_err(|error| PyRuntimeError::new_err(format!("cannot start threads: {error}")))?;
    let done = work(&pool);
    drop(pool);
    for thread in started {
        // A panic of one is one of the work.
        let _ = thread.join();
    }
    Ok(done)
}
