//! Pictures.

use std::ffi::CString;
use std::path::PathBuf;

use alhazen::description::GBufferSpace;
use alhazen::film::Layer;
use alhazen::image::{
    self, Attribute, DisplaySettings, DisplayView, DisplayWhite, Format, Image, ImageError, ImageMetadata,
    PixelSource, Pixels, ReadOptions, SampleDepth, WriteOptions,
};
use alhazen::{InSrgb, write_picture};
use numpy::ndarray::Array3;
use numpy::{
    PyArray3, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyKeyError, PyTypeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PySlice, PyTuple};

use crate::calls::call;
use crate::errors::{image_error, image_file_error};

/// A picture: linear light, and layers beside it.
///
/// numpy.asarray(picture) is height × width × 3 float32, red, green and blue, in the memory of the
/// picture. picture["depth"] is a layer: height × width, or height × width × n if it has n
/// channels. Its name is that of compile(layers=[…]), or that in a file, such as "Z".
#[pyclass(frozen, name = "Image", module = "alhazen")]
pub struct Picture {
    /// Rows from the top, pixels from the left, channels.
    pixels: Py<PyArray3<f32>>,
    channels: Vec<String>,
    metadata: ImageMetadata,
}

impl Picture {
    /// Reads all rows of a picture.
    pub fn collect(source: &dyn PixelSource) -> Result<Collected, ImageError> {
        let channels: Vec<String> = source.channels().into_iter().map(|channel| channel.name).collect();
        let shape = [source.height() as usize, source.width() as usize, channels.len()];
        let count = shape.iter().product();
        let mut values = Vec::new();
        values
            .try_reserve_exact(count)
            .map_err(|_| ImageError::Limits(format!("there is no memory for a picture of {count} values")))?;
        values.resize(count, 0.0);
        for (y, row) in values.chunks_exact_mut(shape[1] * shape[2]).enumerate() {
            source.row(y as u32, row);
        }
        Ok(Collected { shape, channels, values, metadata: source.metadata().clone() })
    }

    /// The picture with its values moved into an array of numpy.
    pub fn new(py: Python, collected: Collected) -> PyResult<Self> {
        let Collected { shape, channels, values, metadata } = collected;
        let array =
            Array3::from_shape_vec(shape, values).map_err(|e| PyValueError::new_err(e.to_string()))?;
        Ok(Self { pixels: PyArray3::from_owned_array(py, array).unbind(), channels, metadata })
    }

    /// A copy of the picture.
    pub fn image(&self, py: Python) -> PyResult<Image> {
        let pixels = self.pixels.bind(py);
        let [height, width, _] = [0, 1, 2].map(|axis| pixels.shape()[axis] as u32);
        let values = Pixels::F32(pixels.to_vec()?);
        let mut image = Image::new(width, height, self.channels.clone(), values).map_err(image_error)?;
        image.metadata = self.metadata.clone();
        Ok(image)
    }

    /// A view of the channels with these indices, which follow each other.
    fn view<'py>(&self, py: Python<'py>, first: usize, count: usize) -> PyResult<Bound<'py, PyAny>> {
        let all = PySlice::full(py);
        let pixels = self.pixels.bind(py);
        if count == 1 {
            return pixels.get_item((&all, &all, first));
        }
        let channels = PySlice::new(py, first as isize, (first + count) as isize, 1);
        pixels.get_item((&all, &all, channels))
    }

    /// The first channel and the number of channels of a layer.
    fn find(&self, layer: &str) -> Option<(usize, usize)> {
        let first = self.channels.iter().position(|channel| layer_of(channel) == layer)?;
        let count = self.channels[first..].iter().take_while(|channel| layer_of(channel) == layer).count();
        Some((first, count))
    }

    /// The same of a layer by the name with which it is rendered.
    fn find_rendered(&self, name: &str) -> Option<(usize, usize)> {
        let layer = Layer::from_name(name)?;
        let wanted: Box<dyn Fn(&str) -> bool> = match layer {
            Layer::LightGroups => return None,
            _ if !layer.cryptomatte().is_empty() => {
                Box::new(|channel| channel.starts_with(layer.cryptomatte()))
            }
            _ => {
                // In a geometry buffer some names depend on its space.
                let spaces = [GBufferSpace::Camera, GBufferSpace::World].map(Some);
                let [camera, world] = spaces.map(|space| layer.channels(space));
                let is_gbuffer = self.channels.iter().any(|channel| channel == "Albedo.R");
                let names = match is_gbuffer {
                    true if camera != world => return None,
                    true => camera,
                    false => layer.channels(None),
                };
                Box::new(|channel| names.contains(&channel))
            }
        };
        let first = self.channels.iter().position(|channel| wanted(channel))?;
        let count = self.channels[first..].iter().take_while(|channel| wanted(channel)).count();
        Some((first, count))
    }
}

