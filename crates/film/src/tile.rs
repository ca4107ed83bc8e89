//! Tiles of a film, which one thread fills at a time.

use std::collections::BTreeMap;

use lanes::{Each, MAX_LANES, Mask, Real};
use math::Bounds2i;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::exposure::Exposure;
use crate::grid::index_in;
use crate::layer::Layout;
use crate::sum::{MAX_TERM, TileSums, can_add, units};
use crate::{Buckets, Layer, LayerSet, Parts, Sample};

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
    /// The buckets of a spectral film, and the sums of each: light and weight.
    pub(crate) spectrum: Option<(Buckets, TileSums<'film>)>,
    /// Whether its memory is there.
    pub(crate) is_touched: bool,
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

    /// Room for [`Sample::parts`], if some layer of the film takes them.
    pub fn new_parts(&self) -> Option<Parts> {
        let layout = self.data.as_ref()?.layout;
        layout.layers().has_parts().then(|| Parts::new(layout.groups()))
    }

    /// Whether some layer of the film takes the slopes of [`Sample::first_hit`].
    pub fn wants_slopes(&self) -> bool {
        let has = |layers: LayerSet| layers.has(Layer::Slope) || layers.has(Layer::CameraSlope);
        self.data.as_ref().is_some_and(|data| has(data.layout.layers()))
    }

    /// Adds a sample to a pixel.
    ///
    /// # Panics
    /// If the pixel is not in the tile.
    #[inline]
    pub fn add(&mut self, pixel: [i32; 2], sample: &Sample) {
        assert!(self.bounds.contains(pixel), "{pixel:?} is not in the tile");
        self.touch();
        let index = index_in(&self.bounds, pixel);
        let Some(terms) = self.exposure.terms(sample).filter(|_| self.can_add_to_buckets(sample)) else {
            self.exposure.reject(pixel);
            return;
        };
        terms.into_iter().enumerate().for_each(|(sum, term)| self.color.add(index, sum, term));
        if let Some((buckets, sums)) = &mut self.spectrum {
            for (bucket, terms) in bucket_terms(self.exposure, *buckets, sample) {
                terms.into_iter().enumerate().for_each(|(i, term)| sums.add(index, 2 * bucket + i, term));
            }
        }
        self.counts[index] = self.counts[index].saturating_add(1);
        if let Some(data) = &mut self.data {
            data.add(index, sample, terms, self.exposure);
        }
    }

    /// Makes the operating system allocate the memory of a tile without samples. A page that is
    /// read before it is written to is at first one of zeros, which all such pages share; to
    /// replace it, processors that run other threads are interrupted.
    fn touch(&mut self) {
        if std::mem::replace(&mut self.is_touched, true) || self.counts.iter().any(|&count| count > 0) {
            return;
        }
        self.color.touch();
        self.data.iter_mut().flat_map(|data| &mut data.sums).for_each(TileSums::touch);
        self.spectrum.iter_mut().for_each(|(_, sums)| sums.touch());
    }

    /// Whether the sums of the buckets, if there are any, can take a sample.
    fn can_add_to_buckets(&self, sample: &Sample) -> bool {
        self.spectrum.as_ref().is_none_or(|&(buckets, _)| {
            bucket_terms(self.exposure, buckets, sample).all(|(_, terms)| terms.into_iter().all(can_add))
        })
    }

    /// Adds samples of radiance `l` alone to successive pixels, row by row, from the one with index
    /// `first` on: those of the first `count` lanes.
    ///
    /// # Panics
    /// If the tile does not have as many pixels.
    #[inline(always)]
    pub fn add_lanes<R: Real>(
        &mut self,
        first: usize,
        count: usize,
        l: &SampledSpectrum<R>,
        lambda: &SampledWavelengths<R>,
        weight: R,
    ) {
        let rgb = self.exposure.response(l, lambda, 1.0);
        // Rounding is far below the distance to the limit of the sums.
        let limit = R::splat(MAX_TERM as f32 / 2.0);
        let mut is_plain = l.is_finite() & weight.abs().lt(limit);
        for c in rgb {
            is_plain = is_plain & c.abs().lt(limit) & (c * weight).abs().lt(limit);
        }
        let terms = LaneTerms { rgb: rgb.each(R::to_array), weight: weight.to_array() };
        let plain = if self.data.is_none() && self.spectrum.is_none() { is_plain.bits() } else { 0 };
        self.add_plain(first, count, &terms, plain);
        if (!plain).trailing_zeros() < count as u32 {
            let l = l.0.each(R::to_array);
            for lane in 0..count {
                if plain >> lane & 1 == 1 {
                    continue;
                }
                let l = SampledSpectrum(l.each(|l| l[lane]));
                self.add_sample(self.pixel(first + lane), &l, &lambda.lane(lane), terms.weight[lane]);
            }
        }
    }

    /// Adds the terms of those of the first `count` lanes that are set in `lanes`.
    fn add_plain(&mut self, first: usize, count: usize, terms: &LaneTerms, lanes: u32) {
        self.touch();
        let counts = &mut self.counts[first..first + count];
        for (lane, samples) in counts.iter_mut().enumerate() {
            if lanes >> lane & 1 == 0 {
                continue;
            }
            let weight = f64::from(terms.weight[lane]);
            for (sum, c) in terms.rgb.iter().enumerate() {
                self.color.add(first + lane, sum, weight * f64::from(c[lane]));
            }
            self.color.add(first + lane, 3, weight);
            *samples = samples.saturating_add(1);
        }
    }

    /// The pixel with this index.
    fn pixel(&self, index: usize) -> [i32; 2] {
        let width = self.bounds.width() as usize;
        [self.bounds.min[0] + (index % width) as i32, self.bounds.min[1] + (index / width) as i32]
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

/// What a sample adds to the two sums of buckets: its light and its weight there.
fn bucket_terms(
    exposure: &Exposure,
    buckets: Buckets,
    sample: &Sample,
) -> impl Iterator<Item = (usize, [f64; 2])> {
    let part = f64::from(sample.weight) / sample.l.len() as f64;
    let light = sample.l.iter().zip(sample.lambda);
    light.flat_map(move |(l, lambda)| exposure.in_buckets(buckets, l, lambda, 1.0)).map(move |light| {
        let weight = part * light.share;
        (light.bucket, [weight * light.l, weight])
    })
}

/// The responses to samples, and their weights.
struct LaneTerms {
    rgb: [[f32; MAX_LANES]; 3],
    weight: [f32; MAX_LANES],
}

/// The layers of a tile.
#[derive(Debug)]
pub(crate) struct TileData<'film> {
    pub(crate) layout: &'film Layout,
    pub(crate) sums: Option<TileSums<'film>>,
    /// Of [`Layer::IDS`].
    pub(crate) ids: [Option<&'film mut IdSums>; Layer::IDS.len()],
}

impl TileData<'_> {
    /// Adds a sample whose weighted response and weight are `terms`.
    fn add(&mut self, pixel: usize, sample: &Sample, terms: [f64; 4], exposure: &Exposure) {
        let Some(sums) = &mut self.sums else { return };
        let weight = f64::from(sample.weight);
        let mut add_at = |offset, weight: f64, values: &[f32]| {
            for (i, &value) in values.iter().enumerate() {
                let term = weight * f64::from(value);
                if can_add(term) {
                    sums.add(pixel, offset + i, term);
                }
            }
        };
        if let Some(parts) = sample.parts {
            for (layer, offset) in self.layout.parts() {
                for (i, part) in parts.of(layer).iter().enumerate() {
                    add_at(
                        offset + 3 * i,
                        weight,
                        &exposure.part(part, &sample.l[0], &sample.lambda[0], 1.0),
                    );
                }
            }
        }
        let mut add = |layer, weight, values: &[f32]| {
            if let Some(offset) = self.layout.offset(layer) {
                add_at(offset, weight, values);
            }
        };
        add(Layer::Alpha, weight, &[sample.alpha]);
        let positive = weight.max(0.0);
        if let Some(hit) = &sample.first_hit {
            if self.layout.offset(Layer::Albedo).is_some() {
                add(Layer::Albedo, weight, &exposure.albedo(&hit.albedo, &sample.lambda[0]));
            }
            self.layout.layers().iter().for_each(|layer| add(layer, positive, hit.numbers(layer)));
        }
        if let Some(offset) = self.layout.offset(Layer::Variance) {
            // The luminance-like response is the second one, that of the observer's ȳ.
            let luminance = terms[1];
            let moments = [weight * weight, weight * luminance, luminance * luminance];
            for (i, moment) in moments.into_iter().enumerate() {
                sums.add(pixel, offset + i, moment.clamp(-crate::sum::MAX_TERM, crate::sum::MAX_TERM));
            }
        }
        let color_variance = self.layout.offset(Layer::ColorVariance);
        if let Some(offset) = color_variance.filter(|_| sample.first_hit.is_some() && weight != 0.0) {
            let rgb = [0, 1, 2].map(|c: usize| terms[c] / weight);
            let squares = rgb.map(|c| c * c);
            for (i, moment) in [1.0].into_iter().chain(rgb).chain(squares).enumerate() {
                sums.add(pixel, offset + i, moment.clamp(-crate::sum::MAX_TERM, crate::sum::MAX_TERM));
            }
        }
        if self.layout.has_coverage() {
            sums.add(pixel, 0, if sample.first_hit.is_some() { positive } else { 0.0 });
            sums.add(pixel, 1, positive);
            if let Some(hit) = sample.first_hit {
                for (ids, id) in self.ids.iter_mut().zip(hit.ids) {
                    if let Some(ids) = ids {
                        *ids.entry((pixel as u16, id)).or_insert(0) += units(positive);
                    }
                }
            }
        }
    }
}
