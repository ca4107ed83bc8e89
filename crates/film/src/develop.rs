//! From a film's sums to a picture.

use lanes::Each;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use half::f16;
use image::{
    Channel, Chromaticities, Image, ImageError, ImageMetadata, PixelSource, Pixels, SampleDepth, Window,
};
use math::Vec3;
use spectrum::{Matrix3, Rgb, SampledSpectrum, SampledWavelengths};

use crate::layer::{Quantity, Statistic};
use crate::splats::SPLAT_SUMS;
use crate::sum::{Sums, reserved, value};
use crate::{Buckets, Film, Layer, LayerSet, TILE_SIZE, cryptomatte};

/// The depth of pixels in which nothing is hit: the usual number for "infinitely far" in
/// compositing, where infinity itself would spoil arithmetic.
const FAR: f32 = 1e10;

impl Film {
    /// The current picture: linear R, G and B in the film's colour space, without layers. Refused
    /// where there is no memory for it.
    pub fn develop(&self) -> Result<Image, ImageError> {
        Development::of_colors(self, None).to_image()
    }

    /// The colour that light gives a pixel, in the film's colour space.
    pub fn rgb(&self, l: &SampledSpectrum, lambda: &SampledWavelengths) -> [f32; 3] {
        Development::of_colors(self, None).color(self.exposure.response(l, lambda, 1.0).each(f64::from))
    }

    /// The picture with all layers and buckets, row by row while it is written, so that a large one
    /// needs no copy in memory.
    pub fn development(&self) -> Development<'_> {
        Development::of_all(self, None)
    }
}

/// A film, or the sum of two, that is developed while it is written.
///
/// Beside R, G and B there are the channels of the layers: A; Z; N, P, uv and motion; albedo;
/// samples and variance; parts of the light; for identifiers those of Cryptomatte; and those of the
/// buckets. All but the colours, their parts, alpha, albedo and buckets are single floats.
#[derive(Debug)]
pub struct Development<'film> {
    film: &'film Film,
    second: Option<&'film Film>,
    layers: LayerSet,
    buckets: Option<Buckets>,
    output_from_sensor: Matrix3,
    /// The light paths that splats are of.
    light_paths: u64,
    channels: Vec<Channel>,
    /// The metadata of the picture.
    pub metadata: ImageMetadata,
}

impl<'film> Development<'film> {
    /// The colours of a film. Where there is a second film, of the same pixels and settings, it is
    /// the picture of both [merged](Film::merge).
    pub fn of_colors(film: &'film Film, second: Option<&'film Film>) -> Self {
        Self::new(film, second, LayerSet::NONE, None)
    }

    /// The same with all layers and buckets.
    pub fn of_all(film: &'film Film, second: Option<&'film Film>) -> Self {
        Self::new(film, second, film.layers(), film.buckets)
    }

    fn new(
        film: &'film Film,
        second: Option<&'film Film>,
        layers: LayerSet,
        buckets: Option<Buckets>,
    ) -> Self {
        let color_space = film.color_space();
        let [red, green, blue] = color_space.primaries();
        let bounds = film.pixel_bounds();
        let mut metadata = ImageMetadata {
            chromaticities: Some(Chromaticities { red, green, blue, white: color_space.white() }),
            data_window: Some(Window { min: bounds.min, max: bounds.max }),
            display_window: Some(Window { min: [0, 0], max: film.full_resolution() }),
            ..ImageMetadata::default()
        };
        let color_depth = if film.half_floats() { SampleDepth::F16 } else { SampleDepth::F32 };
        let channel = |name: &str, depth| Channel { name: name.to_owned(), depth };
        let mut channels = ["R", "G", "B"].map(|name| channel(name, color_depth)).to_vec();
        for layer in layers.iter() {
            let is_color = matches!(layer.quantity(), Quantity::Light | Quantity::Opacity);
            let depth = if is_color { color_depth } else { SampleDepth::F32 };
            channels.extend(layer.channels(film.gbuffer).iter().map(|name| channel(name, depth)));
            if layer.is_id() {
                channels.extend(cryptomatte::channels(layer).map(|name| channel(&name, depth)));
                cryptomatte::describe(layer, &mut metadata);
            }
            if layer == Layer::LightGroups {
                let names = film.light_groups().iter();
                let names = names.flat_map(|group| ["R", "G", "B"].map(|c| format!("lights.{group}.{c}")));
                channels.extend(names.map(|name| channel(&name, depth)));
            }
        }
        if let Some(buckets) = buckets {
            channels.extend(buckets.channels().map(|name| channel(&name, color_depth)));
            Buckets::describe(&mut metadata);
        }
        let output_from_sensor = color_space.rgb_from_xyz() * film.exposure.sensor.xyz_from_sensor_rgb();
        let light_paths = [Some(film), second].into_iter().flatten().map(|film| film.splats.paths()).sum();
        Self { film, second, layers, buckets, output_from_sensor, light_paths, channels, metadata }
    }

