//! Compiled scenes.

use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use alhazen::integrators::Limits;
use alhazen::{Overrides, RenderOrder, Shard};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList, PyString, PyTuple};

use crate::calls::call;
use crate::errors::{film_error, image_error, wrong_type};
use crate::film::Film;
use crate::keywords;
use crate::picture::Picture;
use crate::render::{Callbacks, Order, drive, free};
use crate::scene::{Scene, load};
use crate::value::Chosen;
use crate::warning::{warn_of_render, warn_of_scene};

/// Arguments that choose an integrator.
const ALGORITHM: &str = "the name of an algorithm, or alhazen.settings.integrator";

/// Arguments that change settings.
const SETTINGS: &str = "a dict from names to values, or settings of alhazen.settings, one or a list of them";

/// A scene compiled for rendering with certain settings. What is rendered several times, whole or
/// in shards, is compiled once.
#[pyclass(frozen, module = "alhazen")]
pub struct Job {
    job: Arc<Mutex<alhazen::Job>>,
    order: RenderOrder,
    #[pyo3(get)]
    /// Differences between the picture and its description.
    warnings: Vec<String>,
}

/// Compiles a scene, or the scene of a file.
///
/// scene: a Scene, or what load() takes. spp: samples per pixel. resolution: (width, height) of the
/// whole picture. integrator: the name of an algorithm, see integrators(), or
/// alhazen.settings.integrator.path(maxdepth=8) and the like. seed: of all random numbers. crop:
/// the part to render, as fractions (x0, x1, y0, y1) from 0 to 1 with y down. layers: names of
/// layers beside the colours, such as "depth". settings: values by name, as in
/// {"integrator.maxdepth": 8}, or settings of alhazen.settings, one or several.
#[pyfunction]
#[pyo3(signature = (
    scene, *, spp=None, resolution=None, integrator=None, seed=None, crop=None, layers=None, settings=None
))]
#[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub fn compile(
    py: Python,
    scene: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = keywords::spp)] spp: Option<u32>,
    #[pyo3(from_py_with = keywords::resolution)] resolution: Option<[i32; 2]>,
    integrator: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = keywords::seed)] seed: Option<i32>,
    #[pyo3(from_py_with = keywords::crop)] crop: Option<[f32; 4]>,
    #[pyo3(from_py_with = keywords::layers)] layers: Option<Vec<String>>,
    settings: Option<&Bound<'_, PyAny>>,
) -> PyResult<Job> {
    let loaded;
    let scene = match scene.cast::<Scene>() {
        Ok(scene) => scene.get(),
        Err(_) => {
            loaded = load(py, scene)?;
            &loaded
        }
    };
    let mut overrides = Overrides {
        samples_per_pixel: spp,
        resolution,
        crop,
        seed,
        layers: layers.unwrap_or_default(),
        ..Overrides::default()
    };
    if let Some(integrator) = integrator {
        match Chosen::of(integrator)? {
            Some(chosen) => choose(&mut overrides, chosen.for_part("integrator")?)?,
            None => {
                let name = integrator.extract().map_err(|_| wrong_type("integrator", ALGORITHM, integrator));
                overrides.integrator = Some(name?);
            }
        }
    }
    if let Some(settings) = settings {
        change(&mut overrides, settings)?;
    }
    let mut desc = scene.imported.desc.clone();
    overrides.apply(&mut desc).map_err(|error| PyValueError::new_err(error.to_string()))?;
    // In the format it is cut to the picture; here it is more likely in pixels.
    let states_crop = overrides.settings.iter().any(|(name, _)| name.ends_with("cropwindow"));
    if let Some(window) = desc.film.crop_window.filter(|window| !keywords::is_part(*window))
        && (states_crop || scene.is_built())
    {
        let problem = format!("`cropwindow` is {}, not {window:?}", keywords::CROP);
        return Err(PyValueError::new_err(problem));
    }
    let compiled =
        call(py, || alhazen::Job::compile(desc))?.map_err(|errors| match overrides.blamed(&errors) {
            Some(error) => PyValueError::new_err(error.to_string()),
            None => scene.error(&errors),
        })?;
    let order = RenderOrder {
        scene: std::path::absolute(&scene.path).unwrap_or_else(|_| scene.path.clone()),
        scene_hash: scene.hash,
        overrides,
        passes: compiled.job.planned(),
        shard: Shard::WHOLE,
        limits: Limits::default(),
    };
    let warnings = scene.lines(&compiled.warnings);
    warn_of_scene(py, &warnings)?;
    Ok(Job { job: Arc::new(Mutex::new(compiled.job)), order, warnings })
}

