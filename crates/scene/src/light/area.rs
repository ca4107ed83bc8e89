//! A surface that emits the same radiance in all directions: of one colour, or of an image over its
//! (u, v).
//!
//! Each triangle or patch of a mesh is a light of its own. Power: Φ = π·A·L, twice that when both
//! sides shine. Where the surface is cut out by an alpha texture, it does not emit; a surface with
//! the constant alpha 0 is an invisible light, which rays never meet but points still sample. Rays
//! leave evenly from its area (patches may follow an image) and by the cosine, to both sides alike
//! if it has two. Sources: [Pharr 2023 §12.4].

use super::{Emission, LightBounds, LightLeSample, LightLiSample, LightSampleContext};
use crate::texture::{FloatTextureId, TextureContext, Textures};
use geometry::{Shape, ShapeSample};
use image::{Image, WrapMode};
use math::{Frame, Normal3, Point2, Point3, Ray, Vec2, Vector3};
use sampling::{hash_float, warp};
use spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum};
use std::f32::consts::PI;
use std::sync::Arc;

/// What an emitting surface sends out; shared by the lights of a mesh.
#[derive(Clone, Debug)]
pub struct AreaEmission {
    /// Radiance; with an image only its scale counts.
    pub radiance: Emission,
    /// Colours over (u, v).
    pub image: Option<EmissionImage>,
    /// Shine on the side against the normal, too.
    pub two_sided: bool,
    /// Where the surface is there.
    pub alpha: Option<FloatTextureId>,
    /// Whether no ray ever meets the surface (its alpha is constantly 0).
    pub invisible: bool,
}

/// An image of emitted colours.
#[derive(Clone, Debug)]
pub struct EmissionImage {
    /// Pixels with red, green and blue; v = 0 is the bottom row.
    pub image: Arc<Image>,
    /// What the channels mean.
    pub color_space: &'static RgbColorSpace,
}

/// An emitting shape.
#[derive(Clone, Debug)]
pub struct AreaLight {
    shape: Shape,
    area: f32,
    emission: Arc<AreaEmission>,
}

impl EmissionImage {
    fn pixels(&self) -> impl Iterator<Item = Rgb> + '_ {
        let (width, height) = (self.image.width(), self.image.height());
        (0..width * height).map(move |i| Rgb::from(self.image.rgb(i % width, i / width)).clamp_zero())
    }

    /// Mean luminance in the image's colour space.
    pub fn mean_luminance(&self) -> f32 {
        let y = self.color_space.luminance_weights();
        let sum: f64 = self.pixels().map(|p| (p.r * y.r + p.g * y.g + p.b * y.b) as f64).sum();
        (sum / (self.image.width() * self.image.height()) as f64) as f32
    }
}

impl AreaLight {
    /// A light on `shape`.
    pub fn new(shape: Shape, emission: Arc<AreaEmission>) -> Self {
        let area = shape.area();
        Self { shape, area, emission }
    }

    pub(super) fn is_invisible(&self) -> bool {
        self.emission.invisible
    }

    pub(super) fn radiance(
        &self,
        n: Normal3,
        uv: Point2,
        w: Vector3,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let emission = &*self.emission;
        if !emission.two_sided && n.dot(w) < 0.0 {
            return SampledSpectrum::ZERO;
        }
        match &emission.image {
            None => emission.radiance.sample(lambda),
            Some(image) => {
                let st = Vec2::new(uv.x, 1.0 - uv.y);
                let rgb = Rgb::from(image.image.bilerp_rgb(st, WrapMode::Clamp)).clamp_zero();
                Spectrum::rgb_illuminant(image.color_space, rgb).sample(lambda) * emission.radiance.scale
            }
        }
    }

    pub(super) fn phi(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        let emission = &*self.emission;
        let radiance = match &emission.image {
            None => emission.radiance.sample(lambda),
            Some(image) => {
                let (mut sum, mut count) = (SampledSpectrum::ZERO, 0u32);
                for rgb in image.pixels() {
                    sum += Spectrum::rgb_illuminant(image.color_space, rgb).sample(lambda);
                    count += 1;
                }
                sum * (emission.radiance.scale / count.max(1) as f32)
            }
        };
        let sides = if emission.two_sided { 2.0 } else { 1.0 };
        radiance * (PI * sides * self.area)
    }