    /// Writes the names of a layer's identifiers to the header, if the film has the layer: of these
    /// names, those that are in the picture.
    pub fn set_names<S: AsRef<str>>(&mut self, layer: Layer, names: impl IntoIterator<Item = S>) {
        if layer.is_id() && self.layers.has(layer) {
            let ids = self.films().flat_map(|film| film.ids_of(layer));
            let present: BTreeSet<u32> = ids.flat_map(|ids| ids.keys().map(|&(_, id)| id)).collect();
            cryptomatte::set_manifest(layer, names, &present, &mut self.metadata);
        }
    }

    /// R, G and B as an image; refused where there is no memory for it.
    pub fn to_image(&self) -> Result<Image, ImageError> {
        let (width, height) = (self.width() as usize, self.height() as usize);
        let mut row = vec![0.0; width * self.channels.len()];
        let mut colors = |put: &mut dyn FnMut(f32)| {
            for y in 0..self.height() {
                self.row(y, &mut row);
                row.chunks_exact(self.channels.len()).flat_map(|pixel| &pixel[..3]).for_each(|&c| put(c));
            }
        };
        let count = (3 * width).saturating_mul(height);
        let pixels = if self.film.half_floats() {
            let mut values = reserved(count)?;
            colors(&mut |value| values.push(f16::from_f32(value)));
            Pixels::F16(values)
        } else {
            let mut values = reserved(count)?;
            colors(&mut |value| values.push(value));
            Pixels::F32(values)
        };
        let mut image = Image::new(self.width(), self.height(), ["R", "G", "B"], pixels)?;
        image.metadata = self.metadata.clone();
        Ok(image)
    }

    fn films(&self) -> impl Iterator<Item = &'film Film> + use<'film> {
        std::iter::once(self.film).chain(self.second)
    }

    /// A sum of a pixel of the films: of a tile, its first pixel and the pixel in it.
    #[inline]
    fn sum(&self, sums: impl Fn(&Film) -> &Sums, place: [usize; 3], component: usize) -> f64 {
        match self.second {
            None => sums(self.film).value(place, component),
            Some(second) => {
                let [first, second] = [self.film, second].map(|film| sums(film).units(place, component));
                value(first.saturating_add(second))
            }
        }
    }

    fn count(&self, pixel: usize) -> u32 {
        self.films().map(|film| film.counts[pixel]).fold(0, u32::saturating_add)
    }

