//! A light at a point whose intensity depends on the direction, as goniometers measure it:
//! L = I·m(ω) / r², with m given by an image over the sphere of directions.
//!
//! The image is in the equal-area [`Projection`], each pixel constant over its solid angle; the
//! light's +y is in the middle of it, and +z where the projection has +y. With the mean m̄ of the
//! pixels the power is Φ = 4π·I·m̄, and p the density m/m̄ of the square. Rays leave with the
//! density p/(4π) per solid angle, in proportion to the intensity, so that each carries all of Φ.
//! Only p is stored: m = m̄·p. Sources: [Pharr 2023 §12.2.3].

use super::emitter::solid_angle_factor;
use super::point::{reach, sample_point};
use super::{Emission, LightBounds, LightLeSample, LightLiSample, LightModel, LightPart, LightSampleContext};
use image::Projection;
use math::{AnimatedTransform, Bounds2, Normal3, Point2, Point3, Point3Error, Ray, Transform, Vec3, Vector3};
use sampling::PiecewiseConstant2d;
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// A goniometric light at the origin of its own space.
#[derive(Clone, Debug)]
pub struct GoniometricLight {
    /// From the light's own space to render space.
    render_from_light: AnimatedTransform,
    /// Mean radiant intensity over all directions, I·m̄.
    mean_intensity: Emission,
    /// Intensity over its mean, on the square.
    distribution: PiecewiseConstant2d,
}

impl GoniometricLight {
    /// Bytes per pixel that [`Self::new`] allocates.
    pub const BYTES_PER_PIXEL: usize = 16;

    /// The intensity is proportional to `pixels`, `width` rows of as many; `mean_intensity` is its
    /// mean.
    pub fn new(
        render_from_light: AnimatedTransform,
        mean_intensity: Emission,
        pixels: &[f32],
        width: usize,
    ) -> Self {
        let distribution = PiecewiseConstant2d::new(pixels, width, Bounds2::UNIT);
        Self { render_from_light, mean_intensity, distribution }
    }

    /// From the light's own space to render space, the mean intensity, and the intensity over that,
    /// on the square.
    pub fn parts(&self) -> (&AnimatedTransform, &Emission, &PiecewiseConstant2d) {
        (&self.render_from_light, &self.mean_intensity, &self.distribution)
    }

    /// Position in render space at a shutter time.
    pub fn position(&self, time: f32) -> Point3 {
        self.render_from_light.at(time).point(Vec3::ZERO)
    }

    /// The intensity along a direction in render space, over the mean.
    fn relative_intensity(&self, w: Vector3, light_from_render: &Transform) -> f32 {
        let local = light_from_render.vector(w).normalize();
        self.distribution.pdf(Projection::EqualArea.position(swap_axes(local)))
    }
}

/// From the space of the light to that of the projection, or back.
fn swap_axes(w: Vector3) -> Vector3 {
    Vec3::new(w.x, w.z, w.y)
}

impl LightModel for GoniometricLight {
    fn is_delta(&self) -> bool {
        true
    }

    fn phi(&self, _part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.mean_intensity.sample(lambda) * (4.0 * PI)
    }

    fn sample_li(
        &self,
        _part: &LightPart,
        context: &LightSampleContext,
        _u: Point2,
        lambda: &SampledWavelengths,
        _allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        let render_from_light = self.render_from_light.at(context.time);
        let p = render_from_light.point(Vec3::ZERO);
        let light_from_render = render_from_light.inverse();
        sample_point(p, context, |w, distance2| {
            self.mean_intensity.sample(lambda) * self.relative_intensity(w, &light_from_render) / distance2
        })
    }

    fn sample_le(
        &self,
        _part: &LightPart,
        _u_position: Point2,
        u: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        let (st, relative, _) = self.distribution.sample(u);
        let render_from_light = self.render_from_light.at(time);
        let w = render_from_light.vector(swap_axes(Projection::EqualArea.direction(st))).normalize();
        let l = self.mean_intensity.sample(lambda) * relative;
        let p = render_from_light.point(Vec3::ZERO);
        (!l.is_black()).then(|| LightLeSample {
            l,
            ray: Ray::new(p, w, time),
            p: Some(Point3Error::exact(p)),
            n: Vec3::ZERO,
            pdf_position: 1.0,
            pdf_direction: relative / (4.0 * PI) * solid_angle_factor(&render_from_light.inverse(), w),
        })
    }

    fn pdf_le(&self, _part: &LightPart, _p: Point3, _n: Normal3, w: Vector3, time: f32) -> (f32, f32) {
        let light_from_render = self.render_from_light.at(time).inverse();
        let relative = self.relative_intensity(w, &light_from_render);
        (0.0, relative / (4.0 * PI) * solid_angle_factor(&light_from_render, w))
    }

    /// The bounds of an isotropic light.
    fn bounds(&self, _part: &LightPart) -> Option<LightBounds> {
        let motion = &self.render_from_light;
        Some(LightBounds {
            bounds: reach(Vec3::ZERO, Some(motion)),
            w: Vec3::Z,
            phi: 4.0 * PI * self.mean_intensity.max_value(),
            cos_theta_o: -1.0,
            cos_theta_e: 0.0,
            two_sided: false,
        })
    }
}
