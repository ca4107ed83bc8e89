//! Paths through media.
//!
//! Flights are computed path by path, vertices in media (`medium_vertices.rs`) and on surfaces in
//! lanes. Shadow rays that nothing stops wait for their passage through media, which is computed one
//! by one, too.
//!
//! Densities are divided by the mean of r_u ([`Throughput`]): β is then the estimate itself, and the
//! density of a path's ray is 1 over the mean of r_l, so that stages that meet lights need not know
//! of media.

use film::FirstEvent;
use geometry::HitColumns;
use lanes::{Int, Mask, Real};
use math::{Normal3, Vector3};
use scene::material::Material;
use scene::medium::{MediumId, MediumInterface};
use scene::{Interfaces, Scene};
use spectrum::SampledSpectrum;

use super::batch::{Batch, BatchColumns};
use super::columns::{Column, Rows};
use super::groups::Grouping;
use super::medium_vertices::ScatterInMedia;
use super::paths::Paths;
use super::queues::{Shadow, ShadowRays};
use super::segments::Segments;
use super::spectra::Spectra;
use crate::camera_paths::{Flown, PathInMedia};
use crate::transport::media::{Arrival, Passage, Throughput};
use crate::transport::path_state::{Origin, PathState};
use crate::{Path, Tracer, VolPath};

/// The media of a scene, as lanes look them up.
#[derive(Clone, Debug, Default)]
pub(super) struct LaneMedia {
    /// For each geometry the media inside and outside of it, or [`SAME`](Self::SAME).
    sides: Vec<[u32; 2]>,
    /// Whether there are interfaces, which shadow rays pass.
    has_interfaces: bool,
}

impl LaneMedia {
    /// In place of media that do not change at a surface.
    const SAME: u32 = u32::MAX;

    pub fn new(scene: &Scene) -> Self {
        let sides = scene.geometries().iter().map(|entry| {
            let media = entry.media.filter(MediumInterface::is_transition);
            media.map_or([Self::SAME; 2], |media| [media.inside, media.outside].map(number))
        });
        let is_interface =
            |entry: &scene::material::MaterialEntry| matches!(entry.material, Material::Interface);
        Self { sides: sides.collect(), has_interfaces: scene.materials().iter().any(is_interface) }
    }
}

/// A medium as a number: 0 is empty space.
fn number(medium: Option<MediumId>) -> u32 {
    medium.map_or(0, |MediumId(id)| id + 1)
}

/// The medium of a number.
fn medium(number: u32) -> Option<MediumId> {
    number.checked_sub(1).map(MediumId)
}

/// What [`Segments`] have besides where there are media.
#[derive(Default)]
pub(super) struct MediaColumns {
    /// The media of the rays, as numbers.
    medium: Vec<u32>,
    /// As of [`Throughput`].
    r_u: Spectra,
    r_l: Spectra,
}

impl MediaColumns {
    /// Makes room for as many paths, whatever they have.
    pub fn grow(&mut self, len: usize) {
        self.medium.resize(len, 0);
        self.r_u.grow(len);
        self.r_l.grow(len);
    }

    /// Lets all paths begin in a medium.
    pub fn begin_in(&mut self, medium: Option<MediumId>) {
        let len = self.medium.len();
        self.medium.fill(number(medium));
        self.r_u.fill(len, 1.0);
        self.r_l.fill(len, 1.0);
    }

    /// Copies a path.
    pub fn copy(&mut self, turn: usize, from: &Self, from_turn: usize) {
        self.medium[turn] = from.medium[from_turn];
        self.r_u.set_row(turn, from.r_u.row(from_turn));
        self.r_l.set_row(turn, from.r_l.row(from_turn));
    }

    fn set(&mut self, turn: usize, path: &PathInMedia) {
        let density = path.heroes.mean(path.throughput.r_u);
        self.medium[turn] = number(path.medium);
        self.r_u.set_row(turn, path.throughput.r_u / density);
        self.r_l.set_row(turn, path.throughput.r_l / density);
    }

    /// The media of paths, and r_u.
    #[inline(always)]
    pub fn at<R: Real>(&self, turns: Rows<R>) -> (R::Int, SampledSpectrum<R>) {
        (R::Int::gather(&self.medium, turns.indices), self.r_u.get(turns))
    }

    /// Changes successive paths to those of a mask's lanes.
    #[inline(always)]
    pub fn compress<R: Real>(&mut self, turn: usize, mask: R::Mask, segment: &SegmentInMedia<R>) {
        segment.medium.compress(mask, &mut self.medium[turn..]);
        self.r_u.compress(turn, mask, segment.r_u);
        self.r_l.compress(turn, mask, segment.r_l);
    }
}

