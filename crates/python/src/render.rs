//! Rendering.
//!
//! A thread of its own renders; the calling thread waits for its messages without Python's lock,
//! and takes the lock now and then to ask for signals and to call back.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};
use std::thread;
use std::time::Duration;

use alhazen::image::ImageError;
use alhazen::integrators::{Control, Limits, PassError, Session, Stop};
use alhazen::{Job, PreviewSchedule, system_clock};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError};
use pyo3::prelude::*;

use crate::calls::{Call, with_pool};
use crate::errors::{image_error, wrong_type};
use crate::picture::{Collected, Picture};

/// The time between two looks at signals.
const POLL: Duration = Duration::from_millis(50);

/// How far a render is.
#[pyclass(frozen, get_all, module = "alhazen")]
#[derive(Clone, Copy)]
pub struct Progress {
    /// Passes done.
    passes: u32,
    /// All passes; None if that is not known yet.
    total: Option<u32>,
    /// Seconds of rendering.
    seconds: f64,
    /// The relative standard error of the picture, where it was estimated.
    noise: Option<f64>,
}

#[pymethods]
impl Progress {
    fn __repr__(&self) -> String {
        let total = self.total.map_or("?".into(), |total| total.to_string());
        format!("<alhazen.Progress {} of {total} passes, {:.1} s>", self.passes, self.seconds)
    }
}

/// What the rendering thread tells.
enum Event {
    Pass(Progress),
    Preview(Result<Collected, ImageError>),
}

/// What is called while a scene is rendered.
pub struct Callbacks {
    /// Called with a [`Progress`] after passes.
    pub progress: Option<Py<PyAny>>,
    /// Called with a picture now and then.
    pub preview: Option<Py<PyAny>>,
    /// Whether progress is shown as a bar, which has a line of the terminal.
    has_bar: bool,
}

impl Callbacks {
    /// Refuses what cannot be called. True for progress is a bar; what is left is estimated by the
    /// limits of time and noise.
    pub fn new(
        py: Python,
        mut progress: Option<Py<PyAny>>,
        preview: Option<Py<PyAny>>,
        limits: [Option<f64>; 2],
    ) -> PyResult<Self> {
        let flag = progress.as_ref().and_then(|progress| progress.extract::<bool>(py).ok());
        if let Some(wants_bar) = flag {
            let bar = || py.import("alhazen.bar")?.call_method1("Bar", (limits[0], limits[1]));
            progress = if wants_bar { Some(bar()?.unbind()) } else { None };
        }
        let callbacks = [
            ("progress", "True, or a function that is called with a Progress", &progress),
            ("preview", "a function that is called with an Image", &preview),
        ];
        for (name, wanted, callback) in callbacks {
            if let Some(callback) = callback.as_ref().map(|callback| callback.bind(py))
                && !callback.is_callable()
            {
                return Err(wrong_type(name, wanted, callback));
            }
        }
        Ok(Self { progress, preview, has_bar: flag == Some(true) })
    }

    fn call(&self, py: Python, event: Event) -> PyResult<()> {
        match event {
            Event::Pass(progress) => {
                self.progress.as_ref().map(|callback| callback.call1(py, (progress,))).transpose()?;
            }
            Event::Preview(collected) => {
                let picture = Picture::new(py, collected.map_err(image_error)?)?;
                self.preview.as_ref().map(|callback| callback.call1(py, (picture,))).transpose()?;
            }
        }
        Ok(())
    }
}

impl Drop for Callbacks {
    /// Ends the line of a bar, also that of a render that has failed.
    fn drop(&mut self) {
        if let Some(bar) = self.progress.as_ref().filter(|_| self.has_bar) {
            // A failure to write is not one of the render.
            let _ = Python::attach(|py| bar.call_method0(py, "close"));
        }
    }
}

/// The order of a job, which begins with an empty film.
pub struct Order {
    /// The passes.
    pub passes: Range<u32>,
    /// The limits that end them.
    pub limits: Limits,
    /// Whether they alternate between two films.
    pub alternates: bool,
    /// The number of threads, by default one for each core.
    pub threads: Option<usize>,
}

