//! A thread that turns pictures into codes of the display, so that neither the window nor the
//! engine waits for it.

use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use alhazen::image::DisplaySettings;
use eframe::egui::ColorImage;

use crate::{Frame, develop};

/// A picture as it is shown.
pub struct Developed {
    /// The picture of which it was made.
    pub frame: Arc<Frame>,
    /// Its codes.
    pub codes: ColorImage,
}

/// The thread; it ends when this is dropped.
pub struct Developer {
    sender: Sender<(Arc<Frame>, DisplaySettings)>,
    developed: Arc<Mutex<Option<Developed>>>,
}

impl Developer {
    /// Starts the thread, which calls `wake` after each picture.
    pub fn start(wake: impl Fn() + Send + 'static) -> Self {
        let (sender, receiver) = channel::<(Arc<Frame>, DisplaySettings)>();
        let developed = Arc::new(Mutex::new(None));
        let done = Arc::clone(&developed);
        std::thread::spawn(move || {
            while let Ok(mut next) = receiver.recv() {
                // The latest counts.
                while let Ok(later) = receiver.try_recv() {
                    next = later;
                }
                let (frame, display) = next;
                let size = frame.size.map(|side| side as usize);
                let codes = ColorImage::from_rgba_unmultiplied(size, &develop(&frame, &display));
                *done.lock().unwrap_or_else(PoisonError::into_inner) = Some(Developed { frame, codes });
                wake();
            }
        });
        Self { sender, developed }
    }

    /// Asks for a picture.
    pub fn develop(&self, frame: Arc<Frame>, display: DisplaySettings) {
        // The thread ends only with this.
        let _ = self.sender.send((frame, display));
    }

    /// The latest picture, if there is a new one.
    pub fn take(&self) -> Option<Developed> {
        self.developed.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}
