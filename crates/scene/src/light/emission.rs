//! Emission of lights: a spectrum and its scale; on surfaces, also an image.

use crate::texture::UvLookup;
use image::Image;
use lanes::Real;
use math::{Normal3, Vector3};
use sampling::warp;
use spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum};
use std::f32::consts::PI;
use std::sync::Arc;

/// The emission of a light: `scale · spectrum(λ)`.
#[derive(Clone, Debug)]
pub struct Emission {
    /// Shape of the spectrum.
    pub spectrum: Spectrum,
    /// Factor.
    pub scale: f32,
}

impl Emission {
    /// Values at the wavelengths.
    #[inline(always)]
    pub fn sample<R: Real>(&self, lambda: &SampledWavelengths<R>) -> SampledSpectrum<R> {
        self.spectrum.sample(lambda) * R::splat(self.scale)
    }

    /// The largest value over all wavelengths.
    pub fn max_value(&self) -> f32 {
        self.spectrum.max_value() * self.scale
    }
}

/// The emission of surfaces, shared by all lights with the same description.
#[derive(Clone, Debug)]
pub struct AreaEmission {
    /// Radiance; with an image, only its scale is used.
    pub radiance: Emission,
    /// Colours over (u, v).
    pub image: Option<(EmissionImage, UvLookup)>,
    /// Whether the side opposite to the normal emits, too.
    pub two_sided: bool,
}

/// An image of emitted colours.
#[derive(Clone, Debug)]
pub struct EmissionImage {
    /// Pixels with red, green and blue; v = 0 is the bottom row.
    pub image: Arc<Image>,
    /// The colour space of the pixels.
    pub color_space: &'static RgbColorSpace,
    /// The mean luminance, and the mean of the components.
    means: [f32; 2],
}

impl EmissionImage {
    /// An image whose pixels have red, green and blue.
    pub fn new(image: Arc<Image>, color_space: &'static RgbColorSpace) -> Self {
        let mut image = Self { image, color_space, means: [0.0; 2] };
        let mut sums = [0f64; 2];
        for p in image.pixels() {
            sums[0] += f64::from(image.luminance(p));
            sums[1] += f64::from((p.r + p.g + p.b) / 3.0);
        }
        let count = f64::from(image.image.width() * image.image.height());
        image.means = sums.map(|sum| (sum / count) as f32);
        image
    }

    /// The mean of the components of all pixels.
    pub(super) fn mean(&self) -> f32 {
        self.means[1]
    }

    /// Its colours, with negative components set to zero.
    pub(super) fn pixels(&self) -> impl Iterator<Item = Rgb> + '_ {
        let (width, height) = (self.image.width(), self.image.height());
        (0..width * height).map(move |i| Rgb::from(self.image.rgb(i % width, i / width)).clamp_zero())
    }

    /// The spectrum of a colour, its negative components set to zero, at the wavelengths.
    pub(super) fn sample(&self, rgb: Rgb, lambda: &SampledWavelengths) -> SampledSpectrum {
        Spectrum::rgb_illuminant(self.color_space, rgb.clamp_zero()).sample(lambda)
    }

    /// The luminance of a colour.
    pub fn luminance(&self, p: Rgb) -> f32 {
        let y = self.color_space.luminance_weights();
        p.r * y.r + p.g * y.g + p.b * y.b
    }

    /// Mean luminance in the image's colour space.
    pub fn mean_luminance(&self) -> f32 {
        self.means[0]
    }
}

impl AreaEmission {
    /// Emission of zero.
    pub fn black() -> Self {
        let radiance = Emission { spectrum: Spectrum::Constant(0.0), scale: 0.0 };
        Self { radiance, image: None, two_sided: false }
    }

    /// The scale with which a primitive of `area` emits `power`; 0 where it cannot emit.
    pub fn scale_for_power(&self, power: f32, area: f32) -> f32 {
        let sides = if self.two_sided { 2.0 } else { 1.0 };
        let mean = self.image.as_ref().map_or(1.0, |(image, _)| image.mean_luminance());
        let unscaled = mean * sides * area * PI;
        self.radiance.scale * if unscaled > 0.0 { power / unscaled } else { 0.0 }
    }

    /// Density per solid angle of emission along `w` where the normal is `n`.
    pub(super) fn pdf_direction(&self, n: Normal3, w: Vector3) -> f32 {
        let cos_theta = n.dot(w);
        if self.two_sided {
            0.5 * warp::cosine_hemisphere_pdf(cos_theta.abs())
        } else {
            warp::cosine_hemisphere_pdf(cos_theta.max(0.0))
        }
    }
}
