//! Ctrl-C. While a picture is being rendered, the first one cancels the render, so that the picture
//! can be written; where the render is saved, the pass in progress may end first, if it does soon,
//! so that the whole of it can be saved. At any other time, and the second time, it ends the
//! program with what has been written before. A request to terminate (SIGTERM, SIGHUP) counts as
//! Ctrl-C.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use serde_json::{Value, json};

use crate::console::{say, warn};
use crate::failure::Failure;

/// The exit code of a program that was interrupted.
pub const EXIT_CODE: u8 = 130;

/// How long a pass may go on after Ctrl-C where the render is saved.
const GRACE: Duration = Duration::from_millis(500);

/// The state of interruption.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    rendering: Arc<AtomicBool>,
    interrupted: Arc<AtomicBool>,
    has_checkpoint: Arc<AtomicBool>,
    cancel: Arc<AtomicBool>,
    written: Arc<Mutex<Written>>,
}

/// What has been written so far.
#[derive(Debug, Default)]
struct Written {
    outputs: Vec<PathBuf>,
    passes: u32,
}

impl Interrupt {
    /// Starts to listen; once per program. A program that is ended at once says so as JSON on
    /// standard output, or as text on standard error.
    pub fn listen(as_json: bool) -> Result<Self, Failure> {
        let interrupt = Self::default();
        let handler = interrupt.clone();
        ctrlc::set_handler(move || {
            let first = !handler.interrupted.swap(true, Ordering::SeqCst);
            if first && handler.rendering.load(Ordering::SeqCst) {
                let (cancel, wait) = (handler.cancel(), handler.has_checkpoint.load(Ordering::SeqCst));
                std::thread::spawn(move || {
                    std::thread::sleep(if wait { GRACE } else { Duration::ZERO });
                    cancel.store(true, Ordering::SeqCst);
                });
            } else {
                // The program ends whether or not anybody hears of it.
                let _ = if as_json { say(handler.to_json()) } else { warn(handler.message()) };
                std::process::exit(EXIT_CODE.into());
            }
        })
        .map_err(|error| Failure::Input(format!("cannot listen for Ctrl-C: {error}")))?;
        Ok(interrupt)
    }

    /// From now on there is a picture to write, and perhaps a checkpoint.
    pub fn begin_rendering(&self, has_checkpoint: bool) {
        self.has_checkpoint.store(has_checkpoint, Ordering::SeqCst);
        self.rendering.store(true, Ordering::SeqCst);
    }

    /// The flag that becomes true when the render is to stop.
    pub fn cancel(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.cancel)
    }

    /// Cancels the render between two passes, if there was a Ctrl-C.
    pub fn after_pass(&self) {
        self.cancel.fetch_or(self.interrupted.load(Ordering::SeqCst), Ordering::SeqCst);
    }

    /// Takes note of pictures of so many passes that have been written.
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
