//! The paths of a batch, in columns.

use film::FirstEvent;
use geometry::RayColumns;
use lanes::{Int, MAX_LANES, Real};
use math::{Bounds2i, Differentials, Point3Error, Ray, RayDifferential, Vec3};
use sampling::Sampler;
use sampling::sampler::Address;
use scene::light::LightSampleContext;
use spectrum::{N, SampledSpectrum, SampledWavelengths};

use super::columns::{Column, Columns, Rows, fill, grow};
use crate::transport::path_state::{Origin, PathState};

/// The paths of a batch; a path is a row. Columns are longer, so that a vector can begin at any
/// row.
#[derive(Default)]
pub(super) struct Paths {
    count: usize,
    /// Column and row of the pixel.
    pub pixel: [Vec<u32>; 2],
    /// Weight of the sample in the pixel.
    pub filter_weight: Column,
    /// The share of the light along its camera ray that reaches the film; empty where all of it
    /// does.
    pub camera_weight: Column,
    /// The sampler's next dimension.
    pub dimension: Vec<u32>,
    /// Wavelengths, and their densities.
    pub wavelengths: Columns<{ 2 * N }>,
    /// Shutter time, the same for all rays of a path.
    pub time: Column,
    /// Origin of the ray to the next vertex.
    pub origin: Columns<3>,
    /// Its direction.
    pub direction: Columns<3>,
    /// Its differentials: of the rays to the right and down, origin and direction each.
    pub differentials: Columns<12>,
    /// 1 for paths that have differentials, else 0; empty where nothing needs them.
    pub are_differentials: Vec<u32>,
    /// Path throughput.
    pub beta: Columns<N>,
    /// The light so far.
    pub l: Columns<N>,
    /// The product of η² over the refractions.
    pub eta_scale: Column,
    /// Scattering events so far.
    pub depth: Vec<u32>,
    /// Whether a rough surface scattered it before.
    pub rough_before: Vec<bool>,
    /// The last vertex: position, its error, geometric and shading normal.
    pub vertex: [Columns<3>; 4],
    /// The density of the ray's direction at that vertex; 0 after specular scattering.
    pub pdf: Column,
}

impl Paths {
    /// The number of paths.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Replaces all paths by one for each pixel of the rectangles, row by row, which have no
    /// wavelengths, weights and rays yet.
    pub fn start(
        &mut self,
        pixels: impl Iterator<Item = Bounds2i>,
        with_differentials: bool,
        with_weights: bool,
    ) {
        let [x, y] = &mut self.pixel;
        x.clear();
        y.clear();
        for Bounds2i { min, max } in pixels {
            for row in min[1]..max[1] {
                x.extend((min[0]..max[0]).map(|x| x as u32));
                y.resize(x.len(), row as u32);
            }
        }
        self.count = x.len();
        // Lanes load and store whole vectors.
        let rows = self.count + MAX_LANES;
        x.resize(rows, 0);
        y.resize(rows, 0);
        [&mut self.filter_weight, &mut self.time].into_iter().for_each(|column| grow(column, rows));
        fill(&mut self.camera_weight, if with_weights { rows } else { 0 }, 0.0);
        self.dimension.resize(rows, 0);
        self.wavelengths.grow(rows);
        [&mut self.origin, &mut self.direction].into_iter().for_each(|columns| columns.grow(rows));
        self.vertex.iter_mut().for_each(|columns| columns.grow(rows));
        fill(&mut self.are_differentials, if with_differentials { rows } else { 0 }, 0);
        self.differentials.grow(self.are_differentials.len());
        self.beta.fill(rows, 1.0);
        self.l.fill(rows, 0.0);
        fill(&mut self.eta_scale, rows, 1.0);
        fill(&mut self.depth, rows, 0);
        fill(&mut self.rough_before, rows, false);
        fill(&mut self.pdf, rows, 0.0);
    }

    /// Whether a path has ray differentials.
    #[inline]
    pub fn has_differentials(&self, row: u32) -> bool {
        self.are_differentials.get(row as usize).is_some_and(|&is| is == 1)
    }

    /// The ray of a path.
    #[inline]
    pub fn ray(&self, row: usize) -> Ray {
        let [o, d] = [&self.origin, &self.direction].map(|columns| Vec3::from_array(columns.row(row)));
        Ray::new(o, d, self.time[row])
    }

    /// Changes the ray of a path.
    pub fn set_ray(&mut self, row: usize, ray: &Ray) {
        self.origin.set_row(row, ray.o.to_array());
        self.direction.set_row(row, ray.d.to_array());
    }

    /// The rays of paths.
    pub fn rays<'a>(&'a self, rows: &'a [u32]) -> RayColumns<'a> {
        let (o, d) = (self.origin.slices(), self.direction.slices());
        RayColumns { o, d, time: &self.time, t_max: None, rows }
    }

