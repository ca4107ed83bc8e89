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
//! A transform M other than a similarity stretches solid angles: a density around the direction ω
//! of render space has the factor |det M⁻¹|/|M⁻¹ω|³, and the weight of a pixel, its solid angle,
//! the reciprocal of that.
//!
//! Directions to a moving environment are transformed at the shutter time; its pixels have their
//! weights at the start of motion.

use super::emitter::{is_similarity, solid_angle_factor};
use super::{
    LightLeSample, LightLiSample, LightModel, LightPart, LightPoint, LightSampleContext, SceneSphere,
};
use crate::texture::SpectrumType;
use image::{Image, Projection};
use lanes::{Each, Real};
use math::{AnimatedTransform, Bounds2, Point2, Ray, Transform, Vec2, Vec3, Vector3};
use sampling::PiecewiseConstant2d;
use spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths};
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
    /// Whether the transform is ever other than a similarity.
    is_stretched: bool,
    distribution: PiecewiseConstant2d,
    compensated: PiecewiseConstant2d,
}

/// Solid angles of an image's pixels in render space, as parts of that of all in equal areas.
struct PixelWeights<'a> {
    image: &'a Image,
    projection: Projection,
    /// The transform from the projection to render space, where it is no similarity.
    stretch: Option<&'a Transform>,
}

impl PixelWeights<'_> {
    /// Rows or columns of an image within which a stretch changes little.
    const FINE: u32 = 256;

    fn at(&self, x: u32, y: u32) -> f32 {
        let [width, height] = [self.image.width(), self.image.height()];
        let Some(render_from_light) = self.stretch else {
            return self.projection.row_solid_angle(y, height);
        };
        // The mean of the strata of a pixel.
        let strata = Self::FINE.div_ceil(width.min(height));
        let [columns, rows] = [width, height].map(|size| size * strata);
        let mut sum = 0.0;
        for j in y * strata..(y + 1) * strata {
            let solid_angle = self.projection.row_solid_angle(j, rows);
            for i in x * strata..(x + 1) * strata {
                let st = Vec2::new((i as f32 + 0.5) / columns as f32, (j as f32 + 0.5) / rows as f32);
                let w = render_from_light.vector(self.projection.direction(st)).normalize();
                sum += solid_angle / solid_angle_factor(&render_from_light.inverse(), w);
            }
        }
        sum / (strata * strata) as f32
    }
}

impl ImageInfiniteLight {
    /// Bytes per pixel that [`Self::new`] allocates: the density, and two distributions of values,
    /// cumulative values and guides.
    pub const BYTES_PER_PIXEL: usize = 28;

    /// From an image of the sphere in `projection`, with red, green and blue in `color_space`.
    pub fn new(
        render_from_light: AnimatedTransform,
        image: Arc<Image>,
        projection: Projection,
        color_space: &'static RgbColorSpace,
        scale: f32,
        scene: SceneSphere,
    ) -> Self {
        let is_stretched = [f32::MIN, f32::MAX].iter().any(|&t| !is_similarity(&render_from_light.at(t)));
        let stretch = is_stretched.then(|| render_from_light.start());
        let pixel_weights = PixelWeights { image: &image, projection, stretch };
        let (width, height) = (image.width(), image.height());
        let pixels = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let mut density = Vec::with_capacity(width as usize * height as usize);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (x, y) in pixels() {
            let weight = pixel_weights.at(x, y);
            let value = Rgb::from(image.rgb(x, y)).clamp_zero().average() * weight;
            sum += f64::from(value);
            weights += f64::from(weight);
            density.push(value);
        }
        let distribution = PiecewiseConstant2d::new(&density, width as usize, Bounds2::UNIT);
        let mean = (sum / weights) as f32;
        for (d, (x, y)) in density.iter_mut().zip(pixels()) {
            *d = (*d - mean * pixel_weights.at(x, y)).max(0.0);
        }
        if density.iter().all(|&d| d == 0.0) {
            density = pixels().map(|(x, y)| pixel_weights.at(x, y)).collect();
        }
        let compensated = PiecewiseConstant2d::new(&density, width as usize, Bounds2::UNIT);
        Self {
            render_from_light,
            image,
            projection,
            color_space,
            scale,
            scene,
            is_stretched,
            distribution,
            compensated,
        }
    }

