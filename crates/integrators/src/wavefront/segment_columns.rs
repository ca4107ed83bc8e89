//! Paths between two vertices, in columns, in the order of their rays.
//!
//! The state that changes at each vertex is here, and is appended to the columns of the next wave;
//! [`PathColumns`](super::path_columns::PathColumns) has the rest. So rays are read, and paths
//! written, without gathers and scatters, which take several times as long.

use geometry::{PatchPoints, RayColumns};
use lanes::{Each, Int, MAX_LANES, Mask, Real};
use math::{CameraEnd, Differentials, Point3Error, Ray, RayDifferential, Vec3};
use scene::light::LightSampleContext;
use scene::medium::MediumId;
use scene::{Footprint, View};
use spectrum::SampledSpectrum;

use super::float_columns::{FloatColumn, FloatColumns, fill, grow};
use super::indices::HitIndices;
use super::media::{MediaColumns, SegmentInMedia};
use super::path_columns::PathColumns;
use super::spectrum_column::SpectrumColumn;
use crate::transport::path_state::{Origin, PathState};

/// The paths of a wave, of which each has a ray. Columns are longer, so that a vector can begin at
/// any of them.
#[derive(Default)]
pub(super) struct SegmentColumns {
    /// The row of each path.
    pub rows: Vec<u32>,
    /// Where the camera is on all rays: only those of the first wave begin there.
    pub camera: CameraEnd,
    /// Shutter time, the same for all rays of a path.
    pub time: FloatColumn,
    /// Origin of the ray to the next vertex.
    pub origin: FloatColumns<3>,
    /// Its direction.
    pub direction: FloatColumns<3>,
    /// Its differentials: of the rays to the right and down, origin and direction each.
    pub differentials: FloatColumns<12>,
    /// 1 for paths that have differentials, else 0; empty where nothing needs them.
    pub are_differentials: Vec<u32>,
    /// Path throughput.
    pub beta: SpectrumColumn,
    /// The product of η² over the refractions.
    pub eta_scale: FloatColumn,
    /// Scattering events so far.
    pub depth: Vec<u32>,
    /// The last vertex: position, its error, geometric and shading normal.
    pub vertex: [FloatColumns<3>; 4],
    /// The density of the ray's direction at that vertex; 0 after specular scattering.
    pub pdf: FloatColumn,
    /// Where there are media.
    pub media: Option<MediaColumns>,
}

/// The columns that only some algorithms and scenes need.
#[derive(Clone, Copy)]
pub(super) struct OptionalColumns {
    pub differentials: bool,
    pub media: bool,
}

/// Segments in lanes, without differentials.
pub(super) struct Segment<R: Real> {
    pub ray: Ray<R>,
    pub beta: SampledSpectrum<R>,
    pub eta_scale: R,
    pub depth: R::Int,
    pub vertex: LightSampleContext<R>,
    pub pdf: R,
    pub media: Option<SegmentInMedia<R>>,
}

impl SegmentColumns {
    /// Makes room for as many paths, and has none.
    pub fn start(&mut self, count: usize, optional: OptionalColumns) {
        let len = count + MAX_LANES;
        self.rows.clear();
        self.camera = CameraEnd::Neither;
        [&mut self.time, &mut self.eta_scale, &mut self.pdf].into_iter().for_each(|column| grow(column, len));
        [&mut self.origin, &mut self.direction].into_iter().for_each(|columns| columns.grow(len));
        self.vertex.iter_mut().for_each(|columns| columns.grow(len));
        self.beta.grow(len);
        self.depth.resize(len, 0);
        fill(&mut self.are_differentials, if optional.differentials { len } else { 0 }, 0);
        self.differentials.grow(self.are_differentials.len());
        match optional.media {
            true => self.media.get_or_insert_default().grow(len),
            false => self.media = None,
        }
    }

