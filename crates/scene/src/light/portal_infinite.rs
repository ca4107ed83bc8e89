//! Light from infinity that enters the scene through a rectangle, the portal, and is sampled within
//! what each point sees of it.
//!
//! Directions are mapped to the unit square by two angles about the edges of the portal, so that
//! every rectangle with such edges is an axis-aligned rectangle there: with the local direction
//! (x, y, z), z away from the scene,
//!
//! ```text
//! (s, t) = (atan(x/z), atan(y/z))/π + ½        dω/(ds dt) = π²·(x² + z²)·(y² + z²)/z
//! ```
//!
//! An environment is resampled to this *rectified* square. The part of it that a point sees through
//! the portal is a window, within which a direction is chosen by brightness and solid angle, with
//! no sample lost beside the portal. Points beyond the portal or in its plane receive no light.
//!
//! Power: what passes the portal of area A, Φ = A·∫ L·cos θ dω. Emitted rays start uniformly on the
//! portal, with the density 1/(A·|cos θ|) per area that faces them. Sources: [Bitterli 2015];
//! [Pharr 2023 §12.5.3].

use super::screen::Screen;
use super::{
    Emission, EmissionImage, LightLeSample, LightLiSample, LightModel, LightPart, LightPoint,
    LightSampleContext,
};
use image::Projection;
use math::{Bounds2, Frame, Point2, Point3, Ray, Transform, Vec2, Vec3, Vector3};
use rayon::prelude::*;
use sampling::WindowedPiecewiseConstant2d;
use spectrum::{Rgb, SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// An infinite light behind a portal.
#[derive(Clone, Debug)]
pub struct PortalInfiniteLight {
    portal: Portal,
    radiance: PortalRadiance,
    /// By brightness and solid angle, over the rectified square.
    distribution: WindowedPiecewiseConstant2d,
}

/// A rectangle through which light enters.
#[derive(Clone, Copy, Debug)]
pub struct Portal {
    /// A corner in render space.
    corner: Point3,
    /// x and y along the edges from the corner, z out of the scene.
    frame: Frame,
    /// The lengths of the edges along x and y.
    size: Vec2,
}

/// What is seen through a portal.
#[derive(Clone, Debug)]
pub enum PortalRadiance {
    /// The same radiance in all directions.
    Constant(Emission),
    /// A rectified image.
    Image(RectifiedImage),
}

/// The parts of a light, for engines that sample it elsewhere.
#[derive(Clone, Debug)]
pub struct PlainPortal<'a> {
    /// A corner of the rectangle in render space.
    pub corner: Point3,
    /// x and y along its edges from the corner, z out of the scene.
    pub frame: Frame,
    /// The lengths of its edges along x and y.
    pub size: Vec2,
    /// What is seen through it.
    pub radiance: &'a PortalRadiance,
    /// The cells of the density over the rectified square, along each axis.
    pub resolution: u32,
    /// Their values, row by row.
    pub brightness: Vec<f32>,
}

/// An environment in the rectified square of a portal.
#[derive(Clone, Debug)]
pub struct RectifiedImage {
    /// Rows of colours without negative components, t from 0 to 1; as many columns.
    pixels: Vec<Rgb>,
    resolution: u32,
    color_space: &'static spectrum::RgbColorSpace,
    /// Factor on the colours.
    scale: f32,
}

impl Portal {
    /// The largest cosine of the angles of a rectangle, and distance of its fourth corner from
    /// where the other three put it, relative to the perimeter.
    const TOLERANCE: f32 = 1e-3;

    /// The rectangle of these corners in render space, in their order. The light comes from the
    /// side of (p3 − p0) × (p1 − p0). `None` if they are not the corners of a rectangle.
    pub fn new([p0, p1, p2, p3]: [Point3; 4]) -> Option<Self> {
        let [right, up] = [p3 - p0, p1 - p0];
        let (x, y) = (right.try_normalize()?, up.try_normalize()?);
        let size = Vec2::new(right.length(), up.length());
        let is_closed = (p1 + right).distance(p2) <= Self::TOLERANCE * (size.x + size.y);
        let frame = Frame::from_z_and_x(x.cross(y).try_normalize()?, x);
        (is_closed && x.dot(y).abs() <= Self::TOLERANCE).then_some(Self { corner: p0, frame, size })
    }

    fn area(&self) -> f32 {
        self.size.x * self.size.y
    }

