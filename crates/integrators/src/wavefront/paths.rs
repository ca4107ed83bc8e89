//! The paths of a batch, in columns.

use math::{Differentials, Point3Error, Ray, RayDifferential, Vec3};
use scene::light::LightSampleContext;
use spectrum::{N, SampledSpectrum, SampledWavelengths};

use super::columns::{Column, Columns};
use crate::transport::path_state::{Origin, PathState};
use crate::transport::pixel_samples::PixelSample;

/// The paths of a batch; a path is a row.
#[derive(Default)]
pub(super) struct Paths {
    /// The index of the tile in the batch.
    pub tile: Vec<u32>,
    /// Column and row of the pixel.
    pub pixel: [Vec<u32>; 2],
    /// Weights of the sample in the pixel and of light on the film.
    pub weights: Columns<2>,
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
    /// Its differentials; empty where nothing needs them.
    pub differentials: Vec<Option<Differentials>>,
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
        self.tile.len()
    }

    /// Removes all paths.
    pub fn clear(&mut self) {
        let [x, y] = &mut self.pixel;
        [&mut self.tile, x, y, &mut self.dimension, &mut self.depth].into_iter().for_each(Vec::clear);
        [&mut self.time, &mut self.eta_scale, &mut self.pdf].into_iter().for_each(Vec::clear);
        [&mut self.origin, &mut self.direction].into_iter().for_each(Columns::clear);
        [&mut self.beta, &mut self.l].into_iter().for_each(Columns::clear);
        self.vertex.iter_mut().for_each(Columns::clear);
        self.weights.clear();
        self.wavelengths.clear();
        self.differentials.clear();
        self.rough_before.clear();
    }

    /// Appends a path that starts with a sample of a pixel.
    pub fn push(&mut self, tile: u32, sample: &PixelSample, dimension: u32, with_differentials: bool) {
        self.tile.push(tile);
        self.pixel.iter_mut().zip(sample.pixel).for_each(|(column, x)| column.push(x as u32));
        let camera_weight = sample.camera_ray.as_ref().map_or(0.0, |camera| camera.weight);
        self.weights.push([sample.filter_weight, camera_weight]);
        self.dimension.push(dimension);
        let (lambda, pdf) = (sample.lambda.lambda(), sample.lambda.pdf());
        self.wavelengths.push(std::array::from_fn(|i| if i < N { lambda[i] } else { pdf[i - N] }));
        let nowhere = RayDifferential::from(Ray::new(Vec3::ZERO, Vec3::Z, sample.time));
        let ray = sample.camera_ray.as_ref().map_or(nowhere, |camera| camera.ray);
        self.time.push(ray.ray.time);
        self.origin.push(ray.ray.o.to_array());
        self.direction.push(ray.ray.d.to_array());
        if with_differentials {
            self.differentials.push(ray.differentials);
        }
        self.beta.push([1.0; N]);
        self.l.push([0.0; N]);
        self.eta_scale.push(1.0);
        self.depth.push(0);
        self.rough_before.push(false);
        self.vertex.iter_mut().for_each(|columns| columns.push([0.0; 3]));
        self.pdf.push(0.0);
    }

    /// The ray of a path.
    #[inline]
    pub fn ray(&self, row: usize) -> Ray {
        let [o, d] = [&self.origin, &self.direction].map(|columns| Vec3::from_array(columns.row(row)));
        Ray::new(o, d, self.time[row])
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

    /// A path between two vertices.
    pub fn state(&self, row: usize) -> PathState {
        let differentials = self.differentials.get(row).copied().flatten();
        let [p, error, n, ns] = [0, 1, 2, 3].map(|i: usize| Vec3::from_array(self.vertex[i].row(row)));
        let context = LightSampleContext { p: Point3Error::new(p, error), n, ns, time: self.time[row] };
        let pdf = self.pdf[row];
        PathState {
            ray: RayDifferential { ray: self.ray(row), differentials },
            beta: SampledSpectrum(self.beta.row(row)),
            depth: self.depth[row],
            origin: (pdf > 0.0).then_some(Origin { context, pdf }),
            eta_scale: self.eta_scale[row],
        }
    }

    /// Changes a path between two vertices.
    pub fn set_state(&mut self, row: usize, state: &PathState) {
        let RayDifferential { ray, differentials } = state.ray;
        self.origin.set_row(row, ray.o.to_array());
        self.direction.set_row(row, ray.d.to_array());
        if let Some(kept) = self.differentials.get_mut(row) {
            *kept = differentials;
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
