//! A slide projector: a light at a point that throws an image along its +z axis, L = I(ω) / r².
//!
//! The image fills a screen at z = 1 of height (or width, if that is less) 2·tan(fov/2), with its
//! top towards +y; I is the radiance of the pixel that a direction passes, 0 beside the screen. A
//! screen area dA is seen under the solid angle cos³θ·dA, so that the power is Φ = ∫ I·cos³θ dA.
//! Rays leave through a pixel that is chosen by brightness times solid angle, and through points of
//! it with uniform density per area. Sources: [Pharr 2023 §12.2.2].

use super::emitter::solid_angle_factor;
use super::point::{reach, sample_point};
use super::screen::Screen;
use super::{
    EmissionImage, LightBounds, LightLeSample, LightLiSample, LightModel, LightPart, LightSampleContext,
};
use math::{AnimatedTransform, Bounds2, Normal3, Point2, Point3, Point3Error, Ray, Vec2, Vec3, Vector3};
use sampling::PiecewiseConstant2d;
use spectrum::{Rgb, SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// A light that projects an image, at the origin of its own space.
#[derive(Clone, Debug)]
pub struct ProjectionLight {
    /// From the light's own space to render space.
    render_from_light: AnimatedTransform,
    slide: Slide,
    /// Factor on the image.
    scale: f32,
    /// Over the screen.
    distribution: PiecewiseConstant2d,
}

/// An image on a screen at z = 1.
#[derive(Clone, Debug)]
pub struct Slide {
    /// The pixels.
    pub image: EmissionImage,
    /// The screen; its top row has the greatest y.
    screen: Bounds2,
}

impl Slide {
    /// The slide whose shorter side is seen under `fov` degrees.
    pub fn new(image: EmissionImage, fov: f32) -> Self {
        let half = libm::tanf((0.5 * fov).to_radians());
        let [width, height] = [image.image.width() as f32, image.image.height() as f32];
        let corner = Vec2::new(width, height) * (half / width.min(height));
        Self { image, screen: Bounds2::new(-corner, corner) }
    }

    /// The screen at z = 1.
    pub fn screen(&self) -> Bounds2 {
        self.screen
    }

    /// The integral over solid angle of its colours, without negative components.
    pub fn total(&self) -> Rgb {
        let mut total = [0f64; 3];
        for (rgb, solid_angle) in self.pixels() {
            for (sum, c) in total.iter_mut().zip([rgb.r, rgb.g, rgb.b]) {
                *sum += f64::from(c * solid_angle);
            }
        }
        Rgb::from(total.map(|sum| sum as f32))
    }

    /// The colours of the pixels row by row from the top, each with its solid angle.
    fn pixels(&self) -> impl Iterator<Item = (Rgb, f32)> + '_ {
        let [width, height] = [self.image.image.width(), self.image.image.height()];
        self.image.pixels().zip(0..).map(move |(rgb, i)| {
            let corner = |x: u32, y: u32| {
                self.direction(Vec2::new(x as f32 / width as f32, y as f32 / height as f32)).truncate()
            };
            let [x, y] = [i % width, i / width];
            let pixel = Screen::new(Bounds2::new(corner(x, y), corner(x + 1, y + 1)));
            (rgb, pixel.solid_angle() as f32)
        })
    }

    /// The direction to the position `st` of the image, with z = 1.
    fn direction(&self, st: Point2) -> Vector3 {
        self.screen.lerp(Vec2::new(st.x, 1.0 - st.y)).extend(1.0)
    }

    /// The position in the image that a direction passes.
    fn position(&self, w: Vector3) -> Option<Point2> {
        let p = Vec2::new(w.x, w.y) / w.z;
        let is_in_front = w.z > 0.0 && self.screen.contains(p);
        let st = self.screen.offset(p);
        is_in_front.then_some(Vec2::new(st.x, 1.0 - st.y))
    }
}

/// The cosine of a direction with z = 1 and the axis.
fn cos_theta(w: Vector3) -> f32 {
    1.0 / w.length()
}

impl ProjectionLight {
    /// Bytes per pixel that [`Self::new`] allocates.
    pub const BYTES_PER_PIXEL: usize = 16;

