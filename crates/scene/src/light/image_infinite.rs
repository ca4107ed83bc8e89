//! A sky given by an image in the equal-area octahedral mapping, sampled in proportion to its
//! brightness.
//!
//! Because the mapping keeps areas, the density per solid angle is that of the square over 4π. With
//! incomplete sampling allowed, the *compensated* distribution max(0, f − mean) is used: multiple
//! importance sampling leaves the dim parts to the BSDF, and light samples go where they matter
//! ([Karlík et al. 2019]; [Pharr 2023 §12.5.2]). Rays of light come by the plain distribution, and
//! start evenly on the disk that faces them and covers the scene.

use super::{LightLeSample, LightLiSample, LightModel, LightPart, LightSampleContext, SceneSphere};
use image::{Image, WrapMode};
use math::{
    Bounds2, Point2, Ray, Transform, Vec3, Vector3, equal_area_sphere_to_square, equal_area_square_to_sphere,
};
use sampling::PiecewiseConstant2d;
use spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum};
use std::f32::consts::PI;
use std::sync::Arc;

/// An environment image.
#[derive(Clone, Debug)]
pub struct ImageInfiniteLight {
    render_from_light: Transform,
    image: Arc<Image>,
    color_space: &'static RgbColorSpace,
    scale: f32,
    scene: SceneSphere,
    distribution: PiecewiseConstant2d,
    compensated: PiecewiseConstant2d,
}

impl ImageInfiniteLight {
    /// From a square image with red, green and blue in `color_space`.
    pub fn new(
        render_from_light: Transform,
        image: Arc<Image>,
        color_space: &'static RgbColorSpace,
        scale: f32,
        scene: SceneSphere,
    ) -> Self {
        let (width, height) = (image.width(), image.height());
        let mut density = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                density.push(Rgb::from(image.rgb(x, y)).clamp_zero().average());
            }
        }
        let distribution = PiecewiseConstant2d::new(&density, width as usize, Bounds2::UNIT);
        let mean = (density.iter().map(|&d| d as f64).sum::<f64>() / density.len().max(1) as f64) as f32;
        density.iter_mut().for_each(|d| *d = (*d - mean).max(0.0));
        if density.iter().all(|&d| d == 0.0) {
            density.fill(1.0);
        }
        let compensated = PiecewiseConstant2d::new(&density, width as usize, Bounds2::UNIT);
        Self { render_from_light, image, color_space, scale, scene, distribution, compensated }
    }

    fn distribution(&self, allow_incomplete: bool) -> &PiecewiseConstant2d {
        if allow_incomplete { &self.compensated } else { &self.distribution }
    }

    fn spectrum(&self, rgb: Rgb, lambda: &SampledWavelengths) -> SampledSpectrum {
        Spectrum::rgb_illuminant(self.color_space, rgb).sample(lambda) * self.scale
    }

    fn lookup(&self, uv: Point2, lambda: &SampledWavelengths) -> SampledSpectrum {
        let pixel = |x: f32, resolution: u32| (x * resolution as f32) as i32;
        let (x, y) = (pixel(uv.x, self.image.width()), pixel(uv.y, self.image.height()));
        self.spectrum(
            Rgb::from(self.image.rgb_wrapped(x, y, WrapMode::OctahedralSphere)).clamp_zero(),
            lambda,
        )
    }

    fn sample(
        &self,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        let (uv, density, _) = self.distribution(allow_incomplete).sample(u);
        if density == 0.0 {
            return None;
        }
        let wi = self.render_from_light.vector(equal_area_square_to_sphere(uv)).normalize();
        Some(LightLiSample {
            l: self.lookup(uv, lambda),
            wi,
            pdf: density / (4.0 * PI),
            p: None,
            n: Vec3::ZERO,
        })
    }

    fn pdf(&self, wi: Vector3, allow_incomplete: bool) -> f32 {
        let w = self.render_from_light.inverse().vector(wi).normalize();
        self.distribution(allow_incomplete).pdf(equal_area_sphere_to_square(w)) / (4.0 * PI)
    }
}

impl LightModel for ImageInfiniteLight {
    fn is_delta(&self) -> bool {
        false
    }

    fn is_infinite(&self) -> bool {
        true
    }

    fn phi(&self, _part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        let mut sum = SampledSpectrum::ZERO;
        let (width, height) = (self.image.width(), self.image.height());
        for y in 0..height {
            for x in 0..width {
                sum += self.spectrum(Rgb::from(self.image.rgb(x, y)).clamp_zero(), lambda);
            }
        }
        sum * (4.0 * PI * PI * self.scene.radius * self.scene.radius / (width * height) as f32)
    }

    fn le(&self, ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        let w = self.render_from_light.inverse().vector(ray.d).normalize();
        self.lookup(equal_area_sphere_to_square(w), lambda)
    }

    fn sample_li(
        &self,
        _part: &LightPart,
        _context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        self.sample(u, lambda, allow_incomplete)
    }

    fn sample_le(
        &self,
        _part: &LightPart,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        let LightLiSample { l, wi, pdf, n, .. } = self.sample(u_direction, lambda, false)?;
        Some(LightLeSample {
            l,
            ray: self.scene.ray_from(wi, u_position, time),
            p: None,
            n,
            pdf_position: self.scene.disk_pdf(),
            pdf_direction: pdf,
        })
    }

    fn pdf_li(
        &self,
        _part: &LightPart,
        _context: &LightSampleContext,
        wi: Vector3,
        allow_incomplete: bool,
    ) -> f32 {
        self.pdf(wi, allow_incomplete)
    }

    fn pdf_le_infinite(&self, ray: &Ray) -> (f32, f32) {
        (self.scene.pdf_facing_disk(ray), self.pdf(ray.d, false))
    }
}
