//! Ctrl-C. While a picture is being rendered, the first one asks the render to stop, so that the
//! picture can be written; at any other time, and the second time, it ends the program. A request
//! to terminate (SIGTERM, SIGHUP) counts as Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::Failure;

/// The exit code of a program that was interrupted.
pub const EXIT_CODE: u8 = 130;

/// The state of interruption.
#[derive(Clone, Debug)]
pub struct Interrupt {
    rendering: Arc<AtomicBool>,
    cancel: Arc<AtomicBool>,
}

impl Interrupt {
    /// Starts to listen; once per program.
    pub fn listen() -> Result<Self, Failure> {
        let interrupt = Self { rendering: Arc::default(), cancel: Arc::default() };
        let Self { rendering, cancel } = interrupt.clone();
        ctrlc::set_handler(move || {
            let first = !cancel.swap(true, Ordering::SeqCst);
            if !(first && rendering.load(Ordering::SeqCst)) {
                std::process::exit(EXIT_CODE.into());
            }
        })
        .map_err(|error| Failure::Input(format!("cannot listen for Ctrl-C: {error}")))?;
        Ok(interrupt)
    }

    /// From now on there is a picture to write.
    pub fn begin_rendering(&self) {
        self.rendering.store(true, Ordering::SeqCst);
    }

    /// The flag that becomes true when the render is to stop.
    pub fn cancel(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.cancel)
    }
}
