//! Scenes built in Python.

use std::sync::{Mutex, MutexGuard, PoisonError};

use alhazen::math::{DMat4, DVec3};
use alhazen::pbrt::{Argument, ArgumentValues, Motion, Placement};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::color;
use crate::errors::{shown, wrong_type};
use crate::keywords;
use crate::place::{Calls, Place};
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
///
/// handedness: that of the world, "right" as in glTF, OBJ, Blender and arrays of most programs, or
/// "left" as in the pbrt format, for scenes that are typed from there.
#[pyclass(frozen, module = "alhazen")]
pub struct SceneBuilder {
    /// Whether the world is right-handed: cameras, and lights with a picture, are mirrored then.
    is_right_handed: bool,
    /// References to things of other builders are refused.
    owner: Owner,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    builder: alhazen::pbrt::SceneBuilder,
    calls: Calls,
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
        directive: &str,
        part: &'static str,
        kind: &Bound<'_, PyAny>,
        default: &str,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let py = kind.py();
        let (kind, arguments) = kind_of(part, kind, default, parameters, &self.owner)?;
        let mut state = self.calling(py, part);
        state.builder.set(directive, &kind, arguments).map_err(PyValueError::new_err)
    }

    /// The state, to which the call of a method is added.
    fn calling(&self, py: Python, method: &'static str) -> MutexGuard<'_, State> {
        // Before the lock is taken: Python may let another thread go on.
        let place = Place::of_caller(py);
        let mut state = self.state();
        state.calls.add(method, place.as_ref());
        state
    }

    /// The place of a camera or projector. Its system, in which it looks along +z with y up and x
    /// to the right, is left-handed, so that its x is mirrored in a right-handed world.
    fn looking(&self, motion: Motion) -> Motion {
        self.mirrored(motion, DVec3::new(-1.0, 1.0, 1.0))
    }

    fn mirrored(&self, motion: Motion, axes: DVec3) -> Motion {
        match self.is_right_handed {
            true => Motion(motion.0.map(|matrix| matrix * DMat4::from_scale(axes))),
            false => motion,
        }
    }

    /// The place of a light. Around an environment of the format u increases from +x to +y, which
    /// is to the right in a left-handed world; so y is mirrored in a right-handed one. A measured
    /// luminaire is counterclockwise from +x to +z, seen from +y, in a left-handed world.
    fn lighting(&self, kind: &str, arguments: &[Argument], motion: Motion) -> Motion {
        let file = arguments.iter().find(|argument| argument.name == "filename");
        let Some(ArgumentValues::Strings(file)) = file.map(|file| &file.values) else { return motion };
        let is_measured = file.iter().any(|name| name.to_ascii_lowercase().ends_with(".ies"));
        match kind {
            "projection" => self.looking(motion),
            "infinite" => self.mirrored(motion, DVec3::new(1.0, -1.0, 1.0)),
            "goniometric" if is_measured => self.mirrored(motion, DVec3::new(1.0, 1.0, -1.0)),
            _ => motion,
        }
    }
}

#[pymethods]
impl SceneBuilder {
    #[new]
    #[pyo3(signature = (*, handedness="right"))]
    fn new(handedness: &str) -> PyResult<Self> {
        let is_right_handed = match handedness {
            "right" => true,
            "left" => false,
            other => {
                let problem = format!("`handedness` is \"right\" or \"left\", not {other:?}");
                return Err(PyValueError::new_err(problem));
            }
        };
        Ok(Self { is_right_handed, owner: Owner::default(), state: Mutex::default() })
    }