    /// The distribution over positions in the image by which directions are sampled; with
    /// `allow_incomplete`, the compensated one.
    pub fn distribution(&self, allow_incomplete: bool) -> &PiecewiseConstant2d {
        if allow_incomplete { &self.compensated } else { &self.distribution }
    }

    /// Whether it is computed in lanes: its transform does not change with time.
    #[inline]
    pub fn is_at_rest(&self) -> bool {
        !self.render_from_light.is_moving()
    }

    /// The radiance of light at rest along directions in render space.
    #[inline(always)]
    pub fn le_at_rest<R: Real>(&self, w: Vector3<R>, lambda: &SampledWavelengths<R>) -> SampledSpectrum<R> {
        self.lookup(self.position(w, self.render_from_light.start()), lambda)
    }

    /// Directions to light at rest, chosen by `u`: where there is one, radiance, direction and
    /// density per solid angle.
    #[inline(always)]
    pub fn sample_at_rest<R: Real>(
        &self,
        u: Point2<R>,
        lambda: &SampledWavelengths<R>,
        allow_incomplete: bool,
    ) -> (SampledSpectrum<R>, Vector3<R>, R, R::Mask) {
        self.sample(u, self.render_from_light.start(), lambda, allow_incomplete)
    }

    /// The density per solid angle of [`sample_at_rest`](Self::sample_at_rest).
    #[inline(always)]
    pub fn pdf_at_rest<R: Real>(&self, wi: Vector3<R>, allow_incomplete: bool) -> R {
        self.pdf(wi, self.render_from_light.start(), allow_incomplete)
    }

    #[inline(always)]
    fn spectrum<R: Real>(&self, rgb: [R; 3], lambda: &SampledWavelengths<R>) -> SampledSpectrum<R> {
        let rgb = rgb.each(|v| v.max(R::zero()));
        SpectrumType::Illuminant.sample_rgb(self.color_space, rgb, lambda) * R::splat(self.scale)
    }

    #[inline(always)]
    fn lookup<R: Real>(&self, st: Point2<R>, lambda: &SampledWavelengths<R>) -> SampledSpectrum<R> {
        let size = Vec2::new(self.image.width() as f32, self.image.height() as f32).map(R::splat);
        let pixel = (st * size).max(Vec2::splat(R::zero())).min(size);
        let pixel = pixel.to_array().each(R::to_int);
        self.spectrum(self.image.colors(pixel, self.projection.wrap()), lambda)
    }

    /// The position in the image of a direction in render space.
    #[inline(always)]
    fn position<R: Real>(&self, w: Vector3<R>, render_from_light: &Transform) -> Point2<R> {
        self.projection.position(render_from_light.inverse().vector_lanes(w).normalize())
    }

    #[inline(always)]
    fn sample<R: Real>(
        &self,
        u: Point2<R>,
        render_from_light: &Transform,
        lambda: &SampledWavelengths<R>,
        allow_incomplete: bool,
    ) -> (SampledSpectrum<R>, Vector3<R>, R, R::Mask) {
        let (st, density, _) = self.distribution(allow_incomplete).sample(u);
        let solid_angle = R::splat(4.0 * PI) * self.projection.solid_angle_density(st);
        let is_chosen = !(density.eq(R::zero()) | solid_angle.eq(R::zero()));
        let wi = render_from_light.vector_lanes(self.projection.direction(st)).normalize();
        let pdf = self.stretched(density / solid_angle, wi, render_from_light);
        (self.lookup(st, lambda), wi, pdf, is_chosen)
    }

    /// A density per solid angle of the projection as one around the direction `w` of render space.
    #[inline(always)]
    fn stretched<R: Real>(&self, pdf: R, w: Vector3<R>, render_from_light: &Transform) -> R {
        if !self.is_stretched {
            return pdf;
        }
        pdf * solid_angle_factor(&render_from_light.inverse(), w)
    }