/// Takes settings over: a dictionary, settings of a part, or a sequence of these.
fn change(overrides: &mut Overrides, settings: &Bound<'_, PyAny>) -> PyResult<()> {
    if let Ok(values) = settings.cast::<PyDict>() {
        overrides.settings.extend(texts(values, "")?);
        return Ok(());
    }
    match Chosen::of(settings)? {
        Some(chosen) => choose(overrides, chosen),
        None if settings.is_instance_of::<PyString>() => Err(wrong_type("settings", SETTINGS, settings)),
        None => {
            let parts = settings.try_iter().map_err(|_| wrong_type("settings", SETTINGS, settings))?;
            parts.into_iter().try_for_each(|part| change(overrides, &part?))
        }
    }
}

/// Takes the settings of a part over.
fn choose(overrides: &mut Overrides, chosen: Chosen) -> PyResult<()> {
    let Chosen { part, name, values } = chosen;
    match (part.as_str(), name) {
        ("integrator", Some(name)) => overrides.integrator = Some(name),
        ("accelerator", Some(name)) => overrides.accelerator = Some(name),
        (_, Some(name)) => overrides.settings.push((part.clone(), name)),
        (_, None) => {}
    }
    overrides.settings.extend(texts(&values, &format!("{part}."))?);
    Ok(())
}

/// Values of settings as texts, under names that begin with a prefix.
fn texts(settings: &Bound<'_, PyDict>, prefix: &str) -> PyResult<Vec<(String, String)>> {
    let text = |value: &Bound<'_, PyAny>| -> PyResult<String> {
        let text = value.str()?.to_string();
        Ok(if value.is_instance_of::<PyBool>() { text.to_lowercase() } else { text })
    };
    let setting = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let is_list = value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>();
        let value = match is_list {
            true => value.try_iter()?.map(|item| text(&item?)).collect::<PyResult<Vec<_>>>()?.join(","),
            false => text(&value)?,
        };
        let name = key.extract::<String>().map_err(|_| wrong_type("settings", SETTINGS, &key))?;
        Ok((format!("{prefix}{name}"), value))
    };
    settings.iter().map(setting).collect()
}

#[pymethods]
impl Job {
    /// The scene file.
    #[getter]
    fn path(&self) -> PathBuf {
        self.order.scene.clone()
    }

    /// The number of passes that are planned, each of one sample per pixel.
    #[getter]
    fn passes(&self) -> u32 {
        self.order.passes
    }

    /// Renders a picture.
    ///
    /// time: seconds after which no pass is begun. noise: the relative error at which it ends. With
    /// one of these and no spp of compile(), the number of passes has no limit. threads: their
    /// number, by default one for each core. progress: True for a line with the time left on
    /// standard error, or a function that is called with a Progress after passes. preview: called
    /// with an Image now and then, at last with the result.
    ///
    /// Ctrl-C ends it with KeyboardInterrupt; an exception of a callback ends it, too.
    #[pyo3(signature = (*, time=None, noise=None, threads=None, progress=None, preview=None))]
    pub fn render(
        &self,
        py: Python,
        #[pyo3(from_py_with = keywords::time)] time: Option<f64>,
        #[pyo3(from_py_with = keywords::noise)] noise: Option<f64>,
        #[pyo3(from_py_with = keywords::threads)] threads: Option<usize>,
        progress: Option<Py<PyAny>>,
        preview: Option<Py<PyAny>>,
    ) -> PyResult<Py<Picture>> {
        let callbacks = Callbacks::new(py, progress, preview, [time, noise])?;
        let limits = Limits { time: time.map(Duration::from_secs_f64), noise };
        let passes = self.order.overrides.passes(self.order.passes, limits.are_set());
        let order = Order { passes: 0..passes, limits, alternates: false, threads };
        let (picture, warnings) = drive(py, &self.job, order, &callbacks, move |job, stop| {
            let state = job.session.state();
            let picture = Picture::collect(&job.header().development(state)).map_err(image_error)?;
            let missed = job.missed_noise(&limits, stop).map(|warning| warning.message);
            let rejected = Some(state.rejected()).filter(|rejected| rejected.count > 0);
            let warnings = missed.into_iter().chain(rejected.map(|rejected| rejected.to_string()));
            Ok((picture, warnings.collect::<Vec<_>>()))
        })?;
        let picture = Py::new(py, Picture::new(py, picture)?)?;
        warn_of_render(py, &warnings)?;
        if let Some(preview) = &callbacks.preview {
            preview.call1(py, (&picture,))?;
        }
        Ok(picture)
    }