/// The values of a picture.
pub struct Collected {
    shape: [usize; 3],
    channels: Vec<String>,
    values: Vec<f32>,
    metadata: ImageMetadata,
}

impl Collected {
    /// Puts the channels in an order, where it has all their names.
    fn reorder(&mut self, channels: Vec<String>) {
        let index = |name| self.channels.iter().position(|channel| channel == name);
        let Some(order) = channels.iter().map(index).collect::<Option<Vec<_>>>() else { return };
        if order.len() != self.channels.len() {
            return;
        }
        for pixel in self.values.chunks_exact_mut(order.len()) {
            let old = pixel.to_vec();
            order.iter().zip(pixel).for_each(|(&from, value)| *value = old[from]);
        }
        self.channels = channels;
    }
}

/// The layer of a channel: what precedes the last dot; colours have none.
fn layer_of(channel: &str) -> &str {
    match channel.rsplit_once('.') {
        Some((layer, _)) => layer,
        None if matches!(channel, "R" | "G" | "B") => "RGB",
        None => channel,
    }
}

#[pymethods]
impl Picture {
    /// A picture of an array.
    ///
    /// array: height × width × 3 real numbers, linear light.
    #[staticmethod]
    fn from_array(py: Python, array: &Bound<'_, PyAny>) -> PyResult<Self> {
        const WANTED: &str = "an array of height × width × 3 real numbers";
        let numpy = py.import("numpy")?;
        let array = numpy.call_method1("asarray", (array,))?;
        let untyped = array.cast::<PyUntypedArray>()?;
        let (shape, element) = (untyped.shape().to_vec(), untyped.dtype());
        let &[height, width, 3] = &shape[..] else {
            let problem = format!("`array` is {WANTED}, with three channels, not of the shape {shape:?}");
            return Err(PyValueError::new_err(problem));
        };
        if element.kind() != b'f' {
            let problem = format!("`array` is {WANTED} of linear light, not of {element}");
            return Err(PyTypeError::new_err(problem));
        }
        let values = numpy.call_method1("ascontiguousarray", (array, "float32"))?;
        let values = values.cast::<PyArrayDyn<f32>>()?.to_vec()?;
        let channels = ["R", "G", "B"].map(str::to_owned).to_vec();
        let shape = [height, width, 3];
        Self::new(py, Collected { shape, channels, values, metadata: ImageMetadata::default() })
    }

    /// Reads a picture from a file.
    ///
    /// path: a file of any format that alhazen knows, such as .exr, .png or .hdr.
    #[staticmethod]
    fn open(py: Python, path: PathBuf) -> PyResult<Self> {
        let collected = call(py, || Self::collect(&image::open(&path)?))?;
        Self::new(py, collected.map_err(|error| image_file_error(&path, error))?)
    }

    /// The number of columns.
    #[getter]
    fn width(&self, py: Python) -> usize {
        self.pixels.bind(py).shape()[1]
    }

    /// The number of rows.
    #[getter]
    fn height(&self, py: Python) -> usize {
        self.pixels.bind(py).shape()[0]
    }

