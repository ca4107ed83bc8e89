//! Light over wavelength: spectra, sampled wavelengths, colour spaces, RGB uplifting
