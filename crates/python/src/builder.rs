//! Scenes built in Python.

use std::sync::{Mutex, MutexGuard, PoisonError};

use alhazen::import::{Argument, Placement};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::scene::Scene;
use crate::value::{Chosen, Owner, Reference, argument, arguments, motion};

/// Builds a scene: each call is a statement of the pbrt-v4 format, with the names of its types and
/// parameters. Arrays of numpy are copied, so that they may be changed afterwards.
///
///     builder = alhazen.SceneBuilder()
///     builder.camera("perspective", fov=40, transform=alhazen.look_at((0, 1, 5), (0, 0, 0)))
///     red = builder.material("diffuse", reflectance=(0.7, 0.1, 0.1))
///     builder.shape("trianglemesh", P=points, indices=triangles, material=red)
///     builder.light("infinite", L=1.0)
///     scene = builder.build()
///
/// A number for a colour is a grey, three are linear red, green and blue; rgb(), spectrum() and
/// blackbody() state what is meant. A transform is a matrix of 4 × 4 that takes
/// columns to the world, or two of them for the start and the end of the shutter time.
#[pyclass(frozen, module = "alhazen")]
#[derive(Default)]
pub struct SceneBuilder {
    /// References to things of other builders are refused.
    owner: Owner,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    builder: alhazen::import::SceneBuilder,
    /// The number of things that have names.
    names: u32,
}

impl State {
    fn name(&mut self, owner: &Owner, kind: &'static str) -> Reference {
        self.names += 1;
        Reference { kind, name: format!("{kind}-{}", self.names), owner: owner.clone() }
    }
}

impl SceneBuilder {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn set(
        &self,
        (directive, part): (&str, &str),
        kind: &Bound<'_, PyAny>,
        default: &str,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let (kind, arguments) = kind_of(part, kind, default, parameters, &self.owner)?;
        self.state().builder.set(directive, &kind, arguments).map_err(PyValueError::new_err)
    }
}

#[pymethods]
impl SceneBuilder {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Sets the film: its type, by default "rgb", or alhazen.settings.film(), and parameters, such
    /// as xresolution.
    #[pyo3(signature = (kind=None, /, **parameters))]
    fn film(
        &self,
        py: Python,
        kind: Option<&Bound<'_, PyAny>>,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let kind = kind.map_or_else(|| py.None().into_bound(py), Bound::clone);
        self.set(("Film", "film"), &kind, "rgb", parameters)
    }

    /// Sets the sampler: its type, such as "zsobol", or alhazen.settings.sampler.zsobol() and the
    /// like, and parameters, such as pixelsamples.
    #[pyo3(signature = (kind, /, **parameters))]
    fn sampler(&self, kind: &Bound<'_, PyAny>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        self.set(("Sampler", "sampler"), kind, "", parameters)
    }

    /// Sets the pixel filter: its type, such as "gaussian", or alhazen.settings.filter.gaussian()
    /// and the like, and parameters.
    #[pyo3(signature = (kind, /, **parameters))]
    fn filter(&self, kind: &Bound<'_, PyAny>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        self.set(("PixelFilter", "filter"), kind, "", parameters)
    }

    /// Sets the algorithm: its name, such as "path", or alhazen.settings.integrator.path() and the
    /// like, and parameters, such as maxdepth.
    #[pyo3(signature = (kind, /, **parameters))]
    fn integrator(&self, kind: &Bound<'_, PyAny>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        self.set(("Integrator", "integrator"), kind, "", parameters)
    }

    /// Sets options of the whole scene, such as seed.
    #[pyo3(signature = (**options))]
    fn options(&self, options: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        for Argument { name, values, .. } in arguments(options, &self.owner)? {
            self.state().builder.option(&name, values).map_err(PyValueError::new_err)?;
        }
        Ok(())
    }

    /// Sets the camera: its type, by default "perspective", or alhazen.settings.camera(), and
    /// parameters, such as fov; where it is, and the medium around it. It looks along +z of its own
    /// system, with y up, as look_at() makes it.
    #[pyo3(signature = (kind=None, /, *, transform=None, medium=None, **parameters))]
    fn camera(
        &self,
        py: Python,
        kind: Option<&Bound<'_, PyAny>>,
        transform: Option<&Bound<'_, PyAny>>,
        medium: Option<&Bound<'_, PyAny>>,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let kind = kind.map_or_else(|| py.None().into_bound(py), Bound::clone);
        let (kind, arguments) = kind_of("camera", &kind, "perspective", parameters, &self.owner)?;
        let (motion, medium) = (motion(transform)?, name(medium, &self.owner, "medium")?);
        self.state().builder.camera(&kind, arguments, motion, medium);
        Ok(())
    }

    /// Adds a texture, whose values are "float" or "spectrum".
    #[pyo3(signature = (values, kind, /, *, transform=None, **parameters))]
    fn texture(
        &self,
        values: &str,
        kind: &str,
        transform: Option<&Bound<'_, PyAny>>,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Reference> {
        let is_spectrum = match values {
            "float" => false,
            "spectrum" => true,
            other => {
                let problem = format!("a texture's values are \"float\" or \"spectrum\", not {other:?}");
                return Err(PyValueError::new_err(problem));
            }
        };
        let (arguments, motion) = (arguments(parameters, &self.owner)?, motion(transform)?);
        let mut state = self.state();
        let reference = state.name(&self.owner, "texture");
        state.builder.texture(&reference.name, is_spectrum, kind, arguments, motion.0[0]);
        Ok(reference)
    }