    /// The handedness of its world, "right" or "left".
    #[getter]
    fn handedness(&self) -> &'static str {
        if self.is_right_handed { "right" } else { "left" }
    }

    /// Sets the film.
    ///
    /// kind: its type, by default "rgb", or alhazen.settings.film(). parameters: such as
    /// xresolution.
    #[pyo3(signature = (kind=None, /, **parameters))]
    fn film(
        &self,
        py: Python,
        kind: Option<&Bound<'_, PyAny>>,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let kind = kind.map_or_else(|| py.None().into_bound(py), Bound::clone);
        self.set("Film", "film", &kind, "rgb", parameters)
    }

    /// Sets the sampler.
    ///
    /// kind: its type, such as "zsobol", or alhazen.settings.sampler.zsobol() and the like.
    /// parameters: such as pixelsamples.
    #[pyo3(signature = (kind, /, **parameters))]
    fn sampler(&self, kind: &Bound<'_, PyAny>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        self.set("Sampler", "sampler", kind, "", parameters)
    }

    /// Sets the pixel filter.
    ///
    /// kind: its type, such as "gaussian", or alhazen.settings.filter.gaussian() and the like.
    /// parameters: such as xradius.
    #[pyo3(signature = (kind, /, **parameters))]
    fn filter(&self, kind: &Bound<'_, PyAny>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        self.set("PixelFilter", "filter", kind, "", parameters)
    }

    /// Sets the algorithm.
    ///
    /// kind: its name, such as "path", or alhazen.settings.integrator.path() and the like.
    /// parameters: such as maxdepth.
    #[pyo3(signature = (kind, /, **parameters))]
    fn integrator(&self, kind: &Bound<'_, PyAny>, parameters: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        self.set("Integrator", "integrator", kind, "", parameters)
    }

    /// Sets options of the whole scene.
    ///
    /// options: by name, such as seed.
    #[pyo3(signature = (**options))]
    fn options(&self, py: Python, options: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let (options, place) = (arguments(options, &self.owner)?, Place::of_caller(py));
        for Argument { name, values, .. } in options {
            let mut state = self.state();
            state.builder.option(&name, values).map_err(PyValueError::new_err)?;
            state.calls.add("options", place.as_ref());
        }
        Ok(())
    }

    /// Sets the camera.
    ///
    /// kind: its type, by default "perspective", or alhazen.settings.camera(). parameters: such as
    /// fov. transform: its place, as look_at() gives it: it looks along +z of its own system, with
    /// y up. One of Blender, glTF or OpenGL looks along -z: matrix @ alhazen.rotate(180, (0, 1,
    /// 0)). medium: the one around it.
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
        // The format's panoramas increase to the left, and so to the right in a right-handed world.
        let motion = if kind == "spherical" { motion } else { self.looking(motion) };
        self.calling(py, "camera").builder.camera(&kind, arguments, motion, medium);
        Ok(())
    }

    /// Adds a texture.
    ///
    /// values: "float" or "spectrum". kind: its type, such as "imagemap". parameters: such as
    /// filename. transform: the place of a texture of space.
    #[pyo3(signature = (values, kind, /, *, transform=None, **parameters))]
    fn texture(
        &self,
        py: Python,
        values: &str,
        #[pyo3(from_py_with = keywords::kind)] kind: String,
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
        if is_spectrum {
            color::check_texture(&arguments)?;
        }
        let mut state = self.calling(py, "texture");
        let reference = state.name(&self.owner, "texture");
        state.builder.texture(&reference.name, is_spectrum, &kind, arguments, motion.0[0]);
        Ok(reference)
    }

    /// Adds a material.
    ///
    /// kind: its type, such as "diffuse". parameters: such as reflectance, whose colours are from 0
    /// to 1.
    #[pyo3(signature = (kind, /, **parameters))]
    fn material(
        &self,
        py: Python,
        #[pyo3(from_py_with = keywords::kind)] kind: String,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Reference> {
        let arguments = arguments(parameters, &self.owner)?;
        color::check_material(&arguments)?;
        let mut state = self.calling(py, "material");
        let reference = state.name(&self.owner, "material");
        state.builder.material(&reference.name, &kind, arguments);
        Ok(reference)
    }

    /// Adds a participating medium.
    ///
    /// kind: its type, such as "homogeneous". parameters: such as sigma_s. transform: its place.
    #[pyo3(signature = (kind, /, *, transform=None, **parameters))]
    fn medium(
        &self,
        py: Python,
        #[pyo3(from_py_with = keywords::kind)] kind: String,
        transform: Option<&Bound<'_, PyAny>>,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Reference> {
        let (arguments, motion) = (arguments(parameters, &self.owner)?, motion(transform)?);
        let mut state = self.calling(py, "medium");
        let reference = state.name(&self.owner, "medium");
        state.builder.medium(&reference.name, &kind, arguments, motion);
        Ok(reference)
    }

    /// Adds a light.
    ///
    /// kind: its type, such as "point". parameters: such as I. transform: its place. The image of
    /// the light "infinite" has +z up and -x in its middle; "projection" looks along +z, as cameras
    /// do. medium: the one that it is in.
    #[pyo3(signature = (kind, /, *, transform=None, medium=None, **parameters))]
    fn light(
        &self,
        py: Python,
        #[pyo3(from_py_with = keywords::kind)] kind: String,
        transform: Option<&Bound<'_, PyAny>>,
        medium: Option<&Bound<'_, PyAny>>,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let (arguments, motion, medium) =
            (arguments(parameters, &self.owner)?, motion(transform)?, name(medium, &self.owner, "medium")?);
        let motion = self.lighting(&kind, &arguments, motion);
        self.calling(py, "light").builder.light(&kind, arguments, motion, medium);
        Ok(())
    }

    /// Adds a shape.
    ///
    /// kind: its type, such as "sphere" or "trianglemesh". parameters: such as P and indices.
    /// transform: its place. material: its material, by default a grey one. emission: the
    /// parameters of an area light, as a dict such as {"L": 5.0}, or only its L. inside, outside:
    /// the media on its two sides. object: the object that it belongs to, instead of the world.
    /// reverse_orientation: turns its surface inside out.
    #[pyo3(signature = (
        kind, /, *, transform=None, material=None, emission=None, inside=None, outside=None, object=None,
        reverse_orientation=false, **parameters
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn shape(
        &self,
        py: Python,
        #[pyo3(from_py_with = keywords::kind)] kind: String,
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
        let (arguments, place) = (arguments(parameters, &self.owner)?, Place::of_caller(py));
        let mut state = self.state();
        if placement.area_light.is_some() {
            state.calls.add("emission", place.as_ref());
        }
        state.calls.add("shape", place.as_ref());
        state.builder.shape(&kind, arguments, placement);
        Ok(())
    }

    /// Adds an object, to which shapes and instances can be added. It is drawn where it has
    /// instances.
    fn object(&self, py: Python) -> Reference {
        let mut state = self.calling(py, "object");
        let reference = state.name(&self.owner, "object");
        state.builder.object(&reference.name);
        reference
    }

    /// Adds an instance of an object.
    ///
    /// object: what object() gave. transform: its place. into: the object that it becomes part of,
    /// instead of the world.
    #[pyo3(signature = (object, /, *, transform=None, into=None))]
    fn instance(
        &self,
        py: Python,
        object: &Bound<'_, PyAny>,
        transform: Option<&Bound<'_, PyAny>>,
        into: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (object, motion) =
            (name(Some(object), &self.owner, "object")?.unwrap_or_default(), motion(transform)?);
        let into = name(into, &self.owner, "object")?;
        self.calling(py, "instance").builder.instance(&object, motion, into.as_deref());
        Ok(())
    }

    /// The scene of all calls so far. Files that it names are relative to the current folder.
    ///
    /// Raises SceneError, whose text lists every error with the call that has caused it and its
    /// place in the program.
    fn build(&self, py: Python) -> PyResult<Scene> {
        let (builder, calls) = {
            let state = self.state();
            (state.builder.clone(), state.calls.clone())
        };
        Scene::built(py, builder, calls)
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
        None => kind.extract().map_err(|_| {
            let wanted = format!("the name of a type, or alhazen.settings.{part}");
            wrong_type(part, &wanted, kind)
        })?,
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
        Err(_) => Err(PyTypeError::new_err(format!("expected what {kind}() gave, not {}", shown(value)))),
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
