//! A system of lenses: spherical interfaces and aperture stops along an axis.
//!
//! Lengths are in metres, in camera space: the film is the plane z = 0, and the axis of the lens is
//! +z. An interface has its vertex at z and, with the radius R, its centre at z − R, so that R > 0
//! bulges towards the scene. Rays are traced in double precision from interface to interface. At
//! each they are blocked outside the aperture, or refracted by Snell's law ([Kolb 1995];
//! [Pharr 2023 §5.4]).
//!
//! For focusing the system is taken for a thick lens. Rays parallel to the axis, traced from
//! either side, give its principal planes p' (towards the film) and p, and the focal length f. At
//! the distance s of the plane of focus from the film, object and image distance add up to
//! D = s − (p − p'), wherever the lens is, and 1/(D − b) + 1/b = 1/f has the solution
//!
//! ```text
//! b = (D − √(D·(D − 4f))) / 2
//! ```
//!
//! for the distance b from the film to p', which exists for D ≥ 4f.

use description::LensElement;
use image::Image;
use math::DVec3;

use super::aperture::ApertureMask;

/// One interface of the system.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Interface {
    /// Place of its vertex on the axis.
    z: f64,
    /// Radius of curvature; `None` for an aperture stop.
    curvature: Option<f64>,
    /// Index of refraction towards the scene.
    eta_scene: f64,
    /// Index of refraction towards the film.
    eta_film: f64,
    /// Radius of the aperture.
    aperture: f64,
}

/// Which rays the apertures block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Apertures {
    /// Those that the described ones block.
    Closed,
    /// None: interfaces extend as far as their spheres.
    Open,
}

/// A ray with a unit direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LensRay {
    pub o: DVec3,
    pub d: DVec3,
}

/// Why a system cannot be focused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FocusError {
    /// Parallel light does not converge behind it.
    NotConverging,
    /// The plane of focus is too near; the least distance, in metres.
    TooNear(f64),
    /// The film would have to be inside the lens.
    InsideLens,
}

/// Interfaces in order, from the scene to the film.
#[derive(Clone, Debug)]
pub(super) struct LensSystem {
    interfaces: Vec<Interface>,
    /// The shape of its stops; `None` is circular.
    mask: Option<ApertureMask>,
}

impl LensSystem {
    /// The system of lens elements as a file has them, in millimetres and from the scene to the
    /// film, with stops of the diameter `stop` where theirs is greater.
    pub fn new(elements: &[LensElement], stop: f32, mask: Option<ApertureMask>) -> Self {
        const METRES: f64 = 1e-3;
        let medium = |eta: f32| if eta == 0.0 { 1.0 } else { f64::from(eta) };
        let mut z: f64 = elements.iter().map(|e| f64::from(e.thickness) * METRES).sum();
        let mut eta_scene = 1.0;
        let mut interfaces = Vec::with_capacity(elements.len());
        for element in elements {
            let is_stop = element.curvature_radius == 0.0;
            let eta_film = medium(element.eta);
            let diameter =
                if is_stop { element.aperture_diameter.min(stop) } else { element.aperture_diameter };
            interfaces.push(Interface {
                z,
                curvature: (!is_stop).then_some(f64::from(element.curvature_radius) * METRES),
                eta_scene,
                eta_film,
                aperture: f64::from(diameter) * 0.5 * METRES,
            });
            eta_scene = eta_film;
            z -= f64::from(element.thickness) * METRES;
        }
        Self { interfaces, mask }
    }

    /// Whether a stop has a shape other than a disk.
    pub fn has_mask(&self) -> bool {
        self.mask.is_some()
    }

    /// Distance from the film to the vertex of the rear interface.
    pub fn rear_z(&self) -> f64 {
        self.interfaces.last().map_or(0.0, |rear| rear.z)
    }

    /// Radius of the rear interface's aperture.
    pub fn rear_radius(&self) -> f64 {
        self.interfaces.last().map_or(0.0, |rear| rear.aperture)
    }

    /// The place of each vertex, the radius of curvature or 0 of a stop, the index of refraction on
    /// the film's side over that beyond, and the radius of the aperture, from film to scene.
    pub fn plain(&self) -> impl Iterator<Item = [f32; 4]> {
        self.interfaces.iter().rev().map(|it| {
            let curvature = it.curvature.unwrap_or(0.0);
            [it.z, curvature, it.eta_film / it.eta_scene, it.aperture].map(|x| x as f32)
        })
    }

    /// The shares of the light that pass the points of stops.
    pub fn mask(&self) -> Option<&Image> {
        self.mask.as_ref().map(ApertureMask::image)
    }

    /// Distance from the film to the vertex of the front interface.
    fn front_z(&self) -> f64 {
        self.interfaces.first().map_or(0.0, |front| front.z)
    }

    /// The ray that leaves the front for a ray from the film, and the share of its light that
    /// passes the stops; `None` if it is blocked.
    pub fn trace_from_film(&self, ray: LensRay, apertures: Apertures) -> Option<(LensRay, f64)> {
        let (mut ray, mut share) = (ray, 1.0);
        for interface in self.interfaces.iter().rev() {
            share *= self.pass(interface, &mut ray, interface.eta_film / interface.eta_scene, apertures)?;
        }
        Some((ray, share))
    }

