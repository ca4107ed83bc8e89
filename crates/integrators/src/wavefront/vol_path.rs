//! The hits of path tracing through media.
//!
//! Flights are computed path by path, vertices in media (`medium_vertices.rs`) and on surfaces in
//! lanes. Shadow rays that nothing stops wait for their passage through media, which is computed
//! one by one, too.

use film::FirstEvent;
use geometry::{Hit, HitColumns};
use scene::Interfaces;
use scene::medium::MediumId;
use spectrum::SampledSpectrum;

use super::WaveIntegrator;
use super::batch::{Batch, BatchColumns};
use super::groups::Grouping;
use super::media::medium;
use super::medium_vertices::ScatterInMedia;
use super::paths::Paths;
use super::segments::Segments;
use super::shadows::Passages;
use super::stage::Algorithm;
use crate::camera_paths::{Flown, PathInMedia};
use crate::transport::media::{Arrival, Passage, Throughput};
use crate::transport::path_state::{Origin, PathState};
use crate::{Path, Tracer, VolPath};

impl WaveIntegrator for VolPath {
    const KNOWS_MEDIA: bool = true;

    fn shade(&self, batch: &mut Batch) {
        let surfaces = &self.in_vacuum;
        batch.fly(self);
        batch.classify(surfaces.settings.max_depth, &surfaces.direct);
        batch.shade_in_lanes(Algorithm::Path(surfaces));
        batch.shade_others(|batch, place, hit| batch.shade_in_media(self, place, hit));
    }
}

impl Segments {
    /// A path that has media.
    fn path_in_media(&self, paths: &Paths, turn: usize) -> PathInMedia {
        let row = self.rows[turn] as usize;
        let PathState { ray, beta, depth, origin, eta_scale, .. } = self.state(turn);
        PathInMedia {
            ray,
            medium: self.media().medium(turn),
            throughput: self.media().throughput(turn, beta),
            heroes: paths.heroes(row),
            depth,
            origin: origin.map(|origin| origin.context),
            eta_scale,
            rough_before: paths.rough_before[row],
            first: FirstEvent::None,
        }
    }

    /// Appends a path that has media.
    fn push_in_media(&mut self, row: u32, path: &PathInMedia) {
        let turn = self.rows.len();
        let (beta, pdf) = weight_and_pdf(path);
        let &PathInMedia { ray, medium, depth, eta_scale, first, .. } = path;
        let origin = path.origin.map(|context| Origin { context, pdf });
        self.push(row, &PathState { ray, beta, depth, origin, medium, eta_scale, first });
        self.media_mut().set(turn, path);
    }

    /// Changes the weights of a path that has passed its medium.
    fn pass(&mut self, turn: usize, path: &PathInMedia) {
        let (beta, pdf) = weight_and_pdf(path);
        self.beta.set_row(turn, beta);
        if path.origin.is_some() {
            self.pdf[turn] = pdf;
        }
        self.media_mut().set(turn, path);
    }
}

/// The estimate β, and the density of the ray's direction.
fn weight_and_pdf(path: &PathInMedia) -> (SampledSpectrum, f32) {
    let Throughput { beta, r_u, r_l } = path.throughput;
    let density = path.heroes.mean(r_u);
    (beta / density, density / path.heroes.mean(r_l))
}