/// What a segment in lanes has besides.
pub(super) struct SegmentInMedia<R: Real> {
    pub medium: R::Int,
    pub r_u: SampledSpectrum<R>,
    pub r_l: SampledSpectrum<R>,
}

/// Vertices in lanes, where there are media.
#[derive(Clone, Copy)]
pub(super) struct VerticesInMedia<R: Real> {
    /// The media on the two sides of the surface.
    inside: R::Int,
    outside: R::Int,
    /// Density of the path up to the vertex at each wavelength.
    pub r_u: SampledSpectrum<R>,
}

impl<R: Real> VerticesInMedia<R> {
    /// At hits of geometries. Where dispersion has `terminated` the other wavelengths, the first
    /// goes on alone.
    #[inline(always)]
    pub fn new(
        media: &LaneMedia,
        columns: &MediaColumns,
        (turns, geometries): (Rows<R>, &[u32]),
        terminated: R::Mask,
    ) -> Self {
        let (before, r_u) = columns.at(turns);
        let geometry = R::Int::gather(geometries, turns.indices);
        let [inside, outside] = R::Int::gather_rows(media.sides.as_flattened(), geometry.shl(1));
        let is_same = inside.eq(R::Int::splat(LaneMedia::SAME));
        Self {
            inside: R::Int::select(is_same, before, inside),
            outside: R::Int::select(is_same, before, outside),
            r_u: SampledSpectrum::select(terminated, SampledSpectrum::splat(R::one()), r_u),
        }
    }

    /// The media of rays that leave along `w` surfaces with normals `n`.
    #[inline(always)]
    pub fn towards(&self, w: Vector3<R>, n: Normal3<R>) -> R::Int {
        R::Int::select(w.dot(n).gt(R::zero()), self.outside, self.inside)
    }

    /// What segments that leave along `wi` have, in directions of the density `pdf`.
    #[inline(always)]
    pub fn leave(&self, (wi, n): (Vector3<R>, Normal3<R>), pdf: R) -> SegmentInMedia<R> {
        SegmentInMedia { medium: self.towards(wi, n), r_u: self.r_u, r_l: self.r_u / pdf }
    }
}

/// Shadow rays in scenes with media.
#[derive(Default)]
pub(super) struct Passages {
    /// The rays, and the light of [`Arrival`].
    shadows: ShadowRays,
    /// As of [`Arrival`].
    r_u: Spectra,
    ratio: Column,
    /// The media where they leave their vertices, as numbers.
    medium: Vec<u32>,
    /// The dimension of their random numbers.
    dimension: Vec<u32>,
}

/// Shadow rays in lanes.
pub(super) struct PassageLanes<R: Real> {
    pub r_u: SampledSpectrum<R>,
    pub ratio: R,
    pub medium: R::Int,
    pub dimension: R::Int,
}

impl Passages {
    /// Adds the rays of a mask's lanes.
    #[inline(always)]
    pub fn append<R: Real>(
        &mut self,
        rows: Rows<R>,
        mask: R::Mask,
        shadow: &Shadow<R>,
        lanes: &PassageLanes<R>,
    ) {
        if !mask.any() {
            return;
        }
        self.shadows.append(rows, mask, shadow);
        self.r_u.append(mask, lanes.r_u);
        lanes.ratio.append(mask, &mut self.ratio);
        lanes.medium.append(mask, &mut self.medium);
        lanes.dimension.append(mask, &mut self.dimension);
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.shadows.paths.is_empty()
    }

    fn clear(&mut self) {
        self.shadows.clear();
        self.r_u.clear();
        self.ratio.clear();
        [&mut self.medium, &mut self.dimension].into_iter().for_each(Vec::clear);
    }
}

impl Segments {
    /// What the paths of an algorithm that knows media have besides.
    pub fn media(&self) -> &MediaColumns {
        self.media.as_ref().expect("invariant: the algorithm knows media")
    }

    fn media_mut(&mut self) -> &mut MediaColumns {
        self.media.as_mut().expect("invariant: the algorithm knows media")
    }

    /// A path that has media.
    fn path_in_media(&self, paths: &Paths, turn: usize) -> PathInMedia {
        let row = self.rows[turn] as usize;
        let media = self.media();
        let PathState { ray, beta, depth, origin, eta_scale, .. } = self.state(turn);
        PathInMedia {
            ray,
            medium: medium(media.medium[turn]),
            throughput: Throughput { beta, r_u: media.r_u.row(turn), r_l: media.r_l.row(turn) },
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
            if segments.media().medium[turn] == 0 {
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
        self.pass.instruction_set.dispatch(ScatterInMedia {
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
    pub(super) fn shade_in_media(
        &mut self,
        algorithm: &VolPath,
        (row, turn): (u32, u32),
        hit: &geometry::Hit,
    ) {
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
