//! Values of Python as parameters of a scene.

use std::path::PathBuf;
use std::sync::Arc;

use alhazen::math::DMat4;
use alhazen::pbrt::{Argument, ArgumentValues, Motion};
use numpy::{
    PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

use crate::errors::{shown, wrong_type};

/// A builder, by the address of what its references share.
pub type Owner = Arc<()>;

/// A thing of a SceneBuilder that others refer to: a texture, material, medium or object.
#[pyclass(frozen, module = "alhazen")]
#[derive(Clone)]
pub struct Reference {
    /// The kind of object, such as "material".
    #[pyo3(get)]
    pub kind: &'static str,
    /// Its name in the scene.
    #[pyo3(get)]
    pub name: String,
    /// Its builder.
    pub owner: Owner,
}

impl Reference {
    /// Its name in the scene of a builder.
    pub fn of(&self, builder: &Owner) -> PyResult<String> {
        if !Arc::ptr_eq(&self.owner, builder) {
            let problem = format!("the {} {:?} is of another SceneBuilder", self.kind, self.name);
            return Err(PyValueError::new_err(problem));
        }
        Ok(self.name.clone())
    }
}

#[pymethods]
impl Reference {
    fn __repr__(&self) -> String {
        format!("<alhazen.Reference {} {:?}>", self.kind, self.name)
    }
}

/// A value of a stated type of the format, such as rgb(0.2, 0.4, 0.1).
#[pyclass(frozen, get_all, module = "alhazen")]
pub struct Typed {
    /// The name of the type.
    type_name: &'static str,
    /// The values.
    values: Py<PyAny>,
}

#[pymethods]
impl Typed {
    fn __repr__(&self) -> String {
        format!("<alhazen.Typed {}>", self.type_name)
    }
}

/// A colour.
///
/// red, green, blue: linear light, from 0 to 1 for reflectances.
#[pyfunction]
pub fn rgb(py: Python, red: f32, green: f32, blue: f32) -> PyResult<Typed> {
    let values = PyTuple::new(py, [red, green, blue])?;
    Ok(Typed { type_name: "rgb", values: values.into_any().unbind() })
}

/// The spectrum of a black body.
///
/// kelvin: its temperature.
#[pyfunction]
pub fn blackbody(py: Python, kelvin: f32) -> Typed {
    Typed { type_name: "blackbody", values: PyFloat::new(py, kelvin.into()).into_any().unbind() }
}

/// A spectrum.
///
/// values: the name of a measured one, such as "metal-Au-eta", or of a file; or an array of
/// wavelengths in nanometres and values in turn.
#[pyfunction]
pub fn spectrum(values: Py<PyAny>) -> Typed {
    Typed { type_name: "spectrum", values }
}

/// All parameters of a call of a builder.
pub fn arguments(parameters: Option<&Bound<'_, PyDict>>, owner: &Owner) -> PyResult<Vec<Argument>> {
    let Some(parameters) = parameters else { return Ok(Vec::new()) };
    let named = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let name: String = name.extract()?;
        argument(name, &value, owner)
    };
    parameters.iter().filter(|(_, value)| !value.is_none()).map(named).collect()
}

/// A parameter of a call; errors name it.
pub fn argument(name: String, value: &Bound<'_, PyAny>, owner: &Owner) -> PyResult<Argument> {
    let py = value.py();
    let (type_name, values, row) = read(value, owner).map_err(|error| {
        let problem = format!("`{name}`: {}", error.value(py));
        match error.is_instance_of::<PyTypeError>(py) {
            true => PyTypeError::new_err(problem),
            false => PyValueError::new_err(problem),
        }
    })?;
    Ok(Argument { name, type_name: type_name.map(str::to_owned), values, row })
}

/// Settings of a part of a scene: an object of the class `alhazen.settings.Settings`.
pub struct Chosen<'py> {
    /// The part, such as `integrator`.
    pub part: String,
    /// The chosen member of a set.
    pub name: Option<String>,
    /// Values by name.
    pub values: Bound<'py, PyDict>,
}

impl<'py> Chosen<'py> {
    /// `None` if the value is something else.
    pub fn of(value: &Bound<'py, PyAny>) -> PyResult<Option<Self>> {
        let is_settings = value.get_type().name()? == "Settings" && value.hasattr("part")?;
        let get = |name: &str| value.getattr(name);
        is_settings
            .then(|| {
                Ok(Self {
                    part: get("part")?.extract()?,
                    name: get("name")?.extract()?,
                    values: get("values")?.cast_into()?,
                })
            })
            .transpose()
    }

    /// The settings, if they are those of this part.
    pub fn for_part(self, part: &str) -> PyResult<Self> {
        if self.part != part {
            let problem = format!("expected settings of the {part}, not of the {}", self.part);
            return Err(PyTypeError::new_err(problem));
        }
        Ok(self)
    }
}