    /// Colour and layers of a pixel of a tile, channel by channel.
    fn pixel(&self, tile: usize, first: usize, pixel: usize, mut put: impl FnMut(f32)) {
        // A film of light paths alone has no such sums.
        let has_samples = !self.film.counts.is_empty();
        let color = |c| if has_samples { self.sum(|film| &film.color, [tile, first, pixel], c) } else { 0.0 };
        let weight = color(3);
        let mean = mean([0, 1, 2].each(color), weight);
        let response = [0, 1, 2].each(|c| mean[c] + self.splats(tile, pixel, c));
        self.color(response).into_iter().for_each(&mut put);
        for layer in self.layers.iter() {
            self.layer(layer, [tile, first, pixel], weight, &mut put);
        }
        for bucket in 0..self.buckets.map_or(0, |buckets| buckets.count()) {
            let sum = |i| self.sum(|film| &film.spectrum, [tile, first, pixel], 2 * bucket + i);
            let weight = if has_samples { sum(1) } else { 0.0 };
            let mean = if weight == 0.0 { 0.0 } else { sum(0) / weight };
            let light = (mean + self.splats(tile, pixel, SPLAT_SUMS + bucket)) as f32;
            put(if self.film.half_floats() { half(light) } else { light });
        }
    }

    /// What splats add to a response of the sensor, a bucket or a part of the light.
    fn splats(&self, tile: usize, pixel: usize, component: usize) -> f64 {
        if self.light_paths == 0 {
            return 0.0;
        }
        let units = self.films().map(|film| film.splats.units(tile, pixel, component));
        value(units.fold(0, i128::saturating_add)) / self.light_paths as f64
    }

    /// The colour of a response of the sensor.
    fn color(&self, response: [f64; 3]) -> [f32; 3] {
        let rgb = Rgb::from(self.output_from_sensor.apply(response).each(|c| c as f32));
        if self.film.half_floats() { as_half(rgb) } else { rgb }.to_array()
    }

    fn layer(&self, layer: Layer, [tile, first, pixel]: [usize; 3], weight: f64, mut put: impl FnMut(f32)) {
        let sum = |c| self.sum(|film| &film.data, [tile, first, pixel], c);
        let quotient = |a: f64, b: f64| if b == 0.0 { 0.0 } else { (a / b) as f32 };
        let offset = self.film.layout.offset(layer).unwrap_or(0);
        match layer.statistic() {
            Statistic::Count => put(self.count(first + pixel) as f32),
            Statistic::Variance => {
                let moments = [0, 1, 2].each(|i| sum(offset + i));
                put(self.variance([tile, first, pixel], moments, weight));
            }
            Statistic::Ids => {
                let mut covered = BTreeMap::<u32, i128>::new();
                for film in self.films() {
                    let ids = &film.ids_of(layer)[tile];
                    for (&(_, id), weight) in ids.range(keys(pixel)) {
                        *covered.entry(id).or_default() += weight;
                    }
                }
                let covered = covered.into_iter().map(|(id, weight)| (id, value(weight)));
                cryptomatte::ranks(covered, sum(1)).for_each(put);
            }
            Statistic::ColorVariance => {
                let count = sum(offset);
                let moments = [0, 1, 2].each(|c| (sum(offset + 1 + c), sum(offset + 4 + c)));
                let mean = |sum: f64| if count == 0.0 { 0.0 } else { sum / count };
                let variance = moments.each(|(sum, squares)| match count > 1.0 {
                    true => (squares - sum * mean(sum)).max(0.0) / (count - 1.0),
                    false => 0.0,
                });
                variance.into_iter().for_each(|variance| put(variance as f32));
                variance.into_iter().zip(moments).for_each(|(v, (sum, _))| put(quotient(v, mean(sum))));
            }
            Statistic::Part | Statistic::Groups => {
                let buckets = self.film.buckets.map_or(0, |buckets| buckets.count());
                let splats = SPLAT_SUMS * (1 + self.film.layout.first_part(layer)) + buckets;
                for i in (0..self.film.layout.sums(layer)).step_by(3) {
                    let mean = |c| if weight == 0.0 { 0.0 } else { sum(offset + i + c) / weight };
                    let all = |c| mean(c) + self.splats(tile, pixel, splats + i + c);
                    self.color([0, 1, 2].map(all)).into_iter().for_each(&mut put);
                }
            }
            of @ (Statistic::Mean | Statistic::MeanOfHits) => {
                let divisor = if of == Statistic::Mean { weight } else { sum(0) };
                let mean = |i| quotient(sum(offset + i), divisor);
                match layer.quantity() {
                    Quantity::Distance if divisor == 0.0 => put(FAR),
                    // The format's normals have unit length.
                    Quantity::Direction if self.film.gbuffer.is_some() => {
                        let mean = Vec3::from_array([0, 1, 2].each(mean)).normalize_or_zero();
                        mean.to_array().into_iter().for_each(put);
                    }
                    Quantity::Magnitude => (0..self.film.layout.sums(layer)).for_each(|i| put(mean(i).abs())),
                    _ => (0..self.film.layout.sums(layer)).for_each(|i| put(mean(i))),
                }
            }
        }
    }