    /// Renders one of several parts of the passes, counted from 1. The films of all parts merge to
    /// one whose picture has the same bits as that of render().
    ///
    /// index: which one. count: their number. alternate: whether its passes alternate between two
    /// films, from which the noise of the picture is estimated. limited: whether time or noise ends
    /// the render of all parts, so that without spp of compile() the number of passes has no limit.
    /// threads, progress, preview: as those of render().
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    #[pyo3(signature = (
        index, count, *, alternate=false, limited=false, threads=None, progress=None, preview=None
    ))]
    fn render_shard(
        &self,
        py: Python,
        #[pyo3(from_py_with = keywords::index)] index: u32,
        #[pyo3(from_py_with = keywords::count)] count: u32,
        alternate: bool,
        limited: bool,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
        preview: Option<Py<PyAny>>,
    ) -> PyResult<Film> {
        if !(1..=count).contains(&index) {
            return Err(PyValueError::new_err(format!("there is no shard {index} of {count}")));
        }
        let order = RenderOrder { shard: Shard { index, count }, ..self.whole(limited) };
        let passes = order.shard.passes(order.passes);
        if passes.is_empty() {
            let problem =
                format!("shard {index} of {count} is empty: there are only {} passes", order.passes);
            return Err(PyValueError::new_err(problem));
        }
        let callbacks = Callbacks::new(py, progress, preview, [None; 2])?;
        let what = Order { passes, limits: Limits::default(), alternates: alternate, threads };
        let bytes = drive(py, &self.job, what, &callbacks, move |job, _| {
            order.write(&job.session, job.header(), Vec::new()).map_err(film_error)
        })?;
        Ok(Film::of_file(bytes))
    }

    /// A film of this job without any pass. Only films of the same job merge with it.
    ///
    /// alternate, limited: as those of render_shard().
    #[pyo3(signature = (*, alternate=false, limited=false))]
    fn blank_film(&self, py: Python, alternate: bool, limited: bool) -> PyResult<Film> {
        let order = self.whole(limited);
        let write = || {
            let mut job = free(&self.job)?;
            job.restart(alternate).map_err(image_error)?;
            order.write(&job.session, job.header(), Vec::new()).map_err(film_error)
        };
        Ok(Film::of_file(call(py, write)??))
    }

    fn __repr__(&self) -> String {
        format!("<alhazen.Job {}, {} passes>", self.order.scene.display(), self.order.passes)
    }
}

impl Job {
    /// The order of a render of which it makes parts.
    fn whole(&self, is_limited: bool) -> RenderOrder {
        let passes = self.order.overrides.passes(self.order.passes, is_limited);
        RenderOrder { passes, ..self.order.clone() }
    }
}

/// Renders a scene, or the scene of a file, to a picture: compile() and Job.render() in one call.
///
/// scene: a Scene, or what load() takes. spp: samples per pixel. resolution: (width, height) of the
/// whole picture. integrator: the name of an algorithm, see integrators(), or
/// alhazen.settings.integrator.path(maxdepth=8) and the like. seed: of all random numbers. crop:
/// the part to render, as fractions (x0, x1, y0, y1) from 0 to 1 with y down. layers: names of
/// layers beside the colours, such as "depth". settings: values by name, as in
/// {"integrator.maxdepth": 8}, or settings of alhazen.settings, one or several.
///
/// time: seconds after which no pass is begun. noise: the relative error at which it ends.
/// threads: their number, by default one for each core. progress: True for a line with the time
/// left on standard error, or a function that is called with a Progress after passes. preview:
/// called with an Image now and then, at last with the result.
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
    #[pyo3(from_py_with = keywords::spp)] spp: Option<u32>,
    #[pyo3(from_py_with = keywords::resolution)] resolution: Option<[i32; 2]>,
    integrator: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = keywords::seed)] seed: Option<i32>,
    #[pyo3(from_py_with = keywords::crop)] crop: Option<[f32; 4]>,
    #[pyo3(from_py_with = keywords::layers)] layers: Option<Vec<String>>,
    settings: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = keywords::time)] time: Option<f64>,
    #[pyo3(from_py_with = keywords::noise)] noise: Option<f64>,
    #[pyo3(from_py_with = keywords::threads)] threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    preview: Option<Py<PyAny>>,
) -> PyResult<Py<Picture>> {
    let job = compile(py, scene, spp, resolution, integrator, seed, crop, layers, settings)?;
    job.render(py, time, noise, threads, progress, preview)
}
