//! Spectra.
//!
//! | words | spectrum |
//! |---|---|
//! | `Constant`, value | constant |
//! | `Linear`, count, 0, 0, and for each wavelength 4 words: it and its value, and those of the next | linear between wavelengths |
//! | `Dense`, values | at each nanometre from 360 on |
//! | `Rgb`, scale, 0, 0, 3 coefficients | of RGB |
//! | `RgbLight`, scale, offset of a spectrum, 0, 3 coefficients | the same times another one |
//!
//! A colour space is five words, the offsets of what [`RgbToSpectrumTable::numbers`] has and of the
//! illuminant.
//!
//! [`RgbToSpectrumTable::numbers`]: spectrum::uplift::RgbToSpectrumTable::numbers

use std::collections::HashMap;
use std::sync::Arc;

use spectrum::{DenselySampled, RgbColorSpace, RgbSigmoidPolynomial, Spectrum};

use super::Flattener;
use crate::tags::SpectrumTag;

/// The offsets of spectra and of colour spaces that others share, by their addresses.
pub type Shared = HashMap<usize, u32>;

impl Flattener<'_> {
    /// A spectrum; its offset.
    pub fn spectrum(&mut self, spectrum: &Spectrum) -> u32 {
        match spectrum {
            Spectrum::Constant(value) => self.slab.add([SpectrumTag::Constant as u32, value.to_bits()]),
            Spectrum::PiecewiseLinear(linear) => self.linear(linear.pairs()),
            Spectrum::DenselySampled(dense) => self.dense(dense),
            // Smooth, so that it is nearly linear within a nanometre.
            Spectrum::Blackbody(body) => {
                let wavelengths = (360..=830).map(|nanometre| nanometre as f32);
                self.linear(wavelengths.map(|lambda| (lambda, body.at(lambda))))
            }
            Spectrum::RgbAlbedo(rgb) => self.slab.add(rgb_words(SpectrumTag::Rgb, 1.0, 0, rgb.polynomial())),
            Spectrum::RgbUnbounded(rgb) => {
                self.slab.add(rgb_words(SpectrumTag::Rgb, rgb.scale(), 0, rgb.polynomial()))
            }
            Spectrum::RgbIlluminant(rgb) => {
                let (illuminant, factor) = (self.dense(rgb.illuminant()), rgb.factor());
                self.slab.add(rgb_words(
                    SpectrumTag::RgbLight,
                    factor.scale(),
                    illuminant,
                    factor.polynomial(),
                ))
            }
        }
    }

    /// A spectrum that is linear between pairs of wavelength and value.
    fn linear(&mut self, pairs: impl Iterator<Item = (f32, f32)>) -> u32 {
        let pairs: Vec<(f32, f32)> = pairs.collect();
        let at = self.slab.add([SpectrumTag::Linear as u32, pairs.len() as u32, 0, 0]);
        let next = pairs.iter().skip(1).chain(pairs.last());
        self.slab.extend_numbers(pairs.iter().zip(next).flat_map(|(a, b)| [a.0, a.1, b.0, b.1]));
        at
    }

    /// A colour space, whose RGB values become spectra; its offset.
    pub fn color_space(&mut self, space: &RgbColorSpace) -> u32 {
        let address = std::ptr::from_ref(space) as usize;
        if let Some(&at) = self.spectra.get(&address) {
            return at;
        }
        let numbers = space.uplifting().numbers();
        let [nodes, values, coordinates, ratios] =
            numbers.map(|numbers| self.slab.add_numbers(numbers.iter().copied()));
        // An illuminant is densely sampled.
        let illuminant = self.spectrum(&space.illuminant());
        let at = self.slab.add([nodes, values, coordinates, ratios, illuminant]);
        self.spectra.insert(address, at);
        at
    }

    fn dense(&mut self, dense: &Arc<DenselySampled>) -> u32 {
        let address = Arc::as_ptr(dense) as usize;
        if let Some(&at) = self.spectra.get(&address) {
            return at;
        }
        let at = self.slab.add([SpectrumTag::Dense as u32]);
        self.slab.extend_numbers(dense.values().iter().copied());
        self.spectra.insert(address, at);
        at
    }
}

fn rgb_words(tag: SpectrumTag, scale: f32, other: u32, polynomial: &RgbSigmoidPolynomial) -> [u32; 7] {
    let [a, b, c] = polynomial.coefficients.map(f32::to_bits);
    [tag as u32, scale.to_bits(), other, 0, a, b, c]
}
