//! The photometric scale of lights, as the format defines it.
//!
//! A spectrum is divided by its photometric integral, so that a scale of 1 means a luminance (for
//! points, a luminous intensity) of 1; `power` and `illuminance` then set the scale so that the
//! light has the stated total.

use super::Compiler;
use crate::light::{Emission, EmissionImage};
use crate::texture::{SpectrumType, compile_spectrum};
use description::{Handle, ImageDesc, Origin, Span, SpectrumDesc};
use image::{Image, Projection};
use math::Vec2;
use spectrum::RgbColorSpace;
use std::f32::consts::PI;
use std::sync::Arc;

impl Compiler<'_> {
    /// Reports invalid brightness factors by name.
    pub(super) fn check_brightness(&mut self, origin: &Origin, factors: &[(&str, Option<f32>)]) {
        for &(name, factor) in factors {
            let Some(factor) = factor else { continue };
            if !(factor.is_finite() && factor >= 0.0) {
                let message = format!("`{name}` of a light is {factor}; it must be finite and not negative");
                self.error("invalid-value", message, origin.parameter(name));
            } else if factor == 0.0 {
                let message = format!("`{name}` of a light is 0; it emits nothing");
                self.warn("black-light", message, origin.parameter(name));
            }
        }
    }

    /// A light's spectrum, scaled to one unit of luminance times `scale`.
    pub(super) fn emission(&mut self, spectrum: &SpectrumDesc, scale: f32, span: Span) -> Emission {
        let before = self.diagnostics.len();
        let (spectrum, photometric) = match &self.last_spectrum {
            Some((desc, last, photometric)) if desc == spectrum => (last.clone(), *photometric),
            _ => {
                let diagnostics = &mut self.diagnostics;
                let compiled = compile_spectrum(spectrum, SpectrumType::Illuminant, span, diagnostics);
                let (dense, photometric) = (compiled.to_dense(), compiled.to_photometric());
                if diagnostics.len() == before {
                    self.last_spectrum = Some((spectrum.clone(), dense.clone(), photometric));
                }
                (dense, photometric)
            }
        };
        // A spectrum with an error is replaced by a black one.
        if photometric == 0.0 && self.diagnostics.len() == before {
            self.warn("black-light", "the light is black; it emits nothing", span);
        }
        let scale = if photometric > 0.0 { scale / photometric } else { 0.0 };
        let emission = Emission { spectrum, scale };
        if !photometric.is_finite() || !emission.max_value().is_finite() {
            self.error("invalid-value", "the light's spectrum is too bright for single precision", span);
        }
        emission
    }

    /// A light's image, and the factor by which a pixel value of 1 becomes one unit of luminance
    /// times `scale`.
    pub(super) fn emission_image(
        &mut self,
        handle: Handle<ImageDesc>,
        scale: f32,
        span: Span,
    ) -> Option<(EmissionImage, f32)> {
        let image = self.finite_image(handle, span)?;
        if !image.is_color() {
            self.error("image-channels", "the image of a light needs red, green and blue", span);
            return None;
        }
        let color_space = image_color_space(&image);
        let photometric = color_space.illuminant().to_photometric();
        Some((EmissionImage::new(image, color_space), scale / photometric))
    }

    /// A light's image, whose values must be finite.
    pub(super) fn finite_image(&mut self, handle: Handle<ImageDesc>, span: Span) -> Option<Arc<Image>> {
        let image = self.desc.images[handle].image.clone();
        if image.values().any(|value| !value.is_finite()) {
            self.error("image-values", "the image of a light has infinite or NaN values", span);
            return None;
        }
        Some(image)
    }
}

/// The colour space of an image by its metadata; sRGB if they name none, or an unnamed one.
fn image_color_space(image: &Image) -> &'static RgbColorSpace {
    image
        .metadata
        .chromaticities
        .and_then(|c| RgbColorSpace::from_chromaticities([c.red, c.green, c.blue], c.white))
        .unwrap_or(RgbColorSpace::srgb())
}

/// Illuminance from a spherical image on a surface that faces +z. As in pbrt-v4, each pixel has
/// half of its solid angle: scenes of the format rely on that.
pub(super) fn upward_illuminance(image: &EmissionImage, projection: Projection) -> f32 {
    let (width, height) = (image.image.width(), image.image.height());
    let weights = image.color_space.luminance_weights();
    let mut sum = 0f64;
    for y in 0..height {
        let weight = projection.row_solid_angle(y, height);
        for x in 0..width {
            let uv = Vec2::new((x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32);
            let cos_theta = projection.direction(uv).z;
            if cos_theta > 0.0 {
                let [r, g, b] = image.image.rgb(x, y);
                let luminance = r * weights.r + g * weights.g + b * weights.b;
                sum += f64::from(luminance * cos_theta * weight);
            }
        }
    }
    sum as f32 * 2.0 * PI / (width as f32 * height as f32)
}