    /// The ray that leaves the rear for a ray from the scene, and the share of its light that
    /// passes the stops; `None` if it is blocked.
    pub fn trace_from_scene(&self, ray: LensRay, apertures: Apertures) -> Option<(LensRay, f64)> {
        let (mut ray, mut share) = (ray, 1.0);
        for interface in &self.interfaces {
            share *= self.pass(interface, &mut ray, interface.eta_scene / interface.eta_film, apertures)?;
        }
        Some((ray, share))
    }

    /// Moves a ray to its point of an interface and refracts it there. `eta` is the index on its
    /// side over that beyond.
    fn pass(&self, interface: &Interface, ray: &mut LensRay, eta: f64, apertures: Apertures) -> Option<f64> {
        let Interface { z, curvature, aperture, .. } = *interface;
        let Some(radius) = curvature else {
            let t = (z - ray.o.z) / ray.d.z;
            // Not along its plane either.
            if t < 0.0 || !t.is_finite() {
                return None;
            }
            ray.o += ray.d * t;
            if apertures == Apertures::Open {
                return Some(1.0);
            }
            let share = match &self.mask {
                Some(mask) => f64::from(mask.share([ray.o.x / aperture, ray.o.y / aperture])),
                None => f64::from(u8::from(is_within(ray.o, aperture))),
            };
            return (share > 0.0).then_some(share);
        };
        let center = DVec3::new(0.0, 0.0, z - radius);
        ray.o += ray.d * intersect_sphere(ray, center, radius)?;
        if apertures == Apertures::Closed && !is_within(ray.o, aperture) {
            return None;
        }
        let n = (ray.o - center) / radius.abs();
        let n = if n.dot(ray.d) > 0.0 { -n } else { n };
        ray.d = refract(ray.d, n, eta)?;
        Some(1.0)
    }

    /// Moves the system along the axis, so that the plane at `distance` from the film is in focus.
    /// `height` is the distance from the axis of the rays by which the cardinal points are found.
    pub fn focus(&mut self, distance: f64, height: f64) -> Result<(), FocusError> {
        let thick = self.thick_lens(height).ok_or(FocusError::NotConverging)?;
        let between = distance - thick.separation;
        if between < 4.0 * thick.focal_length {
            return Err(FocusError::TooNear(4.0 * thick.focal_length + thick.separation));
        }
        let image = (between - (between * (between - 4.0 * thick.focal_length)).sqrt()) * 0.5;
        let shift = image - thick.film_side;
        if self.rear_z() + shift <= 0.0 {
            return Err(FocusError::InsideLens);
        }
        self.interfaces.iter_mut().for_each(|interface| interface.z += shift);
        Ok(())
    }

    /// The thick lens that parallel rays near the axis find; `None` if they do not converge.
    pub fn thick_lens(&self, height: f64) -> Option<ThickLens> {
        let parallel = |z: f64, direction: f64| LensRay {
            o: DVec3::new(height, 0.0, z),
            d: DVec3::new(0.0, 0.0, direction),
        };
        let (to_film, _) = self.trace_from_scene(parallel(self.front_z() + 1.0, -1.0), Apertures::Open)?;
        let (to_scene, _) = self.trace_from_film(parallel(self.rear_z() - 1.0, 1.0), Apertures::Open)?;
        let at_height = |ray: LensRay, x: f64| ray.o.z + ray.d.z * ((x - ray.o.x) / ray.d.x);
        let film_side = at_height(to_film, height);
        let focal_length = film_side - at_height(to_film, 0.0);
        let separation = at_height(to_scene, height) - film_side;
        let is_converging = focal_length > 0.0 && focal_length.is_finite() && separation.is_finite();
        is_converging.then_some(ThickLens { film_side, focal_length, separation })
    }
}

/// The cardinal points of a system, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ThickLens {
    /// Distance of the principal plane towards the film from the film.
    pub film_side: f64,
    /// The focal length.
    pub focal_length: f64,
    /// From that principal plane to the one towards the scene.
    pub separation: f64,
}

fn is_within(p: DVec3, radius: f64) -> bool {
    p.x * p.x + p.y * p.y <= radius * radius
}

/// The distance to the side of a sphere around the axis that belongs to a lens; `None` if the ray
/// misses it.
fn intersect_sphere(ray: &LensRay, center: DVec3, radius: f64) -> Option<f64> {
    let to_center = center - ray.o;
    let nearest = to_center.dot(ray.d);
    let half = (radius * radius - (to_center - ray.d * nearest).length_squared()).sqrt();
    // The vertex is on the near side where the sphere bulges against the ray.
    let t = if (ray.d.z > 0.0) == (radius < 0.0) { nearest - half } else { nearest + half };
    // False for the NaN of a sphere that is missed.
    (t >= 0.0).then_some(t)
}

/// Refracts the unit direction `d` at the unit normal `n` against it; `None` if it is reflected.
fn refract(d: DVec3, n: DVec3, eta: f64) -> Option<DVec3> {
    let cos_i = -d.dot(n);
    let cos2_t = 1.0 - eta * eta * (1.0 - cos_i * cos_i);
    (cos2_t > 0.0).then(|| (d * eta + n * (eta * cos_i - cos2_t.sqrt())).normalize())
}