    /// The light that projects a slide, its colours times `scale`.
    pub fn new(render_from_light: AnimatedTransform, slide: Slide, scale: f32) -> Self {
        let pixels = slide.pixels();
        let brightness: Vec<f32> = pixels.map(|(rgb, solid_angle)| rgb.average() * solid_angle).collect();
        let width = slide.image.image.width() as usize;
        let distribution = PiecewiseConstant2d::new(&brightness, width, Bounds2::UNIT);
        Self { render_from_light, slide, scale, distribution }
    }

    /// From the light's own space to render space, the slide, the factor on its colours, and the
    /// distribution over its screen.
    pub fn parts(&self) -> (&AnimatedTransform, &Slide, f32, &PiecewiseConstant2d) {
        (&self.render_from_light, &self.slide, self.scale, &self.distribution)
    }

    /// Position and unit axis in render space at a shutter time.
    pub fn placement(&self, time: f32) -> (Point3, Vector3) {
        let transform = self.render_from_light.at(time);
        (transform.point(Vec3::ZERO), transform.vector(Vec3::Z).normalize())
    }

    /// The radiant intensity through a position of the image.
    fn intensity(&self, st: Point2, lambda: &SampledWavelengths) -> SampledSpectrum {
        let image = &self.slide.image.image;
        let pixel = |s: f32, size: u32| ((s * size as f32) as u32).min(size - 1);
        let rgb = image.rgb(pixel(st.x, image.width()), pixel(st.y, image.height()));
        self.slide.image.sample(Rgb::from(rgb), lambda) * self.scale
    }

    /// Density per solid angle of the rays through a position of the image, in the light's space.
    fn pdf_local(&self, st: Point2) -> f32 {
        let cos_theta = cos_theta(self.slide.direction(st));
        self.distribution.pdf(st) / (self.slide.screen.area() * cos_theta.powi(3))
    }
}

impl LightModel for ProjectionLight {
    fn is_delta(&self) -> bool {
        true
    }

    fn phi(&self, _part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        let mut sum = SampledSpectrum::ZERO;
        for (rgb, solid_angle) in self.slide.pixels() {
            sum += self.slide.image.sample(rgb, lambda) * solid_angle;
        }
        sum * self.scale
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
        sample_point(p, context, |w, distance2| match self.slide.position(light_from_render.vector(w)) {
            Some(st) => self.intensity(st, lambda) / distance2,
            None => SampledSpectrum::ZERO,
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
        let (st, _, _) = self.distribution.sample(u);
        let render_from_light = self.render_from_light.at(time);
        let w = render_from_light.vector(self.slide.direction(st)).normalize();
        let (l, p) = (self.intensity(st, lambda), render_from_light.point(Vec3::ZERO));
        (!l.is_black()).then(|| LightLeSample {
            l,
            ray: Ray::new(p, w, time),
            p: Some(Point3Error::exact(p)),
            n: Vec3::ZERO,
            pdf_position: 1.0,
            pdf_direction: self.pdf_local(st) * solid_angle_factor(&render_from_light.inverse(), w),
        })
    }

    fn pdf_le(&self, _part: &LightPart, _p: Point3, _n: Normal3, w: Vector3, time: f32) -> (f32, f32) {
        let light_from_render = self.render_from_light.at(time).inverse();
        let st = self.slide.position(light_from_render.vector(w));
        (0.0, st.map_or(0.0, |st| self.pdf_local(st) * solid_angle_factor(&light_from_render, w)))
    }

    /// A cone around the screen, with its mean intensity.
    fn bounds(&self, _part: &LightPart) -> Option<LightBounds> {
        let motion = &self.render_from_light;
        let corner = cos_theta(self.slide.screen.max.extend(1.0));
        let mean = self.slide.total().average() / Screen::new(self.slide.screen).solid_angle() as f32;
        let illuminant = self.slide.image.color_space.illuminant().max_value();
        Some(LightBounds {
            bounds: reach(Vec3::ZERO, Some(motion)),
            w: motion.start().vector(Vec3::Z).normalize(),
            phi: 4.0 * PI * mean * illuminant * self.scale,
            cos_theta_o: if motion.is_moving() { -1.0 } else { 1.0 },
            // A margin for rounding, so that points just inside of the corners keep some
            // importance.
            cos_theta_e: (corner - 1e-3).max(-1.0),
            two_sided: false,
        })
    }
}