    /// The position of a direction in the rectified square; `None` if it does not lead out of the
    /// scene.
    fn position(&self, w: Vector3) -> Option<Point2> {
        let w = self.frame.to_local(w);
        (w.z > 0.0).then(|| Vec2::new(lanes::atan(w.x / w.z), lanes::atan(w.y / w.z)) / PI + 0.5)
    }

    /// The local unit direction of a position, and solid angle per area there.
    fn local_direction(st: Point2) -> (Vector3, f32) {
        let tangent = (st - 0.5) * PI;
        let w = Vec3::new(libm::tanf(tangent.x), libm::tanf(tangent.y), 1.0).normalize();
        (w, PI * PI * (w.x * w.x + w.z * w.z) * (w.y * w.y + w.z * w.z) / w.z)
    }

    /// The directions in which a point sees the portal from within.
    fn window(&self, p: Point3) -> Option<Bounds2> {
        let far = self.corner + self.frame.from_local(self.size.extend(0.0));
        Some(Bounds2::new(self.position(self.corner - p)?, self.position(far - p)?))
    }

    /// The position of a direction if it passes the portal from `p`, with the window.
    fn passes(&self, p: Point3, w: Vector3) -> Option<(Point2, Bounds2)> {
        let (st, window) = (self.position(w)?, self.window(p)?);
        window.contains(st).then_some((st, window))
    }
}

impl RectifiedImage {
    /// Bytes per pixel of the environment that [`Self::new`] and [`PortalInfiniteLight::new`]
    /// allocate.
    pub const BYTES_PER_PIXEL: usize = 12 + WindowedPiecewiseConstant2d::BYTES_PER_CELL;

    /// Resamples an environment, as many pixels wide and high as it is high. A pixel is
    /// interpolated at its middle.
    pub fn new(
        portal: &Portal,
        environment: &EmissionImage,
        projection: Projection,
        light_from_render: &Transform,
        scale: f32,
    ) -> Self {
        let resolution = environment.image.height();
        let pixel = |i: usize| {
            let [x, y] = [i as u32 % resolution, i as u32 / resolution].map(|i| i as f32 + 0.5);
            let (w, _) = Portal::local_direction(Vec2::new(x, y) / resolution as f32);
            let w = light_from_render.vector(portal.frame.from_local(w)).normalize();
            let rgb = environment.image.bilerp_rgb(projection.position(w), projection.wrap());
            Rgb::from(rgb).clamp_zero()
        };
        let pixels = (0..resolution as usize * resolution as usize).into_par_iter().map(pixel).collect();
        Self { pixels, resolution, color_space: environment.color_space, scale }
    }

    /// Rows of colours without negative components, t from 0 to 1; as many columns.
    pub fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    /// The space of the colours.
    pub fn color_space(&self) -> &'static spectrum::RgbColorSpace {
        self.color_space
    }

    /// The factor on the colours.
    pub fn scale(&self) -> f32 {
        self.scale
    }

    fn lookup(&self, st: Point2) -> Rgb {
        let [x, y] = st.to_array().map(|s| {
            let pixel = (s * self.resolution as f32) as u32;
            pixel.min(self.resolution - 1) as usize
        });
        self.pixels[y * self.resolution as usize + x]
    }
}

impl PortalRadiance {
    /// Cells per axis of the density for a constant radiance.
    const CONSTANT_RESOLUTION: u32 = 64;

    /// The resolution of the density, and brightness times solid angle of its cells.
    fn brightness(&self) -> (u32, Vec<f32>) {
        let resolution = match self {
            Self::Constant(_) => Self::CONSTANT_RESOLUTION,
            Self::Image(image) => image.resolution,
        };
        let cells = cells(resolution).map(|(st, screen)| {
            let brightness = match self {
                Self::Constant(_) => 1.0,
                Self::Image(image) => image.lookup(st).average(),
            };
            brightness * screen.solid_angle() as f32
        });
        (resolution, cells.collect())
    }

    fn sample(&self, st: Point2, lambda: &SampledWavelengths) -> SampledSpectrum {
        match self {
            Self::Constant(emission) => emission.sample(lambda),
            Self::Image(image) => {
                let spectrum = spectrum::Spectrum::rgb_illuminant(image.color_space, image.lookup(st));
                spectrum.sample(lambda) * image.scale
            }
        }
    }
}