/// Renders a job on a thread of its own, calls back, and gives the result of the rendered job.
///
/// The thread owns all that it uses: where a callback forks the process and returns in the new one,
/// which lacks the thread, the call is left with an error.
pub fn drive<T: Send + 'static>(
    py: Python,
    job: &Arc<Mutex<Job>>,
    order: Order,
    callbacks: &Callbacks,
    result: impl FnOnce(&Job, Stop) -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    let call = Call::begin(py)?;
    py.detach(|| {
        let cancel = Arc::new(AtomicBool::new(false));
        let control = Control::new(cancel.clone(), system_clock());
        let (sender, receiver) = mpsc::channel();
        let reporter = Reporter::new(sender, callbacks.preview.is_some());
        let job = Arc::clone(job);
        let worker = thread::Builder::new().spawn(move || run(&job, order, &control, reporter, result));
        let worker =
            worker.map_err(|error| PyRuntimeError::new_err(format!("cannot start a thread: {error}")))?;
        let mut interruption = None;
        loop {
            let event = receiver.recv_timeout(POLL);
            if let Err(RecvTimeoutError::Disconnected) = event {
                break;
            }
            if interruption.is_some() {
                continue;
            }
            let told = Python::attach(|py| {
                py.check_signals()?;
                // Of passes that have ended meanwhile only the last one is told.
                let mut last = None;
                for event in event.into_iter().chain(receiver.try_iter()) {
                    match event {
                        Event::Pass(progress) => last = Some(progress),
                        preview => callbacks.call(py, preview)?,
                    }
                }
                last.map_or(Ok(()), |progress| callbacks.call(py, Event::Pass(progress)))
            });
            if let Err(error) = call.check() {
                // There is no such thread in this process.
                std::mem::forget(worker);
                return Err(told.err().unwrap_or(error));
            }
            if let Err(error) = told {
                cancel.store(true, Ordering::Relaxed);
                interruption = Some(error);
            }
        }
        let outcome = worker.join();
        match interruption {
            Some(error) => Err(error),
            None => outcome.unwrap_or_else(|_| Err(PyRuntimeError::new_err("the renderer failed"))),
        }
    })
}

/// Renders a job, which renders once at a time, on a pool of threads.
fn run<T: Send>(
    job: &Mutex<Job>,
    order: Order,
    control: &Control,
    mut reporter: Reporter,
    result: impl FnOnce(&Job, Stop) -> PyResult<T> + Send,
) -> PyResult<T> {
    let mut job = free(job)?;
    let job = &mut *job;
    let render = || {
        job.restart(order.alternates).map_err(image_error)?;
        let header = job.header().clone();
        let mut after_pass = |session: &Session| reporter.after_pass(session, &header);
        let ended = job.session.run(order.passes, &order.limits, control, &mut after_pass);
        result(job, ended.map_err(pass_error)?)
    };
    with_pool(order.threads, |pool| pool.install(render))?
}

/// The job, if it is not in use.
pub fn free(job: &Mutex<Job>) -> PyResult<MutexGuard<'_, Job>> {
    job.try_lock().map_err(|error| {
        PyRuntimeError::new_err(match error {
            TryLockError::WouldBlock => "the job is being rendered already",
            TryLockError::Poisoned(_) => "the job has failed before",
        })
    })
}

/// The exception for a pass that was not completed.
fn pass_error(error: PassError) -> PyErr {
    match error {
        PassError::OutOfMemory(problem) => PyMemoryError::new_err(problem),
        PassError::Device(problem) => PyRuntimeError::new_err(problem),
        PassError::Cancelled => PyRuntimeError::new_err("the render was cancelled"),
    }
}

/// Tells of passes, and shows the picture now and then.
struct Reporter {
    events: Sender<Event>,
    /// When previews are shown, if they are wanted.
    previews: Option<PreviewSchedule>,
}

impl Reporter {
    fn new(events: Sender<Event>, wants_previews: bool) -> Self {
        Self { events, previews: wants_previews.then(PreviewSchedule::begin) }
    }

    fn after_pass(&mut self, session: &Session, header: &alhazen::Header) {
        let progress = session.progress();
        // The receiver waits until the sender is dropped.
        let _ = self.events.send(Event::Pass(Progress {
            passes: progress.pass,
            total: (progress.passes != u32::MAX).then_some(progress.passes),
            seconds: progress.elapsed.as_secs_f64(),
            noise: progress.noise,
        }));
        if let Some(previews) = &mut self.previews {
            previews.after_pass(false, || {
                let picture = Picture::collect(&header.development(session.state()));
                let _ = self.events.send(Event::Preview(picture));
            });
        }
    }
}
