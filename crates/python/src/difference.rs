//! How far a picture is from a reference.

use alhazen::image::metrics;
use pyo3::prelude::*;

use crate::calls::call;
use crate::errors::image_error;
use crate::picture::Picture;

/// How far a picture is from a reference, over all pixels and colours.
#[pyclass(frozen, get_all, module = "alhazen")]
pub struct Difference {
    /// Mean squared error.
    mse: f64,
    /// Mean of squared errors over the reference squared plus 0.01.
    rel_mse: f64,
    /// Peak signal-to-noise ratio in decibels, for a peak of 1.
    psnr: f64,
    /// The largest absolute error.
    max_error: f64,
    /// The number of values that are not finite, which are left out.
    non_finite: usize,
    /// Means of the reference's colours.
    reference_mean: (f64, f64, f64),
    /// Means of the picture's colours.
    mean: (f64, f64, f64),
}

#[pymethods]
impl Difference {
    fn __repr__(&self) -> String {
        format!("<alhazen.Difference relMSE {:.3e}, PSNR {:.1} dB>", self.rel_mse, self.psnr)
    }
}

/// Compares two pictures of the same size.
///
/// reference: what is right. image: what is compared with it.
#[pyfunction]
pub fn compare(py: Python, reference: &Picture, image: &Picture) -> PyResult<Difference> {
    let (reference, test) = (reference.image(py)?, image.image(py)?);
    let found = call(py, || metrics::compare(&reference, &test))?.map_err(image_error)?;
    Ok(Difference {
        mse: found.mse,
        rel_mse: found.rel_mse,
        psnr: found.psnr(),
        max_error: found.max_error,
        non_finite: found.non_finite,
        reference_mean: found.reference_mean.into(),
        mean: found.test_mean.into(),
    })
}
