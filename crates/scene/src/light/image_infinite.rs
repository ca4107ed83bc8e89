//! Radiance from infinity given by an image of the sphere, importance-sampled by its brightness.
//!
//! The image is in the equal-area or the latitude–longitude [`Projection`]. With p(s, t) the
//! density over the unit square and 4π·j(s, t) the solid angle per area, the density per solid
//! angle is p/(4π·j): j = 1 for equal areas and (π/2)·sin θ for latitude and longitude, whose
//! pixels are sampled in proportion to brightness · sin θ.
//!
//! With incomplete sampling allowed, the *compensated* distribution max(0, f − mean) is used:
//! multiple importance sampling leaves the dim parts to BSDF sampling, and light samples go to the
//! bright parts ([Karlík et al. 2019]; [Pharr 2023 §12.5.2]). Emitted rays are chosen by the plain
//! distribution, and start uniformly on the disk that is perpendicular to them and covers the
//! scene.
//!
//! Directions to a moving environment are transformed at the shutter time.

use super::{LightLeSample, LightLiSample, LightModel, LightPart, LightSampleContext, SceneSphere};
use image::{Image, Projection};
use math::{AnimatedTransform, Bounds2, Point2, Ray, Vec3, Vector3};
use sampling::PiecewiseConstant2d;
use spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum};
use std::f32::consts::PI;
use std::sync::Arc;

/// An environment image.
#[derive(Clone, Debug)]
pub struct ImageInfiniteLight {
    /// From the space of the projection to render space.
    pub render_from_light: AnimatedTransform,
    /// Pixels with red, green and blue; negative values count as zero.
    pub image: Arc<Image>,
    /// The mapping from pixels to directions.
    pub projection: Projection,
    /// The colour space of the pixels.
    pub color_space: &'static RgbColorSpace,
    /// Factor on the radiance of the image.
    pub scale: f32,
    /// The bounding sphere of the scene.
    pub scene: SceneSphere,
    distribution: PiecewiseConstant2d,
    compensated: PiecewiseConstant2d,
}

impl ImageInfiniteLight {
    /// Bytes per pixel that [`Self::new`] allocates: the density, and two distributions of values,
    /// cumulative values and guides.
    pub const BYTES_PER_PIXEL: usize = 28;

    /// From an image of the sphere in `projection`, with red, green and blue in `color_space`.
    pub fn new(
        render_from_light: AnimatedTransform,
        (image, projection): (Arc<Image>, Projection),
        color_space: &'static RgbColorSpace,
        scale: f32,
        scene: SceneSphere,
    ) -> Self {
        let (width, height) = (image.width(), image.height());
        let mut density = Vec::with_capacity(width as usize * height as usize);
        let (mut sum, mut weights) = (0.0, 0.0);
        for y in 0..height {
            let weight = projection.row_solid_angle(y, height);
            for x in 0..width {
                let value = Rgb::from(image.rgb(x, y)).clamp_zero().average() * weight;
                sum += f64::from(value);
                weights += f64::from(weight);
                density.push(value);
            }
        }
        let distribution = PiecewiseConstant2d::new(&density, width as usize, Bounds2::UNIT);
        let mean = (sum / weights) as f32;
        let rows = || (0..height).map(|y| projection.row_solid_angle(y, height));
        for (row, weight) in density.chunks_exact_mut(width as usize).zip(rows()) {
            row.iter_mut().for_each(|d| *d = (*d - mean * weight).max(0.0));
        }
        if density.iter().all(|&d| d == 0.0) {
            for (row, weight) in density.chunks_exact_mut(width as usize).zip(rows()) {
                row.fill(weight);
            }
        }
        let compensated = PiecewiseConstant2d::new(&density, width as usize, Bounds2::UNIT);
        Self { render_from_light, image, projection, color_space, scale, scene, distribution, compensated }
    }

    fn distribution(&self, allow_incomplete: bool) -> &PiecewiseConstant2d {
        if allow_incomplete { &self.compensated } else { &self.distribution }
    }

    fn spectrum(&self, rgb: Rgb, lambda: &SampledWavelengths) -> SampledSpectrum {
        Spectrum::rgb_illuminant(self.color_space, rgb).sample(lambda) * self.scale
    }

    fn lookup(&self, st: Point2, lambda: &SampledWavelengths) -> SampledSpectrum {
        let pixel = |x: f32, resolution: u32| (x * resolution as f32) as i32;
        let (x, y) = (pixel(st.x, self.image.width()), pixel(st.y, self.image.height()));
        let rgb = Rgb::from(self.image.rgb_wrapped(x, y, self.projection.wrap()));
        self.spectrum(rgb.clamp_zero(), lambda)
    }

    /// The position in the image of a direction in render space at a shutter time.
    fn position(&self, w: Vector3, time: f32) -> Point2 {
        self.projection.position(self.render_from_light.at(time).inverse().vector(w).normalize())
    }

    fn sample(
        &self,
        u: Point2,
        time: f32,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        let (st, density, _) = self.distribution(allow_incomplete).sample(u);
        let solid_angle = 4.0 * PI * self.projection.solid_angle_density(st);
        if density == 0.0 || solid_angle == 0.0 {
            return None;
        }
        let wi = self.render_from_light.at(time).vector(self.projection.direction(st)).normalize();
        Some(LightLiSample {
            l: self.lookup(st, lambda),
            wi,
            pdf: density / solid_angle,
            p: None,
            n: Vec3::ZERO,
        })
    }

    fn pdf(&self, wi: Vector3, time: f32, allow_incomplete: bool) -> f32 {
        let st = self.position(wi, time);
        let solid_angle = 4.0 * PI * self.projection.solid_angle_density(st);
        if solid_angle == 0.0 { 0.0 } else { self.distribution(allow_incomplete).pdf(st) / solid_angle }
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
            let weight = self.projection.row_solid_angle(y, height);
            for x in 0..width {
                sum += self.spectrum(Rgb::from(self.image.rgb(x, y)).clamp_zero(), lambda) * weight;
            }
        }
        sum * (4.0 * PI * PI * self.scene.radius * self.scene.radius / (width * height) as f32)
    }

    fn le(&self, ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.lookup(self.position(ray.d, ray.time), lambda)
    }

    fn sample_li(
        &self,
        _part: &LightPart,
        context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        self.sample(u, context.time, lambda, allow_incomplete)
    }

    fn sample_le(
        &self,
        _part: &LightPart,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        let LightLiSample { l, wi, pdf, n, .. } = self.sample(u_direction, time, lambda, false)?;
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
        context: &LightSampleContext,
        wi: Vector3,
        allow_incomplete: bool,
    ) -> f32 {
        self.pdf(wi, context.time, allow_incomplete)
    }

    fn pdf_le_infinite(&self, ray: &Ray) -> (f32, f32) {
        (self.scene.pdf_facing_disk(ray), self.pdf(ray.d, ray.time, false))
    }
}
