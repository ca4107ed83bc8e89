//! Tiles of a film, which one thread fills at a time.

use std::collections::BTreeMap;

use math::Bounds2i;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::exposure::Exposure;
use crate::grid::index_in;
use crate::layer::Layout;
use crate::sum::{TileSums, can_add, units};
use crate::{FirstHit, Layer, Sample};

/// The weights of identifiers in a tile, in units of sums: by pixel and identifier.
pub(crate) type IdSums = BTreeMap<(u16, u32), i128>;

/// A part of a film that one thread fills.
#[derive(Debug)]
pub struct FilmTile<'film> {
    pub(crate) bounds: Bounds2i,
    pub(crate) exposure: &'film Exposure,
    pub(crate) color: TileSums<'film>,
    pub(crate) counts: &'film mut [u32],
    /// The layers, if there are any.
    pub(crate) data: Option<TileData<'film>>,
}

impl FilmTile<'_> {
    /// Its pixels.
    pub fn bounds(&self) -> Bounds2i {
        self.bounds
    }

    /// Whether some layer of the film takes [`Sample::first_hit`] or [`Sample::alpha`].
    pub fn wants_first_hit(&self) -> bool {
        self.data.as_ref().is_some_and(|data| data.layout.layers().has_first_hit())
    }

    /// Adds a sample to a pixel.
    ///
    /// # Panics
    /// If the pixel is not in the tile.
    #[inline]
    pub fn add(&mut self, pixel: [i32; 2], sample: &Sample) {
        assert!(self.bounds.contains(pixel), "{pixel:?} is not in the tile");
        let index = index_in(&self.bounds, pixel);
        let Some(terms) = self.exposure.terms(sample) else {
            self.exposure.reject(pixel);
            return;
        };
        terms.into_iter().enumerate().for_each(|(sum, term)| self.color.add(index, sum, term));
        self.counts[index] = self.counts[index].saturating_add(1);
        if let Some(data) = &mut self.data {
            data.add(index, sample, terms, self.exposure);
        }
    }

    /// Adds a sample of radiance `l` alone to a pixel.
    ///
    /// # Panics
    /// If the pixel is not in the tile.
    pub fn add_sample(
        &mut self,
        pixel: [i32; 2],
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        weight: f32,
    ) {
        self.add(pixel, &Sample::new(l, lambda, weight));
    }
}

/// The layers of a tile.
#[derive(Debug)]
pub(crate) struct TileData<'film> {
    pub(crate) layout: &'film Layout,
    pub(crate) sums: Option<TileSums<'film>>,
    /// Of objects and materials.
    pub(crate) ids: [Option<&'film mut IdSums>; 2],
}

impl TileData<'_> {
    /// Adds a sample whose weighted response and weight are `terms`.
    fn add(&mut self, pixel: usize, sample: &Sample, terms: [f64; 4], exposure: &Exposure) {
        let Some(sums) = &mut self.sums else { return };
        let weight = f64::from(sample.weight);
        let mut add = |layer, weight: f64, values: &[f32]| {
            let Some(offset) = self.layout.offset(layer) else { return };
            for (i, &value) in values.iter().enumerate() {
                let term = weight * f64::from(value);
                if can_add(term) {
                    sums.add(pixel, offset + i, term);
                }
            }
        };
        add(Layer::Alpha, weight, &[sample.alpha]);
        let positive = weight.max(0.0);
        if let Some(hit) = &sample.first_hit {
            if self.layout.offset(Layer::Albedo).is_some() {
                add(Layer::Albedo, weight, &exposure.albedo(&hit.albedo, &sample.lambda[0]));
            }
            add(Layer::Depth, positive, &[hit.depth]);
            add(Layer::Normal, positive, &hit.normal);
            add(Layer::Position, positive, &hit.position);
            add(Layer::CameraPosition, positive, &hit.camera_position);
            add(Layer::CameraNormal, positive, &hit.camera_normal);
            add(Layer::Uv, positive, &hit.uv);
            add(Layer::Motion, positive, &hit.motion);
        }
        if let Some(offset) = self.layout.offset(Layer::Variance) {
            // The luminance-like response is the second one, that of the observer's ȳ.
            let luminance = terms[1];
            let moments = [weight * weight, weight * luminance, luminance * luminance];
            for (i, moment) in moments.into_iter().enumerate() {
                sums.add(pixel, offset + i, moment.clamp(-crate::sum::MAX_TERM, crate::sum::MAX_TERM));
            }
        }
        if self.layout.has_coverage() {
            sums.add(pixel, 0, if sample.first_hit.is_some() { positive } else { 0.0 });
            sums.add(pixel, 1, positive);
            if let Some(FirstHit { object, material, .. }) = sample.first_hit {
                for (ids, id) in self.ids.iter_mut().zip([object, material]) {
                    if let Some(ids) = ids {
                        *ids.entry((pixel as u16, id)).or_insert(0) += units(positive);
                    }
                }
            }
        }
    }
}
