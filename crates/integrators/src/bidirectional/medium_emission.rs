//! Light subpaths that start in media that emit.
//!
//! A medium sends out the power 4π σ_a L_e per volume. A subpath starts at a point with the density
//! p and in a uniform direction, so its throughput is 4π σ_a L_e / p. Points are sampled in a box
//! around each medium, by cells in proportion to the power that a few points in each of them have;
//! a tenth is uniform, so that nothing is missed. A homogeneous medium has no box of its own: its
//! box is that of the scene, and points that a ray finds to lie in another medium send no light. So
//! endless fog emits within the bounds of the scene only.
//!
//! The algorithms that find emission of media along camera paths, whatever their length, need no
//! such subpaths ([`Lights::of`](super::Lights::of)).

use geometry::RayStats;
use math::{Bounds3, Point3, Ray, Vec2, Vec3};
use sampling::{AliasTable, hash_float, warp};
use scene::camera::CameraSample;
use scene::medium::MediumId;
use scene::{Scene, View};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

use crate::{Cancelled, Control};

/// Cells along a side of a box.
const SIDE: usize = 16;
const CELLS: usize = SIDE * SIDE * SIDE;
/// Points of each cell at which its power is estimated.
const POINTS: u32 = 4;
/// The share of points that are uniform.
const UNIFORM: f32 = 0.1;
/// Surfaces without a medium that a ray passes before its origin counts as outside.
const MAX_SURFACES: u32 = 64;

/// Media that emit, and the distribution of their power.
#[derive(Clone, Debug)]
pub(crate) struct MediumEmission {
    boxes: Vec<(MediumId, Bounds3)>,
    /// Over the cells of all boxes.
    cells: AliasTable,
    /// The medium outside of all surfaces.
    exterior: Option<MediumId>,
    /// The probability with which a subpath should start in a medium.
    pub share: f32,
}

/// The start of a subpath in a medium.
pub(crate) struct MediumStart {
    /// The ray.
    pub ray: Ray,
    /// The medium.
    pub medium: MediumId,
    /// Power over the density of the ray.
    pub beta: SampledSpectrum,
}

impl MediumEmission {
    /// Of the media of a scene; `None` if none emits.
    pub fn new(scene: &Scene, view: &View, control: &Control) -> Result<Option<Self>, Cancelled> {
        let whole = {
            let sphere = scene.sphere();
            let reach = Vec3::splat(sphere.radius);
            Bounds3::new(sphere.center - reach, sphere.center + reach)
        };
        let media = (0..).map(MediumId).zip(scene.media()).filter(|(_, medium)| medium.is_emissive());
        let boxes: Vec<_> = media.map(|(id, medium)| (id, medium.bounds().unwrap_or(whole))).collect();
        if boxes.is_empty() {
            return Ok(None);
        }
        let lambda = SampledWavelengths::sample_visible(0.5);
        let mean = |power: SampledSpectrum| power.safe_div(lambda.pdf()).average();
        let exterior = exterior(scene, view);
        let mut powers = Vec::with_capacity(CELLS * boxes.len());
        for (index, &(id, bounds)) in boxes.iter().enumerate() {
            for cell in 0..CELLS {
                control.check()?;
                let mut sum = 0.0;
                for point in 0..POINTS {
                    let words = |axis| [index as u32, cell as u32, point, axis];
                    let place = Vec3::from_array([0, 1, 2].map(|axis| hash_float(&words(axis))));
                    let p = place_in(bounds, cell, place);
                    if medium_at(scene, p, 0.0, exterior) == Some(id) {
                        let properties = scene.media()[id.0 as usize].at(p, &lambda);
                        sum += mean(properties.sigma_a * properties.le);
                    }
                }
                powers.push(4.0 * PI * volume(bounds) / CELLS as f32 * sum / POINTS as f32);
            }
        }
        let of_media: f32 = powers.iter().sum();
        let of_lights: f32 = scene.lights().powers(&lambda).map(mean).sum();
        let uniform = UNIFORM / (1.0 - UNIFORM) * of_media / powers.len() as f32;
        powers.iter_mut().for_each(|power| *power += uniform);
        let share = of_media / (of_media + of_lights);
        Ok(AliasTable::new(&powers).map(|cells| Self { boxes, cells, exterior, share }))
    }

    /// A subpath's start; `None` if nothing is emitted there. `u` chooses a cell, `place` a point
    /// of it.
    pub fn sample(
        &self,
        scene: &Scene,
        u: f32,
        place: Vec3,
        direction: Vec2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<MediumStart> {
        let chosen = self.cells.sample(u);
        let (medium, bounds) = self.boxes[chosen.index / CELLS];
        let p = place_in(bounds, chosen.index % CELLS, place);
        if medium_at(scene, p, time, self.exterior) != Some(medium) {
            return None;
        }
        let properties = scene.media()[medium.0 as usize].at(p, lambda);
        let density = chosen.pmf * CELLS as f32 / volume(bounds);
        let beta = properties.sigma_a * properties.le * (4.0 * PI / density);
        let ray = Ray::new(p, warp::sample_uniform_sphere(direction), time);
        (!beta.is_black()).then_some(MediumStart { ray, medium, beta })
    }
}

fn volume(bounds: Bounds3) -> f32 {
    let size = bounds.diagonal();
    size.x * size.y * size.z
}

/// The point of a cell of a box at coordinates in [0, 1)³.
fn place_in(bounds: Bounds3, cell: usize, place: Vec3) -> Point3 {
    let low = [cell % SIDE, cell / SIDE % SIDE, cell / (SIDE * SIDE)].map(|i| i as f32);
    bounds.min + bounds.diagonal() * ((Vec3::from_array(low) + place) / SIDE as f32)
}

/// A direction that is not parallel to what people build.
const AWAY: Vec3 = Vec3::new(0.36, 0.48, 0.8);

/// The medium at a point, by the first surface between media in some direction.
fn medium_at(scene: &Scene, p: Point3, time: f32, exterior: Option<MediumId>) -> Option<MediumId> {
    let mut ray = Ray::new(p, AWAY, time);
    for _ in 0..MAX_SURFACES {
        let Some((surface, _)) = scene.intersect(&ray, f32::INFINITY, &mut RayStats::default()) else {
            return exterior;
        };
        if let Some(media) = surface.media {
            return media.towards(-AWAY, surface.surface.n);
        }
        ray = surface.spawn_ray(AWAY);
    }
    exterior
}

/// The medium outside of all surfaces, by a ray from the camera.
fn exterior(scene: &Scene, view: &View) -> Option<MediumId> {
    let sample = CameraSample { film: Vec2::ZERO, lens: Vec2::splat(0.5), time: 0.5, filter_weight: 1.0 };
    let mut medium = view.medium;
    let Some(camera_ray) = view.camera.generate_ray(&sample) else { return medium };
    let mut ray = Ray::new(camera_ray.ray.o, AWAY, camera_ray.ray.time);
    for _ in 0..MAX_SURFACES {
        let Some((surface, _)) = scene.intersect(&ray, f32::INFINITY, &mut RayStats::default()) else {
            break;
        };
        medium = surface.medium_towards(AWAY, medium);
        ray = surface.spawn_ray(AWAY);
    }
    medium
}