/// A value, with its type where that is stated, and the length of its rows where it has some.
fn read(
    value: &Bound<'_, PyAny>,
    owner: &Owner,
) -> PyResult<(Option<&'static str>, ArgumentValues, Option<usize>)> {
    if let Ok(typed) = value.cast::<Typed>() {
        let typed = typed.get();
        let (_, values, row) = read(typed.values.bind(value.py()), owner)?;
        return Ok((Some(typed.type_name), values, row));
    }
    if let Ok(reference) = value.cast::<Reference>() {
        let reference = reference.get();
        let type_name = (reference.kind == "texture").then_some("texture");
        return Ok((type_name, ArgumentValues::Strings(vec![reference.of(owner)?]), None));
    }
    let plain = if let Ok(flag) = value.cast::<PyBool>() {
        ArgumentValues::Bools(vec![flag.is_true()])
    } else if value.is_instance_of::<PyInt>() {
        let integer = value.extract::<i32>().map_err(|_| {
            let problem = format!(
                "expected a whole number of 32 bits, or a real one such as 1e12, not {}",
                shown(value)
            );
            PyValueError::new_err(problem)
        })?;
        ArgumentValues::Integers([integer].into())
    } else if value.is_instance_of::<PyFloat>() {
        ArgumentValues::Floats([value.extract()?].into())
    } else if value.is_instance_of::<PyString>() || value.hasattr("__fspath__")? {
        ArgumentValues::Strings(vec![text(value, owner)?])
    } else if let Some(texts) = texts(value, owner)? {
        ArgumentValues::Strings(texts)
    } else {
        let (values, row) = array(value)?;
        return Ok((None, values, row));
    };
    Ok((None, plain, None))
}

fn text(value: &Bound<'_, PyAny>, owner: &Owner) -> PyResult<String> {
    if let Ok(reference) = value.cast::<Reference>() {
        return reference.get().of(owner);
    }
    let path: PathBuf = value.extract()?;
    path.into_os_string().into_string().map_err(|_| PyValueError::new_err("a path that is no text"))
}

/// A list of texts or of references.
fn texts(value: &Bound<'_, PyAny>, owner: &Owner) -> PyResult<Option<Vec<String>>> {
    if !value.is_instance_of::<PyList>() && !value.is_instance_of::<PyTuple>() {
        return Ok(None);
    }
    let mut texts = Vec::new();
    for item in value.try_iter()? {
        let item = item?;
        match text(&item, owner) {
            Ok(text) => texts.push(text),
            Err(error) if item.is_instance_of::<Reference>() => return Err(error),
            Err(_) => return Ok(None),
        }
    }
    Ok((!texts.is_empty()).then_some(texts))
}

/// The values of an array, or of what numpy makes one of, in the order of rows, and the length of
/// these where it has several dimensions.
fn array(value: &Bound<'_, PyAny>) -> PyResult<(ArgumentValues, Option<usize>)> {
    let numpy = value.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (value,)).map_err(|_| {
        let problem = format!("expected rows of numbers of one length, not {}", shown(value));
        PyValueError::new_err(problem)
    })?;
    let untyped = array.cast::<PyUntypedArray>()?;
    let (element, shape) = (untyped.dtype(), untyped.shape());
    let row = shape.last().copied().filter(|_| shape.len() > 1);
    let of = |name: &str| numpy.call_method1("ascontiguousarray", (&array, name));
    let values = match element.kind() {
        b'f' => ArgumentValues::Floats(copied(&of("float32")?)?),
        b'b' => ArgumentValues::Bools(copied::<u8>(&of("uint8")?)?.iter().map(|&flag| flag != 0).collect()),
        b'i' | b'u' => {
            let is_wide = array.getattr("size")?.extract::<usize>()? > 0
                && (array.call_method0("max")?.gt(i32::MAX)? || array.call_method0("min")?.lt(i32::MIN)?);
            if is_wide {
                return Err(PyValueError::new_err("whole numbers have 32 bits; real ones may be larger"));
            }
            ArgumentValues::Integers(copied(&of("int32")?)?)
        }
        _ => {
            let problem = format!("expected numbers, texts or truth values, not {}", shown(value));
            return Err(PyTypeError::new_err(problem));
        }
    };
    Ok((values, row))
}

/// The one copy of an array: into memory of our own, as Python may change the array at any time,
/// also while threads without its lock render.
fn copied<T: numpy::Element + Copy>(array: &Bound<'_, PyAny>) -> PyResult<Arc<[T]>> {
    let array: PyReadonlyArrayDyn<T> = array.cast::<PyArrayDyn<T>>()?.readonly();
    let values = array.as_slice().map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(values.into())
}

/// A 4 × 4 matrix that takes column vectors to the world, or two for the start and the end of the
/// shutter time.
pub fn motion(transform: Option<&Bound<'_, PyAny>>) -> PyResult<Motion> {
    let Some(transform) = transform else { return Ok(Motion::default()) };
    let numpy = transform.py().import("numpy")?;
    let array = numpy.call_method1("ascontiguousarray", (transform, "float64")).map_err(|_| {
        let wanted = "a matrix of 4 × 4 numbers, such as alhazen.translate(0, 1, 0), or two of them";
        wrong_type("transform", wanted, transform)
    })?;
    let shape = array.cast::<PyUntypedArray>()?.shape().to_vec();
    let values = copied::<f64>(&array)?;
    let matrix = |values: &[f64]| {
        let mut all = [0.0; 16];
        all.copy_from_slice(values);
        DMat4::from_cols_array(&all).transpose()
    };
    if values.iter().any(|value| !value.is_finite()) {
        return Err(PyValueError::new_err("a transform has numbers that are not finite"));
    }
    match shape[..] {
        [4, 4] => Ok(Motion([matrix(&values); 2])),
        [2, 4, 4] => Ok(Motion([matrix(&values[..16]), matrix(&values[16..])])),
        _ => Err(PyValueError::new_err(format!("a transform is 4 × 4, or 2 × 4 × 4, not {shape:?}"))),
    }
}
