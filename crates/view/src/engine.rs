//! A thread that renders what it is asked to show. Who asks never waits: requests are left in a
//! mailbox, the latest of a kind counts, and the latest picture lies ready.
//!
//! A request for another picture cancels what is only being refined, but not the draft that follows
//! a motion: so pictures appear however often the camera moves.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use alhazen::description::SceneDesc;
use alhazen::image::DisplaySettings;
use alhazen::integrators::Control;
use alhazen::system_clock;
use alhazen::trace::PixelTrace;

use crate::Renderer;
use crate::step::StepError;
use crate::world::summary;
use crate::{Frame, Shot, World};

/// A thread that renders. It ends when this is dropped.
pub struct Engine {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

/// What the engine has found so far.
#[derive(Clone)]
pub struct Output {
    /// The scene that is rendered.
    pub world: Arc<World>,
    /// The latest picture.
    pub frame: Option<Arc<Frame>>,
    /// The paths of the pixel that was asked for last.
    pub trace: Option<Arc<PixelTrace>>,
    /// Why the scene, the picture or the paths that were asked for last are not there.
    pub problem: Option<String>,
    /// What was written.
    pub note: Option<String>,
}

/// What the engine is asked to do.
#[derive(Default)]
struct Mail {
    desc: Option<SceneDesc>,
    shot: Option<Shot>,
    pixel: Option<([i32; 2], u32)>,
    save: Option<(PathBuf, DisplaySettings)>,
}

impl Mail {
    fn is_empty(&self) -> bool {
        self.desc.is_none() && self.shot.is_none() && self.pixel.is_none() && self.save.is_none()
    }
}

#[derive(Default)]
struct Mailbox {
    mail: Mail,
    /// Whether what is being rendered may be cancelled for another picture.
    is_refining: bool,
    is_closed: bool,
}

struct Shared {
    mailbox: Mutex<Mailbox>,
    bell: Condvar,
    cancel: Arc<AtomicBool>,
    output: Mutex<Output>,
}

impl Engine {
    /// Starts to render. `wake` is called when there is something new.
    pub fn start(renderer: Renderer, wake: impl Fn() + Send + 'static) -> Self {
        let world = Arc::clone(renderer.world());
        let output = Output { world, frame: None, trace: None, problem: None, note: None };
        let shared = Arc::new(Shared {
            mailbox: Mutex::default(),
            bell: Condvar::new(),
            cancel: Arc::default(),
            output: Mutex::new(output),
        });
        let worker = Worker {
            renderer,
            control: Control::new(Arc::clone(&shared.cancel), system_clock()),
            shared: Arc::clone(&shared),
            wake: Box::new(wake),
            pixel: None,
            save: None,
        };
        Self { shared, thread: Some(std::thread::spawn(move || worker.run())) }
    }

    /// Shows something else.
    pub fn show(&self, shot: Shot) {
        self.post(true, |mail| mail.shot = Some(shot));
    }

    /// Compiles a changed scene and shows it. If it has errors, the last one stays.
    pub fn replace(&self, desc: SceneDesc) {
        self.post(true, |mail| mail.desc = Some(desc));
    }

    /// Traces the paths of the first samples of a pixel.
    pub fn trace(&self, pixel: [i32; 2], samples: u32) {
        self.post(false, |mail| mail.pixel = Some((pixel, samples)));
    }

    /// Writes the picture, as soon as it has a sample of every pixel.
    pub fn save(&self, path: PathBuf, display: DisplaySettings) {
        self.post(false, |mail| mail.save = Some((path, display)));
    }

    /// What has been found so far.
    pub fn output(&self) -> Output {
        locked(&self.shared.output).clone()
    }

    /// Forgets the paths.
    pub fn forget_trace(&self) {
        locked(&self.shared.output).trace = None;
    }

