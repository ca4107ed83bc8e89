//! A picture on the screen. A thread turns the numbers of frames into codes of the display, so that
//! neither the window nor the engine waits for it.

use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use alhazen::image::DisplaySettings;
use eframe::egui::{ColorImage, Context, TextureHandle, TextureOptions};

use crate::{Frame, develop};

/// A frame, and its codes.
type Developed = (Arc<Frame>, ColorImage);

/// A picture on the screen, with its thread, which ends when this is dropped.
pub struct Picture {
    sender: Sender<(Arc<Frame>, DisplaySettings)>,
    developed: Arc<Mutex<Option<Developed>>>,
    /// The last frame that was sent to the thread, and how it is to be shown.
    asked: Option<(Arc<Frame>, DisplaySettings)>,
    texture: Option<(TextureHandle, Arc<Frame>)>,
}

impl Picture {
    /// Starts the thread, which calls `wake` after each frame.
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
                *done.lock().unwrap_or_else(PoisonError::into_inner) = Some((frame, codes));
                wake();
            }
        });
        Self { sender, developed, asked: None, texture: None }
    }

    /// Has a frame developed if it is new, and puts what was developed on the screen.
    pub fn refresh(&mut self, context: &Context, frame: Option<&Arc<Frame>>, display: DisplaySettings) {
        if let Some(frame) = frame {
            let is_asked =
                |asked: &(Arc<Frame>, DisplaySettings)| Arc::ptr_eq(&asked.0, frame) && asked.1 == display;
            if !self.asked.as_ref().is_some_and(is_asked) {
                self.asked = Some((Arc::clone(frame), display));
                // The thread ends only with this.
                let _ = self.sender.send((Arc::clone(frame), display));
            }
        }
        let developed = self.developed.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some((frame, codes)) = developed {
            match &mut self.texture {
                Some((texture, shown)) => {
                    texture.set(codes, TextureOptions::LINEAR);
                    *shown = frame;
                }
                None => {
                    let texture = context.load_texture("picture", codes, TextureOptions::LINEAR);
                    self.texture = Some((texture, frame));
                }
            }
        }
    }

    /// The texture, and the frame that it shows.
    pub fn texture(&self) -> Option<&(TextureHandle, Arc<Frame>)> {
        self.texture.as_ref()
    }
}
