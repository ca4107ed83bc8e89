//! Rendering.
//!
//! A thread of its own renders; the calling thread waits for its messages without Python's lock,
//! and takes the lock now and then to ask for signals and to call back.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use alhazen::image::ImageError;
use alhazen::integrators::{Control, Limits, PassError, Session};
use alhazen::{Job, PreviewSchedule, available_threads, most_threads, system_clock};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

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
            // What it writes is not part of the result.
            let _ = Python::attach(|py| bar.call_method0(py, "close"));
        }
    }
}

/// A pool of this number of threads, by default one for each core.
fn pool(threads: Option<usize>) -> PyResult<rayon::ThreadPool> {
    let (cores, most) = (available_threads(), most_threads());
    if let Some(threads) = threads.filter(|threads| !(1..=most).contains(threads)) {
        let problem = format!("threads is from 1 to {most} on this machine of {cores} cores, not {threads}");
        return Err(PyValueError::new_err(problem));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
    pool.map_err(|error| PyRuntimeError::new_err(format!("cannot start threads: {error}")))
}

/// Renders passes of a job, which was restarted, on a thread of its own, calls back, and gives the
/// result of the rendered job. Python's lock is not held.
pub fn drive<T: Send>(
    job: &mut Job,
    passes: Range<u32>,
    limits: &Limits,
    threads: Option<usize>,
    callbacks: &Callbacks,
    result: impl FnOnce(&Job) -> Result<T, ImageError> + Send,
) -> PyResult<T> {
    let pool = pool(threads)?;
    let cancel = Arc::new(AtomicBool::new(false));
    let control = Control::new(cancel.clone(), system_clock());
    let (sender, receiver) = mpsc::channel();
    let mut interruption = None;
    let outcome = thread::scope(|scope| {
        let worker = scope.spawn(|| {
            let mut reporter = Reporter::new(sender, callbacks.preview.is_some());
            let header = job.header().clone();
            pool.install(|| {
                let mut after_pass = |session: &Session| reporter.after_pass(session, &header);
                job.session.run(passes, limits, &control, &mut after_pass)?;
                Ok(result(job))
            })
        });
        loop {
            let event = receiver.recv_timeout(POLL);
            if let Err(RecvTimeoutError::Disconnected) = event {
                break;
            }
            if interruption.is_some() {
                continue;
            }
            let result = Python::attach(|py| {
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
            if let Err(error) = result {
                cancel.store(true, Ordering::Relaxed);
                interruption = Some(error);
            }
        }
        worker.join()
    });
    if let Some(error) = interruption {
        return Err(error);
    }
    match outcome {
        Ok(Ok(result)) => result.map_err(image_error),
        Ok(Err(PassError::OutOfMemory(problem))) => Err(PyMemoryError::new_err(problem)),
        Ok(Err(PassError::Device(problem))) => Err(PyRuntimeError::new_err(problem)),
        Ok(Err(PassError::Cancelled)) => Err(PyRuntimeError::new_err("the render was cancelled")),
        Err(_) => Err(PyRuntimeError::new_err("the renderer failed")),
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
