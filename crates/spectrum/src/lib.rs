//! Light over wavelength: spectra, sampled wavelengths, colour spaces, RGB uplifting

pub mod sampled;

pub use sampled::{LAMBDA_MAX, LAMBDA_MIN, N, SampledSpectrum, SampledWavelengths};