    fn sample_one(
        &self,
        u: Point2,
        time: f32,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        let (l, wi, pdf, is_chosen) =
            self.sample(u, &self.render_from_light.at(time), lambda, allow_incomplete);
        is_chosen.then_some(LightLiSample { l, wi, pdf, p: None, n: Vec3::ZERO })
    }

    #[inline(always)]
    fn pdf<R: Real>(&self, wi: Vector3<R>, render_from_light: &Transform, allow_incomplete: bool) -> R {
        let st = self.position(wi, render_from_light);
        let solid_angle = R::splat(4.0 * PI) * self.projection.solid_angle_density(st);
        let pdf = self.distribution(allow_incomplete).pdf(st) / solid_angle;
        R::select(solid_angle.eq(R::zero()), R::zero(), self.stretched(pdf, wi, render_from_light))
    }

    fn pdf_one(&self, wi: Vector3, time: f32, allow_incomplete: bool) -> f32 {
        self.pdf(wi, &self.render_from_light.at(time), allow_incomplete)
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
        let stretch = self.is_stretched.then(|| self.render_from_light.start());
        let weights = PixelWeights { image: &self.image, projection: self.projection, stretch };
        for y in 0..height {
            for x in 0..width {
                sum += self.spectrum(self.image.rgb(x, y), lambda) * weights.at(x, y);
            }
        }
        sum * (4.0 * PI * PI * self.scene.radius * self.scene.radius / (width * height) as f32)
    }

    fn le(&self, ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.lookup(self.position(ray.d, &self.render_from_light.at(ray.time)), lambda)
    }

    fn sample_li(
        &self,
        _part: &LightPart,
        context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        self.sample_one(u, context.time, lambda, allow_incomplete)
    }

    fn sample_le(
        &self,
        _part: &LightPart,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        let LightLiSample { l, wi, pdf, n, .. } = self.sample_one(u_direction, time, lambda, false)?;
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
        _point: LightPoint,
        allow_incomplete: bool,
    ) -> f32 {
        self.pdf_one(wi, context.time, allow_incomplete)
    }

    fn pdf_le_infinite(&self, ray: &Ray) -> (f32, f32) {
        (self.scene.pdf_facing_disk(ray), self.pdf_one(ray.d, ray.time, false))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::DMat4;
    use testkit::{LaneFunction, lanes_agree};

    struct Sky(ImageInfiniteLight);

    impl LaneFunction for Sky {
        #[inline(always)]
        fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
            let lambda = SampledWavelengths::sample_visible(u[2]);
            let (l, wi, pdf, is_chosen) = self.0.sample_at_rest(Point2::new(u[0], u[1]), &lambda, true);
            let valid = |x| R::select(is_chosen, x, R::zero());
            let mut results: Vec<R> = l.0.into_iter().chain(wi.to_array()).chain([pdf]).map(valid).collect();
            let w = Vec3::new(u[0] - R::splat(0.5), u[1] - R::splat(0.5), u[2] - R::splat(0.5));
            results.extend([self.0.pdf_at_rest(w, true), self.0.pdf_at_rest(w, false)]);
            results.extend(self.0.le_at_rest(w, &lambda).0);
            results
        }
    }

    #[test]
    fn lanes_have_the_light_of_single_rays() {
        for (width, height) in [(8, 8), (16, 8)] {
            let image = Image::from_fn(width, height, ["R", "G", "B"], |x, y| {
                [(x * y % 7) as f32, (x % 3) as f32 * 0.3, -0.1]
            });
            let projection = Projection::of_size(width, height).unwrap();
            let rotation = DMat4::from_rotation_x(0.3) * DMat4::from_rotation_y(-1.0);
            let transform = Transform::from_f64(rotation).unwrap();
            let scene = SceneSphere { center: Vec3::ZERO, radius: 1.0 };
            let (image, space) = (Arc::new(image.to_f16()), RgbColorSpace::srgb());
            let light = ImageInfiniteLight::new(transform.into(), image, projection, space, 2.0, scene);
            lanes_agree(&Sky(light), 3, 200);
        }
    }
}
