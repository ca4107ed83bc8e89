//! Rendering.
//!
//! A thread of its own renders; the calling thread waits for its messages without Python's lock,
//! and takes the lock now and then to ask for signals and to call back.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use alhazen::description::SceneDesc;
use alhazen::integrators::{Control, Limits, PassError, Session};
use alhazen::{Job, Overrides, PreviewSchedule, system_clock};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};

use crate::picture::{Collected, Picture, image_error};
use crate::scene::{Scene, load, scene_error};

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
    Preview(Result<Collected, alhazen::image::ImageError>),
}

/// What is called while a scene is rendered.
struct Callbacks {
    progress: Option<Py<PyAny>>,
    preview: Option<Py<PyAny>>,
}

impl Callbacks {
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

/// Renders a scene, or the scene of a file, to a picture.
///
/// spp: samples per pixel. resolution: (width, height) of the whole picture. integrator: the name
/// of an algorithm, see integrators(). seed: of all random numbers. crop: the part to render, as
/// fractions (x0, x1, y0, y1) with y down. layers: names of layers beside the colours, such as
/// "depth". settings: values by name, as in {"integrator.maxdepth": 8}. time: seconds after which
/// no pass is begun. noise: the relative error at which it ends. threads: their number, by default
/// one for each core. progress: called with a Progress after passes. preview: called with an Image
/// now and then.
///
/// Ctrl-C ends it with KeyboardInterrupt; an exception of a callback ends it, too.
#[pyfunction]
#[pyo3(signature = (
    scene, *, spp=None, resolution=None, integrator=None, seed=None, crop=None, layers=None, settings=None,
    time=None, noise=None, threads=None, progress=None, preview=None
))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub fn render(
    py: Python,
    scene: &Bound<'_, PyAny>,
    spp: Option<u32>,
    resolution: Option<[i32; 2]>,
    integrator: Option<String>,
    seed: Option<i32>,
    crop: Option<[f32; 4]>,
    layers: Option<Vec<String>>,
    settings: Option<&Bound<'_, PyDict>>,
    time: Option<f64>,
    noise: Option<f64>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    preview: Option<Py<PyAny>>,
) -> PyResult<Picture> {
    let loaded;
    let scene = match scene.cast::<Scene>() {
        Ok(scene) => scene.get(),
        Err(_) => {
            loaded = load(py, scene.extract::<PathBuf>()?)?;
            &loaded
        }
    };
    let overrides = Overrides {
        integrator,
        settings: settings.map(texts).transpose()?.unwrap_or_default(),
        samples_per_pixel: spp,
        resolution,
        crop,
        seed,
        layers: layers.unwrap_or_default(),
        ..Overrides::default()
    };
    let time = time.map(Duration::try_from_secs_f64).transpose();
    let limits = Limits { time: time.map_err(|error| PyValueError::new_err(error.to_string()))?, noise };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
    let pool = pool.map_err(|error| PyRuntimeError::new_err(format!("cannot start threads: {error}")))?;
    let mut desc = scene.imported.desc.clone();
    overrides.apply(&mut desc).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let job = compile(py, desc, scene, &overrides)?;
    let callbacks = Callbacks { progress, preview };
    let picture = py.detach(|| drive(job, &limits, &pool, &callbacks))?;
    Picture::new(py, picture)
}

/// Values of settings as texts.
fn texts(settings: &Bound<'_, PyDict>) -> PyResult<Vec<(String, String)>> {
    let text = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let text = value.str()?.to_string();
        let text = if value.is_instance_of::<PyBool>() { text.to_lowercase() } else { text };
        Ok((key.extract()?, text))
    };
    settings.iter().map(text).collect()
}

fn compile(py: Python, desc: SceneDesc, scene: &Scene, overrides: &Overrides) -> PyResult<Job> {
    match py.detach(|| Job::compile(desc)) {
        Ok(compiled) => Ok(compiled.job),
        Err(errors) => Err(match overrides.blamed(&errors) {
            Some(error) => PyValueError::new_err(error.to_string()),
            None => scene_error(&errors, &scene.imported.sources),
        }),
    }
}

/// Renders a job on a thread of its own, and calls back.
fn drive(
    mut job: Job,
    limits: &Limits,
    pool: &rayon::ThreadPool,
    callbacks: &Callbacks,
) -> PyResult<Collected> {
    let cancel = Arc::new(AtomicBool::new(false));
    let control = Control::new(cancel.clone(), system_clock());
    let passes = 0..job.planned();
    let (sender, receiver) = mpsc::channel();
    let mut interruption = None;
    let outcome = thread::scope(|scope| {
        let worker = scope.spawn(|| {
            let mut reporter = Reporter::new(sender, callbacks.preview.is_some());
            let header = job.header().clone();
            pool.install(|| {
                let mut after_pass = |session: &Session| reporter.after_pass(session, &header);
                job.session.run(passes, limits, &control, &mut after_pass)?;
                Ok(Picture::collect(&header.development(job.session.state())))
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
        Ok(Ok(picture)) => picture.map_err(image_error),
        Ok(Err(PassError::OutOfMemory(problem))) => Err(PyMemoryError::new_err(problem)),
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