    /// Adds a material: its type, such as "diffuse", and parameters, such as reflectance.
    #[pyo3(signature = (kind, /, **parameters))]
    fn material(&self, kind: &str, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Reference> {
        let arguments = arguments(parameters, &self.owner)?;
        let mut state = self.state();
        let reference = state.name(&self.owner, "material");
        state.builder.material(&reference.name, kind, arguments);
        Ok(reference)
    }

    /// Adds a participating medium: its type, such as "homogeneous", and parameters.
    #[pyo3(signature = (kind, /, *, transform=None, **parameters))]
    fn medium(
        &self,
        kind: &str,
        transform: Option<&Bound<'_, PyAny>>,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Reference> {
        let (arguments, motion) = (arguments(parameters, &self.owner)?, motion(transform)?);
        let mut state = self.state();
        let reference = state.name(&self.owner, "medium");
        state.builder.medium(&reference.name, kind, arguments, motion);
        Ok(reference)
    }

    /// Adds a light: its type, such as "point", and parameters, such as I; the medium that it is
    /// in.
    #[pyo3(signature = (kind, /, *, transform=None, medium=None, **parameters))]
    fn light(
        &self,
        kind: &str,
        transform: Option<&Bound<'_, PyAny>>,
        medium: Option<&Bound<'_, PyAny>>,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let (arguments, motion, medium) =
            (arguments(parameters, &self.owner)?, motion(transform)?, name(medium, &self.owner, "medium")?);
        self.state().builder.light(kind, arguments, motion, medium);
        Ok(())
    }

    /// Adds a shape: its type, such as "sphere" or "trianglemesh", and parameters, such as P and
    /// indices.
    ///
    /// material: its material. emission: the parameters of an area light, as a dict such as
    /// {"L": 5.0}, or only its L. inside, outside: the media on its two sides. object: the object
    /// that it belongs to, instead of the world. reverse_orientation: turns its surface inside out.
    #[pyo3(signature = (
        kind, /, *, transform=None, material=None, emission=None, inside=None, outside=None, object=None,
        reverse_orientation=false, **parameters
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn shape(
        &self,
        kind: &str,
        transform: Option<&Bound<'_, PyAny>>,
        material: Option<&Bound<'_, PyAny>>,
        emission: Option<&Bound<'_, PyAny>>,
        inside: Option<&Bound<'_, PyAny>>,
        outside: Option<&Bound<'_, PyAny>>,
        object: Option<&Bound<'_, PyAny>>,
        reverse_orientation: bool,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let media = [name(inside, &self.owner, "medium")?, name(outside, &self.owner, "medium")?];
        let placement = Placement {
            motion: motion(transform)?,
            reverse_orientation,
            material: name(material, &self.owner, "material")?,
            area_light: emission.map(|emission| area_light(emission, &self.owner)).transpose()?,
            media: media.iter().any(Option::is_some).then(|| media.map(Option::unwrap_or_default)),
            object: name(object, &self.owner, "object")?,
        };
        let arguments = arguments(parameters, &self.owner)?;
        self.state().builder.shape(kind, arguments, placement);
        Ok(())
    }

    /// Adds an object, to which shapes and instances can be added. It is drawn where it has
    /// instances.
    fn object(&self) -> Reference {
        let mut state = self.state();
        let reference = state.name(&self.owner, "object");
        state.builder.object(&reference.name);
        reference
    }

    /// Adds an instance of an object to the world, or to another object.
    #[pyo3(signature = (object, /, *, transform=None, into=None))]
    fn instance(
        &self,
        object: &Bound<'_, PyAny>,
        transform: Option<&Bound<'_, PyAny>>,
        into: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (object, motion) =
            (name(Some(object), &self.owner, "object")?.unwrap_or_default(), motion(transform)?);
        let into = name(into, &self.owner, "object")?;
        self.state().builder.instance(&object, motion, into.as_deref());
        Ok(())
    }

    /// The scene of all calls so far. Files that it names are relative to the current folder.
    ///
    /// Raises SceneError, whose text lists every error with the call that has caused it.
    fn build(&self, py: Python) -> PyResult<Scene> {
        let builder = self.state().builder.clone();
        Scene::built(py, builder)
    }
}

/// The type and the parameters of a call for a part of a scene: the type is a name, settings, or
/// the default.
fn kind_of(
    part: &str,
    kind: &Bound<'_, PyAny>,
    default: &str,
    parameters: Option<&Bound<'_, PyDict>>,
    owner: &Owner,
) -> PyResult<(String, Vec<Argument>)> {
    let mut given = arguments(parameters, owner)?;
    let kind = match Chosen::of(kind)? {
        Some(chosen) => {
            let Chosen { name, values, .. } = chosen.for_part(part)?;
            given.extend(arguments(Some(&values), owner)?);
            name.unwrap_or_else(|| default.to_owned())
        }
        None if kind.is_none() => default.to_owned(),
        None => kind.extract()?,
    };
    Ok((kind, given))
}

/// The name that a reference of this kind, to a thing of this builder, has.
fn name(reference: Option<&Bound<'_, PyAny>>, owner: &Owner, kind: &str) -> PyResult<Option<String>> {
    let Some(value) = reference else { return Ok(None) };
    match value.cast::<Reference>() {
        Ok(reference) if reference.get().kind == kind => reference.get().of(owner).map(Some),
        Ok(reference) => {
            Err(PyTypeError::new_err(format!("expected a {kind}, not a {}", reference.get().kind)))
        }
        Err(_) => Err(PyTypeError::new_err(format!("expected what {kind}() gave, not {}", value.repr()?))),
    }
}

/// What a shape emits.
fn area_light(emission: &Bound<'_, PyAny>, owner: &Owner) -> PyResult<(String, Vec<Argument>)> {
    let arguments = match emission.cast::<PyDict>() {
        Ok(parameters) => arguments(Some(parameters), owner)?,
        Err(_) => vec![argument("L".into(), emission, owner)?],
    };
    Ok(("diffuse".into(), arguments))
}
