//! The realistic camera: rays from the film are refracted by the elements of a lens system.
//!
//! The film is a rectangle of the plane z = 0 around the axis, whose diagonal is that of the
//! sensor. It sees the scene upside down, so that film position x counts towards −x. A ray is
//! sampled by its point in the rectangle A around the exit pupil of the film point
//! ([`exit_pupil`](super::exit_pupil)), in the plane of the rear vertex at the distance z. Of the
//! irradiance on the film, ∫ L·cos θ·cos θ'/r² dA, the estimate is L·A·cos⁴θ/z², which is the
//! weight of the ray, times the share of the light that a stop lets through. [Pharr 2023 §5.4.5]
//!
//! Ray differentials are finite differences between rays that pass the same point of the rear
//! plane, from film points a twentieth of a pixel apart, in a lens without apertures: vignetting
//! neither removes nor bends them.

use super::exit_pupil::ExitPupils;
use super::lens::{Apertures, LensRay, LensSystem};
use image::Image;
use lanes::{Each, MAX_LANES, Real};
use math::{Bounds2, DVec3, Differentials, Point2, Point3, Vec2, Vec3, Vector3};
use std::sync::Arc;

/// The step of finite differences, in pixels.
const STEP: f32 = 0.05;

/// The projection by a lens system.
#[derive(Clone, Debug)]
pub struct Realistic {
    lens: Arc<LensSystem>,
    pupils: Arc<ExitPupils>,
    /// Side of a pixel, in metres.
    pixel: Vec2,
    /// Half the sides of the film, in metres.
    half: Vec2,
}

/// The numbers of a lens system and its film, for engines that trace rays through it elsewhere.
#[derive(Clone, Debug)]
pub struct PlainLens<'a> {
    /// The sides of a pixel, in metres.
    pub pixel: Vec2,
    /// Half the sides of the film, in metres.
    pub half: Vec2,
    /// Interfaces from film to scene: the place of the vertex on the axis, the radius of curvature
    /// or 0 of a stop, both in metres, the index of refraction on the film's side over that beyond,
    /// and the radius of the aperture, in metres.
    pub interfaces: Vec<[f32; 4]>,
    /// The rectangles of exit pupils in the plane of the rear vertex, for equal intervals of the
    /// distance of a film point on the positive x axis; `None` where nothing passes.
    pub pupils: &'a [Option<Bounds2>],
    /// The greatest distance of a film point from the axis, in metres.
    pub radius: f32,
    /// The shares of the light that pass the points of stops, over the squares around them with the
    /// top at y = 1; `None` of disks.
    pub mask: Option<&'a Image>,
}

/// A ray and the share of its radiance that reaches the film, in camera space.
#[derive(Clone, Copy)]
struct Seen {
    film: Point2,
    /// Its point of the rear plane.
    rear: DVec3,
    o: Point3,
    d: Vector3,
    weight: f32,
}

impl Realistic {
    /// A film of the given diagonal, in metres, and of `resolution` pixels behind a focused lens.
    /// `None` if nothing passes the lens.
    pub(super) fn new(lens: LensSystem, diagonal: f32, resolution: [u32; 2]) -> Option<Self> {
        let pupils = ExitPupils::new(&lens, diagonal * 0.5);
        let resolution = Vec2::new(resolution[0] as f32, resolution[1] as f32);
        let size = resolution * (diagonal / resolution.length());
        (!pupils.are_empty()).then(|| Self {
            lens: lens.into(),
            pupils: pupils.into(),
            pixel: size / resolution,
            half: size * 0.5,
        })
    }

