//! Flights of path tracing through media.
//!
//! Flights are computed path by path, vertices in media (`medium_vertices.rs`) in lanes. Shadow
//! rays that nothing stops wait for their passage through media, which is computed one by one, too.

use geometry::HitColumns;
use scene::Interfaces;
use scene::medium::MediumId;

use super::batch::{Batch, BatchColumns};
use super::groups::Grouping;
use super::media::medium;
use super::medium_vertices::ScatterInMedia;
use super::segment_columns::SegmentColumns;
use super::shadows::Passages;
use crate::transport::ShadowRay;
use crate::transport::media::{Arrival, FlightEnd, Passage};
use crate::transport::path_state::PathState;
use crate::{Path, Tracer};

impl SegmentColumns {
    /// Changes the weights of a path that has passed its medium.
    fn pass(&mut self, hit_index: usize, path: &PathState) {
        self.beta.set_row(hit_index, path.beta);
        if let Some(origin) = &path.origin {
            self.pdf[hit_index] = origin.pdf;
        }
        if let (Some(media), Some(spectral)) = (&mut self.media, &path.spectral) {
            media.set(hit_index, path.medium, spectral);
        }
    }
}

impl Batch<'_> {
    /// Lets the paths in media fly to their hits. Those that are scattered before go on from there.
    pub(super) fn fly(&mut self, algorithm: &Path) {
        let Self { pass, sampler, stats, columns } = self;
        let pixels = pass.pixels;
        let BatchColumns { paths, segments, hits, medium_vertices, .. } = &mut **columns;
        medium_vertices.clear();
        for hit_index in 0..segments.rows.len() {
            if segments.media().medium(hit_index).is_none() {
                continue;
            }
            let mut path = segments.path(paths, hit_index);
            let at = segments.rows[hit_index] as usize;
            let lambda = paths.lambda(at);
            paths.resume(sampler, at, pixels.index);
            let mut tracer = Tracer::new(pixels.scene, pixels.view, pass.control, sampler, stats);
            let has_hit = hits.geometry[hit_index] != HitColumns::NONE;
            let t_max = if has_hit { hits.t[hit_index] } else { f32::INFINITY };
            let (l, end) = algorithm.fly(&mut tracer, &mut path, t_max, &lambda, true);
            paths.add_light(at, l);
            paths.dimension[at] = sampler.dimension();
            match end {
                FlightEnd::Passed => segments.pass(hit_index, &path),
                FlightEnd::Scattered { p, phase, .. } => {
                    segments.pass(hit_index, &path);
                    medium_vertices.push(hit_index, p, phase);
                    hits.geometry[hit_index] = Grouping::GONE;
                }
                FlightEnd::Absorbed => hits.geometry[hit_index] = Grouping::GONE,
            }
        }
        if !self.columns.medium_vertices.is_empty() {
            self.scatter_in_media(algorithm);
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
                let shadow = ShadowRay { ray: rays.ray(shadow), t_max: rays.t_max(shadow) };
                if meets_interfaces {
                    tracer.passage(&shadow, medium, &lambda, &heroes, numbers)
                } else {
                    tracer.passage_within(&shadow, medium, &lambda, &heroes, numbers)
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
