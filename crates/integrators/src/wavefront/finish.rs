//! The end of paths on the film.

use std::ops::Range;

use film::FilmTile;
use lanes::{Kernel, Real};
use sampling::Sampler;

use super::pass::Pass;
use super::path_columns::PathColumns;
use crate::transport::pixel_samples::PixelSample;
use crate::{Cancelled, Tracer};
use geometry::RayStats;

/// Adds the light of paths to the pixels of a tile, all of which have one.
pub(super) struct Finish<'a, 'film> {
    pub paths: &'a PathColumns,
    /// The rows of the paths of the tile.
    pub rows: Range<usize>,
    pub tile: &'a mut FilmTile<'film>,
}

impl Kernel for Finish<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Self { paths, rows, tile } = self;
        let pixels = rows.len();
        for pixel in (0..pixels).step_by(R::LANES) {
            let row = rows.start + pixel;
            let l = paths.l.load::<R>(row);
            let lambda = paths.wavelengths(row);
            let weight = R::load(&paths.filter_weight[row..]);
            tile.add_lanes(pixel, R::LANES.min(pixels - pixel), &l, &lambda, weight);
        }
    }
}

/// The same, one by one, where some of the pixels have a path.
pub(super) fn finish_some(Finish { paths, rows, tile }: Finish) {
    for row in rows {
        tile.add_sample(paths.pixel(row), &paths.l.row(row), &paths.lambda(row), paths.filter_weight[row]);
    }
}

/// The same, one by one, for a film with layers of first hits, which are traced.
pub(super) fn finish_with_first_hits(
    pass: &Pass,
    sampler: &mut Sampler,
    stats: &mut RayStats,
    Finish { paths, rows, tile }: Finish,
) -> Result<(), Cancelled> {
    let pixels = pass.pixels;
    for row in rows {
        let pixel = paths.pixel(row);
        let lambda = paths.lambda(row);
        let mut sample: PixelSample = pixels.begin(None, pixel, sampler);
        sample.lambda = lambda;
        sampler.start_pixel_sample(pixel, pixels.index, paths.dimension[row]);
        let mut tracer = Tracer::new(pixels.scene, pixels.view, pass.control, sampler, stats);
        let first_hit = pixels.first_hit(tile, &sample, &lambda, &mut tracer);
        tracer.finish()?;
        let l = paths.l.row(row);
        let alpha = if first_hit.is_some() { 1.0 } else { 0.0 };
        let radiance = film::Sample::new(&l, &lambda, paths.filter_weight[row]);
        tile.add(pixel, &film::Sample { alpha, first_hit, ..radiance });
    }
    Ok(())
}