impl Batch<'_> {
    /// Lets the paths in media fly to their hits. Those that are scattered before go on from there.
    pub(super) fn fly(&mut self, algorithm: &VolPath) {
        let Self { pass, sampler, stats, columns } = self;
        let pixels = pass.pixels;
        let BatchColumns { paths, segments, hits, medium_vertices, .. } = &mut **columns;
        medium_vertices.clear();
        for turn in 0..segments.rows.len() {
            if segments.media().medium(turn).is_none() {
                continue;
            }
            let mut path = segments.path_in_media(paths, turn);
            let at = segments.rows[turn] as usize;
            let lambda = paths.lambda(at);
            paths.resume(sampler, at, pixels.index);
            let mut tracer = Tracer::new(pixels.scene, pixels.view, pass.control, sampler, stats);
            let has_hit = hits.geometry[turn] != HitColumns::NONE;
            let t_max = if has_hit { hits.t[turn] } else { f32::INFINITY };
            let (l, flown) = algorithm.fly(0, &mut tracer, &mut path, t_max, &lambda);
            paths.add_light(at, l);
            paths.dimension[at] = sampler.dimension();
            match flown {
                Flown::Passed => segments.pass(turn, &path),
                Flown::Scattered(p, phase) => {
                    segments.pass(turn, &path);
                    medium_vertices.push(turn, p, phase);
                    hits.geometry[turn] = Grouping::GONE;
                }
                Flown::Ended => hits.geometry[turn] = Grouping::GONE,
            }
        }
        if !self.columns.medium_vertices.is_empty() {
            self.scatter_in_media(&algorithm.in_vacuum);
        }
    }

    /// Scatters the paths at their vertices in media.
    fn scatter_in_media(&mut self, algorithm: &Path) {
        let BatchColumns { medium_vertices, segments, paths, queues, light_samples, .. } = &mut *self.columns;
        self.pass.instruction_set.dispatch_large(ScatterInMedia {
            pass: self.pass,
            algorithm,
            vertices: medium_vertices,
            segments,
            paths,
            queues,
            light_samples,
        });
    }

    /// Shades the hit of a path that is not shaded in lanes.
    pub(super) fn shade_in_media(&mut self, algorithm: &VolPath, (row, turn): (u32, u32), hit: &Hit) {
        let Self { pass, sampler, stats, columns } = self;
        let pixels = pass.pixels;
        let BatchColumns { paths, segments, queues, .. } = &mut **columns;
        let mut path = segments.path_in_media(paths, turn as usize);
        let at = row as usize;
        let mut lambda = paths.lambda(at);
        let scene = pixels.scene;
        let surface = scene.interaction(hit, scene.world().surface(&path.ray.ray, hit));
        paths.resume(sampler, at, pixels.index);
        let mut tracer = Tracer::new(scene, pixels.view, pass.control, sampler, stats);
        if surface.area_light.is_some_and(|light| !pass.area_lights.contains(light)) {
            paths.add_light(at, algorithm.emitted(&mut tracer, &path, &surface, &lambda));
        }
        let (l, goes_on) = algorithm.scatter(&mut tracer, &mut path, (surface, hit.t), &mut lambda);
        paths.add_light(at, l);
        paths.set_lambda(at, &lambda);
        paths.dimension[at] = sampler.dimension();
        if goes_on {
            paths.rough_before[at] = path.rough_before;
            queues.next.push_in_media(row, &path);
        }
    }

    /// Traces the shadow rays that pass media.
    pub(super) fn connect_through_media(&mut self) {
        let Self { pass, sampler, stats, columns } = self;
        let BatchColumns { queues, paths, occluded, .. } = &mut **columns;
        let Passages { shadows, r_u, ratio, medium: media, dimension } = &queues.passages;
        let (pixels, rays) = (pass.pixels, shadows.rays.columns());
        let mut trace = |interfaces| {
            let mut stopped = std::mem::take(occluded);
            stopped.clear();
            stopped.resize(shadows.paths.len(), false);
            pixels.scene.occluded_batch(rays, interfaces, &mut stopped, stats);
            stopped
        };
        let stopped = trace(Interfaces::Stop);
        let occluded = if pass.media.has_interfaces { trace(Interfaces::Pass) } else { Vec::new() };
        for (shadow, &row) in shadows.paths.iter().enumerate() {
            let meets_interfaces = stopped[shadow];
            if meets_interfaces && occluded.get(shadow).is_none_or(|&occluded| occluded) {
                continue;
            }
            let at = row as usize;
            let medium = medium(media[shadow]);
            let heroes = paths.heroes(at);
            let passage = if medium.is_none() && !meets_interfaces {
                Some(Passage::CLEAR)
            } else {
                let lambda = paths.lambda(at);
                sampler.start_pixel_sample(paths.pixel(at), pixels.index, dimension[shadow]);
                let mut tracer = Tracer::new(pixels.scene, pixels.view, pass.control, sampler, stats);
                let varies = medium.is_some_and(|MediumId(id)| pixels.scene.media()[id as usize].varies());
                // Within homogeneous media no collisions are chosen.
                let numbers = if meets_interfaces || varies { tracer.two_numbers() } else { [0.0; 2] };
                let (ray, t_max) = (rays.ray(shadow), rays.t_max(shadow));
                if meets_interfaces {
                    tracer.transmittance((&ray, t_max), medium, &lambda, &heroes, numbers)
                } else {
                    tracer.transmittance_within((&ray, t_max), medium, &lambda, &heroes, numbers)
                }
            };
            if let Some(passage) = passage {
                let arrival =
                    Arrival { l: shadows.l.row(shadow), r_u: r_u.row(shadow), ratio: ratio[shadow] };
                paths.add_light(at, arrival.through(&passage, &heroes));
            }
        }
        columns.occluded = stopped;
        columns.queues.passages.clear();
    }
}
