//! Ctrl-C. While a picture is being rendered, the first one cancels the render, so that the picture
//! can be written. A part of a pass can neither be saved nor removed from the film; so if the
//! checkpoint lacks completed passes, the current pass is completed first, and saved with them. At
//! any other time, and the second time, Ctrl-C ends the program with the pictures that are already
//! written. A request to terminate (SIGTERM, SIGHUP) counts as Ctrl-C.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use serde_json::{Value, json};

use crate::console::{say, warn};
use crate::failure::Failure;

/// The exit code of a program that was interrupted.
pub const EXIT_CODE: u8 = 130;

/// The state of interruption.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    rendering: Arc<AtomicBool>,
    interrupted: Arc<AtomicBool>,
    /// Whether that was a request instead of Ctrl-C.
    requested: Arc<AtomicBool>,
    /// Whether the checkpoint lacks passes that are done.
    unsaved: Arc<AtomicBool>,
    verbose: Arc<AtomicBool>,
    cancel: Arc<AtomicBool>,
    written: Arc<Mutex<Written>>,
}

/// The pictures that have been written.
#[derive(Debug, Default)]
struct Written {
    outputs: Vec<PathBuf>,
    passes: u32,
}

impl Interrupt {
    /// Installs the handler; once per program. A program that is ended at once reports it as JSON
    /// on standard output, or as text on standard error.
    pub fn listen(as_json: bool) -> Result<Self, Failure> {
        let interrupt = Self::default();
        let handler = interrupt.clone();
        ctrlc::set_handler(move || {
            let first = !handler.interrupted.swap(true, Ordering::SeqCst);
            if first && handler.rendering.load(Ordering::SeqCst) {
                handler.end_rendering();
            } else {
                // The program ends even if the message cannot be written.
                let _ = if as_json { say(handler.to_json()) } else { warn(handler.message()) };
                std::process::exit(EXIT_CODE.into());
            }
        })
        .map_err(|error| Failure::Input(format!("cannot listen for Ctrl-C: {error}")))?;
        Ok(interrupt)
    }

    fn end_rendering(&self) {
        if !self.unsaved.load(Ordering::SeqCst) {
            self.cancel.store(true, Ordering::SeqCst);
        } else if self.verbose.load(Ordering::SeqCst) {
            // The pass is completed even if the message cannot be written.
            let _ = warn("\nending after this pass, to save it; Ctrl-C again ends at once");
        }
    }

    /// Does what the first Ctrl-C does while a picture is being rendered; returns whether one is.
    #[cfg(feature = "serve")]
    pub fn cancel_rendering(&self) -> bool {
        let is_rendering = self.rendering.load(Ordering::SeqCst);
        if is_rendering && !self.interrupted.swap(true, Ordering::SeqCst) {
            self.requested.store(true, Ordering::SeqCst);
            self.end_rendering();
        }
        is_rendering
    }

    /// Forgets a request that has ended a render: what comes next is a first Ctrl-C again.
    pub fn forget_request(&self) {
        if self.requested.swap(false, Ordering::SeqCst) {
            self.interrupted.store(false, Ordering::SeqCst);
        }
    }

    /// Whether there was a Ctrl-C, or what counts as one.
    pub fn is_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::SeqCst)
    }

    /// From now on there is a picture to write.
    pub fn begin_rendering(&self, is_verbose: bool) {
        self.verbose.store(is_verbose, Ordering::SeqCst);
        self.rendering.store(true, Ordering::SeqCst);
    }

    /// The flag that becomes true when the render is to stop.
    pub fn cancel(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.cancel)
    }

    /// Cancels the render between two passes, if there was a Ctrl-C. Until the next call passes
    /// that are done are `unsaved`, or not.
    pub fn after_pass(&self, unsaved: bool) {
        // Before the flag of Ctrl-C is read, so that one of both sides sees the other.
        self.unsaved.store(unsaved, Ordering::SeqCst);
        self.cancel.fetch_or(self.interrupted.load(Ordering::SeqCst), Ordering::SeqCst);
    }

    /// Records that pictures of `passes` passes have been written.
    pub fn note_written(&self, outputs: &[PathBuf], passes: u32) {
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        *written = Written { outputs: outputs.to_vec(), passes };
    }

    fn to_json(&self) -> Value {
        let Written { outputs, passes } = &*self.written.lock().unwrap_or_else(PoisonError::into_inner);
        let outputs: Vec<_> = outputs.iter().map(|path| path.display().to_string()).collect();
        json!({ "status": "interrupted", "outputs": outputs, "passes": passes })
    }

    fn message(&self) -> String {
        let Written { outputs, passes } = &*self.written.lock().unwrap_or_else(PoisonError::into_inner);
        match &outputs[..] {
            [] => "interrupted; no picture has been written".into(),
            [first, ..] => format!("interrupted; {} is the picture after {passes} passes", first.display()),
        }
    }
}
