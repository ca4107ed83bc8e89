//! The projections of cameras, between film positions and rays of camera space.

use lanes::Real;
use math::{Differentials, Point2, Point3, Vec2, Vec3, Vector3};

use super::orthographic::Orthographic;
use super::perspective::Perspective;
use super::realistic::Realistic;
use super::spherical::Spherical;

/// How film positions map to rays of camera space.
#[derive(Clone, Debug)]
pub enum Projection {
    /// Through one point.
    Perspective(Perspective),
    /// In parallel.
    Orthographic(Orthographic),
    /// In all directions.
    Spherical(Spherical),
    /// Through a system of lenses.
    Realistic(Realistic),
}

impl Projection {
    /// Origin and unit direction, in camera space, and weight of the ray of a film position and a
    /// lens sample; weight 0 if it is blocked.
    #[inline(always)]
    pub(super) fn ray<R: Real>(&self, film: Point2<R>, lens: Vec2<R>) -> (Point3<R>, Vector3<R>, R) {
        let (o, d) = match self {
            Self::Perspective(p) => p.ray(film, lens),
            Self::Orthographic(p) => p.ray(film, lens),
            Self::Spherical(p) => p.ray(film),
            Self::Realistic(p) => return p.ray(film, lens),
        };
        (o, d, R::one())
    }

    /// Whether rays depend on samples of the lens.
    pub(super) fn has_lens(&self) -> bool {
        match self {
            Self::Perspective(p) => p.lens().radius > 0.0,
            Self::Orthographic(p) => !p.is_parallel(),
            Self::Spherical(_) => false,
            Self::Realistic(_) => true,
        }
    }

    /// Whether all rays have weight 1.
    pub(super) fn is_unweighted(&self) -> bool {
        match self {
            Self::Perspective(_) | Self::Orthographic(_) | Self::Spherical(_) => true,
            Self::Realistic(_) => false,
        }
    }

    /// The film position of the ray from `o` on the lens along the unit direction `d`, both in
    /// camera space, and the film area in square pixels per solid angle, or for parallel rays per
    /// area of the film's plane. `None` for rays that do not leave the front, and for a system of
    /// lenses, whose rays cannot be followed backwards to a given point of it.
    pub(super) fn film(&self, o: Point3, d: Vector3) -> Option<(Point2, f32)> {
        match self {
            Self::Perspective(p) => p.film(o, d),
            Self::Orthographic(p) => p.film(o, d),
            Self::Spherical(p) => p.film(d),
            Self::Realistic(_) => None,
        }
    }

    /// The same view in pixels `n` times as wide and high.
    pub(super) fn coarser(&self, n: u32) -> Self {
        match self {
            Self::Perspective(p) => Self::Perspective(p.coarser(n)),
            Self::Orthographic(p) => Self::Orthographic(p.coarser(n)),
            Self::Spherical(p) => Self::Spherical(p.coarser(n)),
            Self::Realistic(p) => Self::Realistic(p.coarser(n)),
        }
    }

    /// The aperture through which rays reach the film.
    pub(super) fn aperture(&self) -> Aperture {
        match self {
            Self::Perspective(p) => p.lens().area().map_or(Aperture::Pinhole, Aperture::Lens),
            Self::Orthographic(p) => p.lens().area().map_or(Aperture::Film, Aperture::Lens),
            Self::Spherical(_) => Aperture::Point,
            Self::Realistic(_) => Aperture::Unseen,
        }
    }

    /// A point of the aperture that sees `p`, in camera space; on a lens it is chosen by `u` in [0,
    /// 1)².
    pub(super) fn lens_point(&self, p: Point3, u: Vec2) -> Point3 {
        match self {
            Self::Orthographic(o) if o.is_parallel() => Vec3::new(p.x, p.y, 0.0),
            Self::Perspective(o) => o.lens().at(u),
            Self::Orthographic(o) => o.lens().at(u),
            Self::Spherical(_) | Self::Realistic(_) => Vec3::ZERO,
        }
    }

    /// Unit direction and distance from the camera, at the centre of its lens, to `p` in camera
    /// space.
    #[inline(always)]
    pub(super) fn way_to<R: Real>(&self, p: Point3<R>) -> (Vector3<R>, R) {
        let forward = Vec3::broadcast(Vec3::Z);
        match self {
            Self::Orthographic(o) if o.is_parallel() => (forward, p.z),
            _ => {
                let (d, is_apart) = p.normalize_masked();
                (Vec3::select(is_apart, d, forward), p.length())
            }
        }
    }

    /// The ray of [`Self::ray`] and its differentials, in camera space. They are finite differences
    /// over a whole pixel on a flat film, which is exact; over less on the sphere, where a pixel
    /// may span a large angle.
    #[inline(always)]
    pub(super) fn ray_differential<R: Real>(
        &self,
        film: Point2<R>,
        lens: Vec2<R>,
    ) -> (Point3<R>, Vector3<R>, R, Differentials<R>) {
        match self {
            Self::Perspective(_) | Self::Orthographic(_) => self.difference(film, lens, 1.0),
            Self::Spherical(_) => self.difference(film, lens, 0.05),
            Self::Realistic(p) => p.ray_differential(film, lens),
        }
    }

    /// The same, from rays of film positions `step` pixels apart.
    #[inline(always)]
    fn difference<R: Real>(
        &self,
        film: Point2<R>,
        lens: Vec2<R>,
        step: f32,
    ) -> (Point3<R>, Vector3<R>, R, Differentials<R>) {
        let (o, d, weight) = self.ray(film, lens);
        let apart = R::splat(step);
        let [rx, ry] = [Vec2::new(film.x + apart, film.y), Vec2::new(film.x, film.y + apart)];
        let (rx_origin, rx_direction) = self.neighbour(o, d, rx, lens, step);
        let (ry_origin, ry_direction) = self.neighbour(o, d, ry, lens, step);
        (o, d, weight, Differentials { rx_origin, rx_direction, ry_origin, ry_direction })
    }

    /// The ray one pixel from a ray, computed from that of a film position one step from it.
    #[inline(always)]
    fn neighbour<R: Real>(
        &self,
        o: Point3<R>,
        d: Vector3<R>,
        near: Point2<R>,
        lens: Vec2<R>,
        step: f32,
    ) -> (Point3<R>, Vector3<R>) {
        let (near_o, near_d, _) = self.ray(near, lens);
        if step == 1.0 {
            return (near_o, near_d);
        }
        (o + (near_o - o) / R::splat(step), d + (near_d - d) / R::splat(step))
    }
}

/// The aperture through which rays reach the film.
pub(super) enum Aperture {
    /// A point, from any direction.
    Point,
    /// A point of the plane z = 0.
    Pinhole,
    /// An area of the plane z = 0, at any angle.
    Lens(f32),
    /// The film itself, in the plane z = 0, along the axis only.
    Film,
    /// None that a path from a light could be connected to.
    Unseen,
}