    fn post(&self, is_other_picture: bool, put: impl FnOnce(&mut Mail)) {
        let mut mailbox = locked(&self.shared.mailbox);
        put(&mut mailbox.mail);
        if is_other_picture && mailbox.is_refining {
            self.shared.cancel.store(true, Ordering::SeqCst);
        }
        self.shared.bell.notify_one();
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        locked(&self.shared.mailbox).is_closed = true;
        self.shared.cancel.store(true, Ordering::SeqCst);
        self.shared.bell.notify_one();
        // A panic of the thread has been reported by it.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

impl Shared {
    /// Waits for mail unless there is something to render, and takes it; `None` when the engine
    /// ends.
    fn next(&self, renderer: &Renderer) -> Option<Mail> {
        let mut mailbox = locked(&self.mailbox);
        while renderer.is_at_rest() && mailbox.mail.is_empty() && !mailbox.is_closed {
            mailbox = self.bell.wait(mailbox).unwrap_or_else(PoisonError::into_inner);
        }
        if mailbox.is_closed {
            return None;
        }
        let mail = std::mem::take(&mut mailbox.mail);
        mailbox.is_refining = !renderer.is_draft() && mail.shot.is_none() && mail.desc.is_none();
        self.cancel.store(false, Ordering::SeqCst);
        Some(mail)
    }
}

/// The thread's side.
struct Worker {
    renderer: Renderer,
    control: Control,
    shared: Arc<Shared>,
    wake: Box<dyn Fn() + Send>,
    /// The pixel whose paths are asked for.
    pixel: Option<([i32; 2], u32)>,
    /// What is to be written when there is a picture.
    save: Option<(PathBuf, DisplaySettings)>,
}

impl Worker {
    fn run(mut self) {
        while let Some(mail) = self.shared.next(&self.renderer) {
            self.read(mail);
            match self.renderer.step(&self.control) {
                Ok(Some(frame)) => self.tell(|output| output.frame = Some(Arc::new(frame))),
                Err(StepError::Problem(problem)) => self.tell(|output| output.problem = Some(problem)),
                Ok(None) | Err(StepError::Cancelled) => (),
            }
            self.trace();
            self.write();
        }
    }

    fn read(&mut self, mail: Mail) {
        if !mail.is_empty() {
            locked(&self.shared.output).problem = None;
        }
        if let Some(shot) = mail.shot {
            self.renderer.aim(shot);
        }
        if let Some(desc) = mail.desc {
            match World::new(desc) {
                Ok(world) => {
                    let world = Arc::new(world);
                    self.renderer.replace(Arc::clone(&world));
                    self.tell(|output| output.world = world);
                }
                Err(errors) => {
                    if !self.renderer.is_draft() {
                        self.renderer.restart();
                    }
                    self.tell(|output| output.problem = Some(summary(&errors)));
                }
            }
        }
        self.pixel = mail.pixel.or(self.pixel);
        self.save = mail.save.or(self.save.take());
    }

    fn trace(&mut self) {
        let Some((pixel, samples)) = self.pixel else { return };
        match self.renderer.trace(pixel, samples, &self.control) {
            Ok(trace) => self.tell(|output| output.trace = Some(Arc::new(trace))),
            Err(StepError::Problem(problem)) => self.tell(|output| output.problem = Some(problem)),
            // It is tried again after what has cancelled it.
            Err(StepError::Cancelled) => return,
        }
        self.pixel = None;
    }

    fn write(&mut self) {
        let Some((path, display)) = &self.save else { return };
        let Some(written) = self.renderer.save(path, display) else { return };
        let path = path.display();
        let result = match written {
            Ok(samples) => Ok(format!("{path}: {samples} samples per pixel")),
            Err(error) => Err(format!("{path}: {error}")),
        };
        self.tell(|output| match result {
            Ok(note) => output.note = Some(note),
            Err(problem) => output.problem = Some(problem),
        });
        self.save = None;
    }

    fn tell(&self, change: impl FnOnce(&mut Output)) {
        change(&mut locked(&self.shared.output));
        (self.wake)();
    }
}

/// The value behind a lock. No thread panics while it holds one.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
