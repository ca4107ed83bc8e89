//! Spectra, sampled wavelengths, colour spaces, RGB uplifting, measured data.
//!
//! Wavelengths are in nanometres, from [`LAMBDA_MIN`] to [`LAMBDA_MAX`]. A path carries [`N`] of
//! them ([`SampledWavelengths`]) and its quantities are [`SampledSpectrum`]s at them; a scene's
//! quantities are functions of wavelength, [`Spectrum`]s. Lights are scaled so that a colour
//! space's illuminant has luminance 1.

pub mod blackbody;
pub mod cie;
pub mod color_space;
pub mod daylight;
pub mod dense;
pub mod matrix;
mod measured;
pub mod piecewise;
pub mod rgb;
pub mod rgb_spectrum;
pub mod sampled;
pub mod spectrum;
pub mod uplift;
pub mod wavelengths;

pub use blackbody::{Blackbody, blackbody};
pub use cie::{CIE_Y_INTEGRAL, responses, tristimulus, xyz_from, y_from};
pub use color_space::{RgbColorSpace, white_balance};
pub use daylight::daylight;
pub use dense::DenselySampled;
pub use matrix::Matrix3;
pub use measured::{color_checker, names};
pub use piecewise::{ParseError, PiecewiseLinear, SpectrumError};
pub use rgb::{Rgb, Xyz};
pub use rgb_spectrum::{RgbAlbedoSpectrum, RgbIlluminantSpectrum, RgbUnboundedSpectrum};
pub use sampled::{N, SampledSpectrum};
pub use spectrum::{Spectrum, named};
pub use uplift::RgbSigmoidPolynomial;
pub use wavelengths::{LAMBDA_MAX, LAMBDA_MIN, SampledWavelengths};