    /// The variance of a pixel's luminance, the mean of n samples yᵢ of weights wᵢ: n/(n−1) Σ wᵢ²
    /// (yᵢ − ȳ)² / (Σ wᵢ)².
    fn variance(&self, [tile, first, pixel]: [usize; 3], [ww, wwy, wwyy]: [f64; 3], weight: f64) -> f32 {
        let count = f64::from(self.count(first + pixel));
        if count < 2.0 || weight == 0.0 {
            return 0.0;
        }
        let mean = self.sum(|film| &film.color, [tile, first, pixel], 1) / weight;
        let squares = (wwyy - 2.0 * mean * wwy + mean * mean * ww).max(0.0);
        (count / (count - 1.0) * squares / (weight * weight)) as f32
    }
}

/// The mean response of weighted ones that have these sums.
fn mean(sums: [f64; 3], weight: f64) -> [f64; 3] {
    if weight == 0.0 { [0.0; 3] } else { sums.each(|c| c / weight) }
}

/// A colour as half floats can hold it.
fn as_half(rgb: Rgb) -> Rgb {
    let (least, most) = (f16::MIN.to_f32(), f16::MAX.to_f32());
    Rgb::from(rgb.clamp(least, most).to_array().each(|value| f16::from_f32(value).to_f32()))
}

/// A number as a half float can hold it.
fn half(value: f32) -> f32 {
    f16::from_f32(value.clamp(f16::MIN.to_f32(), f16::MAX.to_f32())).to_f32()
}

/// The identifiers of a pixel among those of its tile.
fn keys(pixel: usize) -> RangeInclusive<(u16, u32)> {
    (pixel as u16, 0)..=(pixel as u16, u32::MAX)
}

impl PixelSource for Development<'_> {
    fn width(&self) -> u32 {
        self.film.pixel_bounds().width() as u32
    }

    fn height(&self) -> u32 {
        self.film.pixel_bounds().height() as u32
    }

    fn channels(&self) -> Vec<Channel> {
        self.channels.clone()
    }

    fn metadata(&self) -> &ImageMetadata {
        &self.metadata
    }

    fn row(&self, y: u32, values: &mut [f32]) {
        let (grid, side) = (self.film.grid, TILE_SIZE as usize);
        let mut values = values.iter_mut();
        for tile in grid.row(y as usize / side) {
            let (first, width) = (grid.range(tile).start, grid.bounds(tile).width() as usize);
            let row = y as usize % side * width;
            let has_samples = !self.film.counts.is_empty();
            let is_plain = has_samples && self.second.is_none() && self.light_paths == 0;
            if is_plain
                && self.channels.len() == 3
                && let Some(sums) = self.film.color.values(tile, first + row..first + row + width)
            {
                for [r, g, b, weight] in sums {
                    self.color(mean([r, g, b], weight))
                        .into_iter()
                        .zip(values.by_ref())
                        .for_each(|(c, value)| *value = c);
                }
                continue;
            }
            for pixel in row..row + width {
                self.pixel(tile, first, pixel, |number| {
                    if let Some(value) = values.next() {
                        *value = number;
                    }
                });
            }
        }
    }
}