    /// The next address of the sampler of each path, at the sample of an index.
    #[inline(always)]
    pub fn address<R: Real>(&self, rows: Rows<R>, index: u32) -> Address<R::Int> {
        let [x, y] = &self.pixel;
        Address {
            pixel: [R::Int::gather(x, rows.indices), R::Int::gather(y, rows.indices)],
            index,
            dimension: R::Int::gather(&self.dimension, rows.indices),
        }
    }

    /// Lets a sampler go on with a path, at the sample of an index.
    pub fn resume(&self, sampler: &mut Sampler, row: usize, index: u32) {
        let pixel = self.pixel.each_ref().map(|column| column[row] as i32);
        sampler.start_pixel_sample(pixel, index, self.dimension[row]);
    }

    /// The wavelengths of paths in lanes.
    #[inline(always)]
    pub fn lambda_lanes<R: Real>(&self, rows: Rows<R>) -> SampledWavelengths<R> {
        let [a, b, c, d, pdf @ ..] = self.wavelengths.get(rows);
        SampledWavelengths::new([a, b, c, d], pdf)
    }

    /// The wavelengths of a path.
    pub fn lambda(&self, row: usize) -> SampledWavelengths {
        let values = self.wavelengths.row(row);
        let [lambda, pdf] = [0, N].map(|first| std::array::from_fn(|i| values[first + i]));
        SampledWavelengths::new(lambda, pdf)
    }

    /// Changes the wavelengths of a path.
    pub fn set_lambda(&mut self, row: usize, lambda: &SampledWavelengths) {
        let (values, pdf) = (lambda.lambda(), lambda.pdf());
        let values = std::array::from_fn(|i| if i < N { values[i] } else { pdf[i - N] });
        self.wavelengths.set_row(row, values);
    }

    /// Adds light to a path.
    #[inline]
    pub fn add_light(&mut self, row: usize, l: SampledSpectrum) {
        let sum = SampledSpectrum(self.l.row(row)) + l;
        self.l.set_row(row, sum.0);
    }

    /// Multiplies the light of the paths by the share of it that reaches the film.
    pub fn weigh(&mut self) {
        for (row, &weight) in self.camera_weight.iter().enumerate().take(self.count) {
            let l = SampledSpectrum(self.l.row(row)) * weight;
            self.l.set_row(row, l.0);
        }
    }

    /// A path between two vertices.
    pub fn state(&self, row: usize) -> PathState {
        let has_differentials = self.has_differentials(row as u32);
        let differentials = has_differentials.then(|| differentials_of(self.differentials.row(row)));
        let [p, error, n, ns] = [0, 1, 2, 3].map(|i: usize| Vec3::from_array(self.vertex[i].row(row)));
        let context = LightSampleContext { p: Point3Error::new(p, error), n, ns, time: self.time[row] };
        let pdf = self.pdf[row];
        PathState {
            medium: None,
            ray: RayDifferential { ray: self.ray(row), differentials },
            beta: SampledSpectrum(self.beta.row(row)),
            depth: self.depth[row],
            origin: (pdf > 0.0).then_some(Origin { context, pdf }),
            eta_scale: self.eta_scale[row],
            first: FirstEvent::None,
        }
    }

    /// Changes a path between two vertices.
    pub fn set_state(&mut self, row: usize, state: &PathState) {
        let RayDifferential { ray, differentials } = state.ray;
        self.set_ray(row, &ray);
        if let Some(is) = self.are_differentials.get_mut(row) {
            *is = differentials.is_some().into();
        }
        if let Some(differentials) = &differentials {
            self.differentials.set_row(row, numbers_of(differentials));
        }
        self.beta.set_row(row, state.beta.0);
        self.depth[row] = state.depth;
        self.eta_scale[row] = state.eta_scale;
        self.pdf[row] = 0.0;
        if let Some(Origin { context, pdf }) = &state.origin {
            self.pdf[row] = *pdf;
            let vectors = [context.p.p, context.p.error, context.n, context.ns];
            self.vertex.iter_mut().zip(vectors).for_each(|(columns, v)| columns.set_row(row, v.to_array()));
        }
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
pub(super) fn differentials_of<R: Real>(numbers: [R; 12]) -> Differentials<R> {
    let [ax, ay, az, bx, by, bz, cx, cy, cz, dx, dy, dz] = numbers;
    Differentials {
        rx_origin: Vec3::new(ax, ay, az),
        rx_direction: Vec3::new(bx, by, bz),
        ry_origin: Vec3::new(cx, cy, cz),
        ry_direction: Vec3::new(dx, dy, dz),
    }
}