    /// Has one camera ray for each row below `count`, which has no numbers yet, and is not
    /// scattered.
    pub fn start_from_camera(&mut self, count: usize, optional: OptionalColumns, medium: Option<MediumId>) {
        self.start(count, optional);
        self.camera = CameraEnd::Origin;
        self.rows.extend(0..count as u32);
        self.beta.fill(count + MAX_LANES, 1.0);
        fill(&mut self.eta_scale, count + MAX_LANES, 1.0);
        fill(&mut self.depth, count + MAX_LANES, 0);
        fill(&mut self.pdf, count + MAX_LANES, 0.0);
        self.media.iter_mut().for_each(|media| media.begin_in(medium));
    }

    /// Whether a path has ray differentials.
    #[inline]
    pub fn has_differentials(&self, hit_index: u32) -> bool {
        self.are_differentials.get(hit_index as usize).is_some_and(|&is| is == 1)
    }

    /// The rays.
    pub fn rays(&self) -> RayColumns<'_> {
        let (o, d) = (self.origin.slices(), self.direction.slices());
        RayColumns { len: self.rows.len(), o, d, time: &self.time, t_max: None, camera: self.camera }
    }

    /// The ray of a path.
    #[inline]
    pub fn ray(&self, hit_index: usize) -> Ray {
        let [o, d] = [&self.origin, &self.direction].each(|columns| Vec3::from_array(columns.row(hit_index)));
        Ray { camera: self.camera, ..Ray::new(o, d, self.time[hit_index]) }
    }

    /// A path, with what the batch has of it.
    #[inline]
    pub fn path(&self, paths: &PathColumns, hit_index: usize) -> PathState {
        let row = self.rows[hit_index] as usize;
        PathState {
            medium: self.media.as_ref().and_then(|media| media.medium(hit_index)),
            rough_before: paths.rough_before[row],
            spectral: self.media.as_ref().map(|media| media.spectral(hit_index, paths.heroes(row))),
            ..self.state(hit_index)
        }
    }

    /// A path without that.
    #[inline]
    pub fn state(&self, hit_index: usize) -> PathState {
        let has_differentials = self.has_differentials(hit_index as u32);
        let differentials = has_differentials.then(|| differentials_of(self.differentials.row(hit_index)));
        let [p, error, n, ns] = [0, 1, 2, 3].each(|i: usize| Vec3::from_array(self.vertex[i].row(hit_index)));
        let context = LightSampleContext { p: Point3Error::new(p, error), n, ns, time: self.time[hit_index] };
        let pdf = self.pdf[hit_index];
        PathState {
            beta: self.beta.row(hit_index),
            origin: (pdf > 0.0).then_some(Origin { context, pdf }),
            eta_scale: self.eta_scale[hit_index],
            ..PathState::new(
                RayDifferential { ray: self.ray(hit_index), differentials },
                self.depth[hit_index],
            )
        }
    }

    /// Appends a path.
    pub fn push(&mut self, row: u32, state: &PathState) {
        let hit_index = self.rows.len();
        self.rows.push(row);
        let RayDifferential { ray, differentials } = state.ray;
        self.time[hit_index] = ray.time;
        self.origin.set_row(hit_index, ray.o.to_array());
        self.direction.set_row(hit_index, ray.d.to_array());
        self.set_differentials(hit_index, differentials.as_ref());
        self.beta.set_row(hit_index, state.beta);
        self.depth[hit_index] = state.depth;
        self.eta_scale[hit_index] = state.eta_scale;
        self.pdf[hit_index] = 0.0;
        if let Some(Origin { context, pdf }) = &state.origin {
            self.pdf[hit_index] = *pdf;
            let vectors = [context.p.p, context.p.error, context.n, context.ns];
            self.vertex
                .iter_mut()
                .zip(vectors)
                .for_each(|(columns, v)| columns.set_row(hit_index, v.to_array()));
        }
        if let (Some(media), Some(spectral)) = (&mut self.media, &state.spectral) {
            media.set(hit_index, state.medium, spectral);
        }
    }

    /// Changes the differentials of a ray.
    #[inline]
    pub fn set_differentials(&mut self, hit_index: usize, differentials: Option<&Differentials>) {
        if let Some(is) = self.are_differentials.get_mut(hit_index) {
            *is = differentials.is_some().into();
        }
        if let Some(differentials) = differentials {
            self.differentials.set_row(hit_index, numbers_of(differentials));
        }
    }

    /// What the paths of an algorithm that knows media have besides.
    #[inline]
    pub fn media(&self) -> &MediaColumns {
        self.media.as_ref().expect("invariant: the algorithm knows media")
    }

    /// Appends a path of others.
    pub fn push_from(&mut self, others: &Self, from: usize) {
        let hit_index = self.rows.len();
        self.push(others.rows[from], &others.state(from));
        if let (Some(media), Some(others)) = (&mut self.media, &others.media) {
            media.copy(hit_index, others, from);
        }
    }

    /// Appends the paths of a mask's lanes, without differentials.
    #[inline(always)]
    pub fn append<R: Real>(&mut self, rows: R::Int, mask: R::Mask, segment: &Segment<R>) {
        let hit_index = self.rows.len();
        let Segment { ray, beta, eta_scale, depth, vertex, pdf, media } = segment;
        self.origin.compress(hit_index, mask, ray.o.to_array());
        self.direction.compress(hit_index, mask, ray.d.to_array());
        self.beta.compress(hit_index, mask, *beta);
        let vectors = [vertex.p.p, vertex.p.error, vertex.n, vertex.ns];
        for (i, v) in vectors.iter().enumerate() {
            self.vertex[i].compress(hit_index, mask, v.to_array());
        }
        ray.time.compress(mask, &mut self.time[hit_index..]);
        eta_scale.compress(mask, &mut self.eta_scale[hit_index..]);
        pdf.compress(mask, &mut self.pdf[hit_index..]);
        depth.compress(mask, &mut self.depth[hit_index..]);
        if !self.are_differentials.is_empty() {
            R::Int::splat(0).store(&mut self.are_differentials[hit_index..]);
        }
        if let (Some(columns), Some(media)) = (&mut self.media, media) {
            columns.compress(hit_index, mask, media);
        }
        rows.append(mask, &mut self.rows);
    }

    /// The last vertices of paths.
    #[inline(always)]
    pub fn last_vertex<R: Real>(&self, hit_indices: HitIndices<R>) -> LightSampleContext<R> {
        let [p, error, n, ns] = &self.vertex;
        let p = Point3Error::new(p.vector(hit_indices), error.vector(hit_indices));
        let time = R::gather(&self.time, hit_indices.indices);
        LightSampleContext { p, n: n.vector(hit_indices), ns: ns.vector(hit_indices), time }
    }

    /// The footprints of pixels of a view at the surface points that paths have hit.
    #[inline(always)]
    pub fn footprint<R: Real>(
        &self,
        view: &View,
        hit_indices: HitIndices<R>,
        surface: &PatchPoints<R>,
    ) -> Footprint<R> {
        let PatchPoints { p, n, dpdu, dpdv, .. } = *surface;
        let time = R::gather(&self.time, hit_indices.indices);
        let is = R::Int::gather(&self.are_differentials, hit_indices.indices).eq(R::Int::splat(1));
        let across = if is.any() {
            let differentials = differentials_of(self.differentials.get(hit_indices));
            view.pixel_on_plane(Some((&differentials, is)), p.p, n, time)
        } else {
            view.pixel_on_plane(None, p.p, n, time)
        };
        Footprint::new(across, [dpdu, dpdv])
    }
}

/// The numbers of differentials.
#[inline(always)]
pub(super) fn numbers_of<R: Real>(differentials: &Differentials<R>) -> [R; 12] {
    let Differentials { rx_origin: a, rx_direction: b, ry_origin: c, ry_direction: d } = differentials;
    [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z]
}

/// The differentials of these numbers.
#[inline(always)]
fn differentials_of<R: Real>(numbers: [R; 12]) -> Differentials<R> {
    let [ax, ay, az, bx, by, bz, cx, cy, cz, dx, dy, dz] = numbers;
    Differentials {
        rx_origin: Vec3::new(ax, ay, az),
        rx_direction: Vec3::new(bx, by, bz),
        ry_origin: Vec3::new(cx, cy, cz),
        ry_direction: Vec3::new(dx, dy, dz),
    }
}
