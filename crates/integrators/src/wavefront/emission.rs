//! Light that paths find: by hitting the lights of [`AreaLights`](super::area_lights::AreaLights),
//! and by leaving the scene.

use geometry::HitColumns;
use lanes::{Each, Int, Kernel, MAX_LANES, Mask, Real};
use math::{Vec2, Vector3};
use scene::Scene;
use scene::light::{ImageInfiniteLight, Light, LightId};
use spectrum::SampledSpectrum;

use super::indices::{HitIndices, Indices};
use super::pass::Pass;
use super::path_columns::PathColumns;
use super::queues::PathHit;
use super::segment_columns::SegmentColumns;
use crate::transport::direct::{DirectLighting, power_heuristic};

/// A hit of a light of the table.
pub(super) struct LightHit {
    pub place: PathHit,
    /// The light.
    pub light: u32,
}

/// Adds the emission of the lights that paths have hit, with the weights of
/// [`DirectLighting::emitted`](crate::transport::direct::DirectLighting::emitted).
pub(super) struct Emit<'a, 'b> {
    pub pass: Pass<'a>,
    pub direct: &'b DirectLighting,
    pub hits: &'b HitColumns,
    pub found: &'b [LightHit],
    pub segments: &'b SegmentColumns,
    pub paths: &'b mut PathColumns,
}

impl Kernel for Emit<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(mut self) {
        for found in self.found.chunks(R::LANES) {
            self.add::<R>(found);
        }
    }
}

impl Emit<'_, '_> {
    #[inline(always)]
    fn add<R: Real>(&mut self, found: &[LightHit]) {
        let [mut x, mut y] = [[0.0; MAX_LANES]; 2];
        let [mut queue, mut hit_indices, mut lights] = [[0; MAX_LANES]; 3];
        for (lane, &LightHit { place: PathHit { path, hit }, light }) in found.iter().enumerate() {
            let [u, v] = [&self.hits.uv[0], &self.hits.uv[1]].each(|column| column[hit as usize]);
            (x[lane], y[lane]) = (u, v);
            (queue[lane], hit_indices[lane], lights[lane]) = (path, hit, light);
        }
        let rows = Indices::<R>::first(&queue[..found.len()]);
        let hit_indices = Indices::<R>::first(&hit_indices[..found.len()]);
        let uv = Vec2::new(R::load(&x), R::load(&y));
        let lights = R::Int::load(&lights);

        let (Pass { area_lights, pixels, .. }, segments, paths) =
            (self.pass, self.segments, &mut *self.paths);
        let (table_rows, active) = area_lights.rows::<R>(lights, rows.active);
        let emitters = area_lights.emitters::<R>(table_rows);
        let lambda = paths.lambda_lanes(rows);
        let wo = -segments.direction.vector(hit_indices);
        let l = area_lights.radiance(pixels.scene, &emitters, emitters.shape.n, wo, &lambda, active);
        let is_lit = active & !l.is_black();

        let pdf = R::gather(&segments.pdf, hit_indices.indices);
        let is_weighted = is_lit & pdf.gt(R::zero());
        let mut weight = R::one();
        if is_weighted.any() {
            let context = segments.last_vertex(hit_indices);
            let pmf = self.direct.lights().pmf_lanes(&context, lights, is_weighted);
            let other = pmf * emitters.shape.pdf_from(&context, uv);
            weight = R::select(is_weighted, power_heuristic(pdf, other), weight);
        }
        let beta = segments.beta.get::<R>(hit_indices);
        let sum: SampledSpectrum<R> = paths.l.get(rows) + beta * (l * weight);
        paths.l.set(rows, is_lit, sum);
    }
}

/// Adds the radiance of infinite lights to the paths of a queue, which have left the scene, with
/// the weights of [`DirectLighting::escaped`](crate::transport::direct::DirectLighting::escaped).
pub(super) struct Escape<'a, 'b> {
    pub scene: &'a Scene,
    pub direct: &'a DirectLighting,
    /// The indices of their hits.
    pub queue: &'b [u32],
    pub segments: &'b SegmentColumns,
    pub paths: &'b mut PathColumns,
}

impl Escape<'_, '_> {
    /// Whether all infinite lights of a scene are computed in lanes.
    pub fn is_enough(scene: &Scene) -> bool {
        let mut lights = scene.infinite_lights().iter();
        lights.all(|&id| match scene.light(id).row() {
            Light::UniformInfinite(_) => true,
            Light::ImageInfinite(sky) => sky.is_at_rest(),
            _ => false,
        })
    }
}

impl Kernel for Escape<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Self { scene, direct, queue, segments, paths } = self;
        for queue in queue.chunks(R::LANES) {
            let hit_indices = Indices::<R>::first(queue);
            let indices = R::Int::gather(&segments.rows, hit_indices.indices);
            let rows = Indices { indices, active: hit_indices.active };
            let lambda = paths.lambda_lanes(rows);
            let w = segments.direction.vector(hit_indices);
            let mut l = SampledSpectrum::splat(R::zero());
            for &id in scene.infinite_lights() {
                match scene.light(id).row() {
                    // Light samples leave these lights out, so that their light counts fully.
                    Light::UniformInfinite(light) => l += light.radiance.sample(&lambda),
                    Light::ImageInfinite(sky) => {
                        let weight = sky_weight(direct, id, sky, segments, hit_indices, w);
                        l += sky.le_at_rest(w, &lambda) * weight;
                    }
                    _ => unreachable!("invariant: other lights are not infinite"),
                }
            }
            let sum: SampledSpectrum<R> = paths.l.get(rows) + segments.beta.get::<R>(hit_indices) * l;
            paths.l.set(rows, rows.active, sum);
        }
    }
}

/// The weights of the light of a sky that paths find along directions `w`.
#[inline(always)]
fn sky_weight<R: Real>(
    direct: &DirectLighting,
    LightId(id): LightId,
    sky: &ImageInfiniteLight,
    segments: &SegmentColumns,
    hit_indices: HitIndices<R>,
    w: Vector3<R>,
) -> R {
    let pdf = R::gather(&segments.pdf, hit_indices.indices);
    let is_weighted = hit_indices.active & pdf.gt(R::zero());
    if !is_weighted.any() {
        return R::one();
    }
    let pmf = direct.lights().pmf_lanes(&segments.last_vertex(hit_indices), R::Int::splat(id), is_weighted);
    R::select(is_weighted, power_heuristic(pdf, pmf * sky.pdf_at_rest(w, true)), R::one())
}