    /// The shape of numpy.asarray(picture): height, width and 3.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.__array__(py, None, None)?.getattr("shape")
    }

    /// The names of all channels.
    #[getter]
    fn channels(&self) -> Vec<String> {
        self.channels.clone()
    }

    /// The names of the layers, in the order of their channels.
    #[getter]
    fn layers(&self) -> Vec<&str> {
        let mut layers: Vec<&str> = self.channels.iter().map(|channel| layer_of(channel)).collect();
        layers.dedup();
        layers
    }

    /// The pixels of all channels: height × width × number of channels.
    #[getter]
    fn pixels(&self, py: Python) -> Py<PyArray3<f32>> {
        self.pixels.clone_ref(py)
    }

    /// Facts about the picture, such as the integrator and the samples per pixel.
    #[getter]
    fn metadata<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let metadata = PyDict::new(py);
        for (name, attribute) in &self.metadata.attributes {
            match attribute {
                Attribute::Text(text) => metadata.set_item(name, text)?,
                Attribute::TextList(list) => metadata.set_item(name, list)?,
                Attribute::Integer(number) => metadata.set_item(name, number)?,
                Attribute::Float(number) => metadata.set_item(name, number)?,
                Attribute::Vector(vector) => metadata.set_item(name, vector)?,
                Attribute::Matrix(matrix) => {
                    metadata.set_item(name, matrix.transpose().to_cols_array_2d())?;
                }
            }
        }
        Ok(metadata)
    }

    #[pyo3(signature = (dtype=None, copy=None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let view = match self.find("RGB") {
            Some((first, count)) => self.view(py, first, count)?,
            None => self.pixels.bind(py).clone().into_any(),
        };
        let element = view.getattr("dtype")?;
        let is_same = dtype.as_ref().is_none_or(|dtype| element.eq(dtype).unwrap_or(false));
        match (dtype, copy) {
            (Some(_), Some(false)) if !is_same => {
                Err(PyValueError::new_err(format!("values are {element}, others need a copy")))
            }
            (Some(dtype), _) if !is_same => view.call_method1("astype", (dtype,)),
            (_, Some(true)) => view.call_method0("copy"),
            _ => Ok(view),
        }
    }

    fn __getitem__<'py>(&self, py: Python<'py>, key: Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        if let Ok(name) = key.extract::<String>() {
            if let Some(index) = self.channels.iter().position(|channel| *channel == name) {
                return self.view(py, index, 1);
            }
            let Some((first, count)) = self.find(&name).or_else(|| self.find_rendered(&name)) else {
                let known = self.layers().join(", ");
                return Err(PyKeyError::new_err(format!("there is no layer {name:?}; there are {known}")));
            };
            return self.view(py, first, count);
        }
        self.__array__(py, None, None)?.get_item(key)
    }

    fn __repr__(&self, py: Python) -> String {
        let layers = self.layers().join(", ");
        format!("<alhazen.Image {} × {}: {layers}>", self.width(py), self.height(py))
    }

    /// Writes the picture to a file in the format of its extension.
    ///
    /// path: the file. EXR files keep all channels and stay linear; other formats keep the colours,
    /// and warn where there are layers. Formats for displays, such as PNG, show them through a
    /// view.
    ///
    /// view: "standard" (sRGB), "agx", "aces", "khronos-neutral" or "filmic". exposure: in stops.
    /// white_balance: the colour temperature of the light that becomes white, in kelvin.
    #[pyo3(signature = (path, *, view="standard", exposure=0.0, white_balance=None))]
    fn write(
        &self,
        py: Python,
        path: PathBuf,
        view: &str,
        exposure: f32,
        white_balance: Option<f32>,
    ) -> PyResult<()> {
        let (image, display) = (self.image(py)?, display(view, exposure, white_balance)?);
        let written = call(py, || write_picture(&image, &path, &display))?;
        written.map_err(|error| image_file_error(&path, error))?;
        let mut layers = self.layers();
        layers.retain(|layer| !matches!(*layer, "RGB" | "A"));
        let keeps_layers = Format::from_name(&path.to_string_lossy()) == Some(Format::Exr);
        if layers.is_empty() || keeps_layers {
            return Ok(());
        }
        let text = format!(
            "{}: the layers {} are left out; .exr files keep them",
            path.display(),
            layers.join(", ")
        );
        let text = CString::new(text)?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)
    }

    /// The same as write().
    ///
    /// path, view, exposure, white_balance: as those of write().
    #[pyo3(signature = (path, *, view="standard", exposure=0.0, white_balance=None))]
    fn save(
        &self,
        py: Python,
        path: PathBuf,
        view: &str,
        exposure: f32,
        white_balance: Option<f32>,
    ) -> PyResult<()> {
        self.write(py, path, view, exposure, white_balance)
    }

    /// Shows the picture: below the cell of a notebook, else in the viewer of the system.
    ///
    /// view, exposure, white_balance: as those of write().
    #[pyo3(signature = (*, view="standard", exposure=0.0, white_balance=None))]
    fn show(&self, py: Python, view: &str, exposure: f32, white_balance: Option<f32>) -> PyResult<()> {
        let png = self.png(py, view, exposure, white_balance)?;
        py.import("alhazen.notebook")?.call_method1("show", (png,))?;
        Ok(())
    }

    /// The bytes of a PNG file that shows the picture through a view.
    ///
    /// view, exposure, white_balance: as those of write().
    #[pyo3(signature = (*, view="standard", exposure=0.0, white_balance=None))]
    fn png<'py>(
        &self,
        py: Python<'py>,
        view: &str,
        exposure: f32,
        white_balance: Option<f32>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let (image, display) = (self.image(py)?, display(view, exposure, white_balance)?);
        let shown = InSrgb::new(&image, Format::Png, &display);
        let bytes = call(py, || image::encode(&shown, Format::Png, &WriteOptions::default()))?;
        Ok(PyBytes::new(py, &bytes.map_err(image_error)?))
    }

    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.png(py, "standard", 0.0, None)
    }

    /// For pickle: an EXR file, which keeps all metadata, and the order of the channels.
    fn __reduce__<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let (make, image) = (slf.get_type().getattr("_from_file")?, slf.get().image(py)?);
        let options = WriteOptions { depth: SampleDepth::F32 };
        let bytes = call(py, || image::encode(&image, Format::Exr, &options))?.map_err(image_error)?;
        let arguments = (PyBytes::new(py, &bytes), slf.get().channels.clone());
        PyTuple::new(py, [make, arguments.into_pyobject(py)?.into_any()])
    }

    #[staticmethod]
    fn _from_file(py: Python, data: &[u8], channels: Vec<String>) -> PyResult<Self> {
        let read = || {
            let image = image::read(data, "", &ReadOptions::default())?;
            let mut collected = Self::collect(&image)?;
            collected.reorder(channels);
            Ok(collected)
        };
        Self::new(py, call(py, read)?.map_err(image_error)?)
    }
}

/// How a picture is shown.
fn display(view: &str, exposure: f32, white_balance: Option<f32>) -> PyResult<DisplaySettings> {
    let Some(view) = DisplayView::from_name(view) else {
        let known = DisplayView::ALL.map(DisplayView::name).join(", ");
        return Err(PyValueError::new_err(format!("there is no view {view:?}; there are {known}")));
    };
    let white = match white_balance {
        Some(kelvin) if !(500.0..=100_000.0).contains(&kelvin) => {
            return Err(PyValueError::new_err("white_balance is in kelvin, from 500 to 100000"));
        }
        other => other.map(DisplayWhite::Kelvin),
    };
    if !exposure.is_finite() {
        return Err(PyValueError::new_err("exposure is a finite number"));
    }
    Ok(DisplaySettings { view, exposure, white })
}