    pub(super) fn sample_li(
        &self,
        context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        textures: &Textures,
    ) -> Option<LightLiSample> {
        let s = self.shape.sample_from(context, u)?;
        let to_light = s.p.p - context.p.p;
        if s.pdf == 0.0 || to_light.length_squared() == 0.0 {
            return None;
        }
        if !self.is_there(&s, textures) {
            return None;
        }
        let wi = to_light.normalize();
        let l = self.radiance(s.n, s.uv, -wi, lambda);
        (!l.is_black()).then_some(LightLiSample { l, wi, pdf: s.pdf, p: Some(s.p), n: s.n })
    }

    /// Whether a point of the surface is there, decided by a hash where its alpha makes it come and
    /// go.
    fn is_there(&self, s: &ShapeSample, textures: &Textures) -> bool {
        let Some(alpha) = self.emission.alpha.filter(|_| !self.emission.invisible) else { return true };
        let there =
            textures.float(alpha, &TextureContext { p: s.p.p, n: s.n, uv: s.uv, ..Default::default() });
        there >= 1.0 || hash_float(&s.p.p.to_array().map(f32::to_bits)) < there
    }

    /// By area, and by the cosine on the sides that shine.
    pub(super) fn sample_le(
        &self,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
        textures: &Textures,
    ) -> Option<LightLeSample> {
        let s = self.shape.sample(u_position)?;
        if !self.is_there(&s, textures) {
            return None;
        }
        let mut u = u_direction;
        let mut side = s.n;
        if self.emission.two_sided {
            u.x *= 2.0;
            if u.x >= 1.0 {
                u.x -= 1.0;
                side = -s.n;
            }
        }
        let w = Frame::from_z(side).from_local(warp::sample_cosine_hemisphere(u));
        let (l, pdf_direction) = (self.radiance(s.n, s.uv, w, lambda), self.pdf_direction(s.n, w));
        (pdf_direction > 0.0 && !l.is_black()).then(|| LightLeSample {
            l,
            ray: Ray::spawn(s.p, s.n, w, time),
            p: Some(s.p),
            n: s.n,
            pdf_position: s.pdf,
            pdf_direction,
        })
    }

    pub(super) fn pdf_le(&self, p: Point3, n: Normal3, w: Vector3) -> (f32, f32) {
        let position = self.shape.pdf_area(p, n);
        (if position.is_finite() { position } else { 0.0 }, self.pdf_direction(n, w))
    }

    fn pdf_direction(&self, n: Normal3, w: Vector3) -> f32 {
        let cos_theta = n.dot(w);
        if self.emission.two_sided {
            0.5 * warp::cosine_hemisphere_pdf(cos_theta.abs())
        } else {
            warp::cosine_hemisphere_pdf(cos_theta.max(0.0))
        }
    }

    pub(super) fn pdf_li(&self, context: &LightSampleContext, wi: Vector3) -> f32 {
        self.shape.pdf_from(context, wi)
    }

    pub(super) fn bounds(&self) -> Option<LightBounds> {
        let emission = &*self.emission;
        let peak = match &emission.image {
            None => emission.radiance.max_value(),
            Some(image) => {
                let (sum, count) = image
                    .pixels()
                    .fold((0f64, 0u32), |(s, n), p| (s + ((p.r + p.g + p.b) / 3.0) as f64, n + 1));
                (sum / count.max(1) as f64) as f32 * emission.radiance.scale
            }
        };
        let normals = self.shape.normal_bounds();
        Some(LightBounds {
            bounds: self.shape.bounds()?,
            w: normals.w,
            phi: peak * self.area * PI,
            cos_theta_o: normals.cos_theta,
            cos_theta_e: 0.0,
            two_sided: emission.two_sided,
        })
    }
}