    /// Its numbers.
    pub fn plain(&self) -> PlainLens<'_> {
        PlainLens {
            pixel: self.pixel,
            half: self.half,
            interfaces: self.lens.plain().collect(),
            pupils: self.pupils.rectangles(),
            radius: self.pupils.radius(),
            mask: self.lens.mask(),
        }
    }

    /// The same view in pixels `n` times as wide and high.
    pub(super) fn coarser(&self, n: u32) -> Self {
        Self { pixel: self.pixel * n as f32, ..self.clone() }
    }

    /// The point of a film position.
    fn film_point(&self, film: Point2) -> DVec3 {
        let p = film * self.pixel - self.half;
        DVec3::new(f64::from(-p.x), f64::from(p.y), 0.0)
    }

    /// The ray of a film position and a lens sample; `None` if it is blocked.
    fn seen(&self, film: Point2, lens: Vec2) -> Option<Seen> {
        let from = self.film_point(film);
        let distance = from.length();
        let pupil = self.pupils.at(distance as f32)?;
        let p = pupil.lerp(lens).as_dvec2();
        let (cos, sin) = if distance > 0.0 { (from.x / distance, from.y / distance) } else { (1.0, 0.0) };
        let rear = DVec3::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y, self.lens.rear_z());
        let d = (rear - from).normalize();
        let (ray, share) = self.lens.trace_from_film(LensRay { o: from, d }, Apertures::Closed)?;
        let weight = share * d.z.powi(4) * f64::from(pupil.area()) / (rear.z * rear.z);
        Some(Seen { film, rear, o: ray.o.as_vec3().into(), d: ray.d.as_vec3().into(), weight: weight as f32 })
    }

    /// Origin and direction of the ray one pixel along `axis` from another; the same ray where none
    /// is found.
    fn neighbour(&self, seen: &Seen, axis: Vec2) -> (Point3, Vector3) {
        let trace = |film: Point2| {
            let o = self.film_point(film);
            let ray = LensRay { o, d: (seen.rear - o).normalize() };
            self.lens.trace_from_film(ray, Apertures::Open).map(|(ray, _)| ray)
        };
        let difference = |step: f32| {
            let (here, near) = (trace(seen.film)?, trace(seen.film + axis * step)?);
            let scale = 1.0 / f64::from(step);
            let [o, d] = [near.o - here.o, near.d - here.d].map(|v| Vec3::from((v * scale).as_vec3()));
            Some((o, d))
        };
        let found = difference(STEP).or_else(|| difference(-STEP));
        found.map_or((seen.o, seen.d), |(o, d)| (seen.o + o, seen.d + d))
    }

    /// Origin, unit direction and weight of the rays of film positions, in camera space. A ray that
    /// is blocked has weight 0.
    #[inline(always)]
    pub(super) fn ray<R: Real>(&self, film: Point2<R>, lens: Vec2<R>) -> (Point3<R>, Vector3<R>, R) {
        let [a, b, c, d, e, f, weight] = lane_by_lane(film, lens, |film, lens| self.numbers(film, lens));
        (Vec3::new(a, b, c), Vec3::new(d, e, f), weight)
    }

    /// [`Self::ray`] and its differentials.
    #[inline(always)]
    pub(super) fn ray_differential<R: Real>(
        &self,
        film: Point2<R>,
        lens: Vec2<R>,
    ) -> (Point3<R>, Vector3<R>, R, Differentials<R>) {
        let (o, d, weight) = self.ray(film, lens);
        let near = lane_by_lane(film, lens, |film, lens| self.neighbours(film, lens));
        let [a, b, c, e, f, g, h, i, j, k, l, m] = near;
        let near = Differentials {
            rx_origin: Vec3::new(a, b, c),
            rx_direction: Vec3::new(e, f, g),
            ry_origin: Vec3::new(h, i, j),
            ry_direction: Vec3::new(k, l, m),
        };
        (o, d, weight, near)
    }

    /// Origin, direction and weight.
    fn numbers(&self, film: Point2, lens: Vec2) -> [f32; 7] {
        let Some(Seen { o, d, weight, .. }) = self.seen(film, lens) else {
            return [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        };
        [o.x, o.y, o.z, d.x, d.y, d.z, weight]
    }

    /// Origins and directions of the rays to the right and down.
    fn neighbours(&self, film: Point2, lens: Vec2) -> [f32; 12] {
        let Some(seen) = self.seen(film, lens) else {
            return [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        };
        let ((a, b), (c, d)) = (self.neighbour(&seen, Vec2::X), self.neighbour(&seen, Vec2::Y));
        [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z]
    }
}

/// The numbers of each lane, one lane after another: lenses are not traced in lanes.
#[inline(always)]
fn lane_by_lane<R: Real, const N: usize>(
    film: Point2<R>,
    lens: Vec2<R>,
    numbers: impl Fn(Point2, Vec2) -> [f32; N],
) -> [R; N] {
    let [x, y] = film.to_array().each(R::to_array);
    let [u, v] = lens.to_array().each(R::to_array);
    let mut columns = [[0.0; MAX_LANES]; N];
    for lane in 0..R::LANES {
        let values = numbers(Vec2::new(x[lane], y[lane]), Vec2::new(u[lane], v[lane]));
        for (column, value) in columns.iter_mut().zip(values) {
            column[lane] = value;
        }
    }
    let mut all = [R::zero(); N];
    for (number, column) in all.iter_mut().zip(&columns) {
        *number = R::load(column);
    }
    all
}