/// The cells of the rectified square: their centres, and the rectangles that they are at z = 1.
fn cells(resolution: u32) -> impl Iterator<Item = (Point2, Screen)> {
    let center = move |i: u32| (i as f32 + 0.5) / resolution as f32;
    let angle = move |i: u32| (f64::from(i) / f64::from(resolution) - 0.5) * std::f64::consts::PI;
    let cell = move |x: u32, y: u32| {
        let screen = Screen::between_angles([x, y].map(angle), [x + 1, y + 1].map(angle));
        (Vec2::new(center(x), center(y)), screen)
    };
    (0..resolution).flat_map(move |y| (0..resolution).map(move |x| cell(x, y)))
}

impl PortalInfiniteLight {
    /// The light that is seen through a portal.
    pub fn new(portal: Portal, radiance: PortalRadiance) -> Self {
        let (resolution, brightness) = radiance.brightness();
        let distribution = WindowedPiecewiseConstant2d::new(brightness, resolution as usize);
        Self { portal, radiance, distribution }
    }

    /// Its parts.
    pub fn plain(&self) -> PlainPortal<'_> {
        let Portal { corner, frame, size } = self.portal;
        let (resolution, brightness) = self.radiance.brightness();
        PlainPortal { corner, frame, size, radiance: &self.radiance, resolution, brightness }
    }

    /// The density of a position per solid angle, within a window.
    fn pdf_direction(&self, st: Point2, window: Bounds2) -> f32 {
        self.distribution.pdf(st, window) / Portal::local_direction(st).1
    }
}

impl LightModel for PortalInfiniteLight {
    fn is_delta(&self) -> bool {
        false
    }

    fn is_infinite(&self) -> bool {
        true
    }

    fn emits_within_scene(&self) -> bool {
        true
    }

    fn phi(&self, _part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        match &self.radiance {
            PortalRadiance::Constant(emission) => emission.sample(lambda) * (PI * self.portal.area()),
            PortalRadiance::Image(image) => {
                let sum = cells(image.resolution).fold(SampledSpectrum::ZERO, |sum, (st, screen)| {
                    sum + self.radiance.sample(st, lambda) * screen.projected_solid_angle() as f32
                });
                sum * self.portal.area()
            }
        }
    }

    fn le(&self, ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        match self.portal.passes(ray.o, ray.d) {
            Some((st, _)) => self.radiance.sample(st, lambda),
            None => SampledSpectrum::ZERO,
        }
    }

    fn sample_li(
        &self,
        _part: &LightPart,
        context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        _allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        let (st, density) = self.distribution.sample(u, self.portal.window(context.p.p)?)?;
        let (w, solid_angle) = Portal::local_direction(st);
        let (l, wi) = (self.radiance.sample(st, lambda), self.portal.frame.from_local(w));
        (!l.is_black()).then_some(LightLiSample { l, wi, pdf: density / solid_angle, p: None, n: Vec3::ZERO })
    }

    fn pdf_li(
        &self,
        _part: &LightPart,
        context: &LightSampleContext,
        wi: Vector3,
        _point: LightPoint,
        _allow_incomplete: bool,
    ) -> f32 {
        let passes = self.portal.passes(context.p.p, wi);
        passes.map_or(0.0, |(st, window)| self.pdf_direction(st, window))
    }

    fn sample_le(
        &self,
        _part: &LightPart,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        let Portal { corner, frame, size } = &self.portal;
        let (st, density) = self.distribution.sample(u_direction, Bounds2::UNIT)?;
        let (w, solid_angle) = Portal::local_direction(st);
        let l = self.radiance.sample(st, lambda);
        let o = *corner + frame.from_local((*size * u_position).extend(0.0));
        (!l.is_black()).then(|| LightLeSample {
            l,
            ray: Ray::new(o, -frame.from_local(w), time),
            p: None,
            n: Vec3::ZERO,
            pdf_position: 1.0 / (self.portal.area() * w.z),
            pdf_direction: density / solid_angle,
        })
    }

    fn pdf_le_infinite(&self, ray: &Ray) -> (f32, f32) {
        let Some((st, _)) = self.portal.passes(ray.o, ray.d) else { return (0.0, 0.0) };
        let cos_theta = self.portal.frame.z.dot(ray.d);
        (1.0 / (self.portal.area() * cos_theta), self.pdf_direction(st, Bounds2::UNIT))
    }
}
