//! Spectra of paths, or of shadow rays.

use lanes::{Int, MAX_LANES, Mask, Real};
use spectrum::{N, SampledSpectrum};

use super::float_columns::{fill, grow};
use super::indices::Indices;

/// A spectrum for each path. The numbers of one are side by side, so that lanes read or write one
/// cache line each, and not four.
#[derive(Default)]
pub(super) struct SpectrumColumn(Vec<[f32; N]>);

impl SpectrumColumn {
    /// Appends a spectrum.
    pub fn push(&mut self, s: SampledSpectrum) {
        self.0.push(s.0);
    }

    /// Appends the lanes of a mask.
    #[inline(always)]
    pub fn append<R: Real>(&mut self, mask: R::Mask, s: SampledSpectrum<R>) {
        let (len, mut kept) = (self.0.len(), [[0.0; N]; MAX_LANES]);
        let count = R::compress_four(s.0, mask, kept.as_flattened_mut());
        self.0.extend_from_slice(&kept[..R::LANES]);
        self.0.truncate(len + count);
    }

    /// Removes all spectra.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Changes to `count` times the same spectrum.
    pub fn fill(&mut self, count: usize, value: f32) {
        fill(&mut self.0, count, [value; N]);
    }

    /// Makes place for `count` spectra, whatever they are.
    pub fn grow(&mut self, count: usize) {
        grow(&mut self.0, count);
    }

    /// The spectrum of a path.
    pub fn row(&self, row: usize) -> SampledSpectrum {
        SampledSpectrum(self.0[row])
    }

    /// Changes the spectrum of a path.
    pub fn set_row(&mut self, row: usize, s: SampledSpectrum) {
        self.0[row] = s.0;
    }

    /// The spectra of successive paths.
    #[inline(always)]
    pub fn load<R: Real>(&self, first: usize) -> SampledSpectrum<R> {
        let lanes = R::Int::from_fn(|lane| (N * lane) as u32);
        SampledSpectrum(R::gather_rows(self.0[first..].as_flattened(), lanes))
    }

    /// Changes the spectra of successive paths.
    #[inline(always)]
    pub fn store<R: Real>(&mut self, first: usize, s: SampledSpectrum<R>) {
        self.compress(first, R::Mask::splat(true), s);
    }

    /// Changes successive spectra to the lanes of a mask; those after them may be overwritten.
    #[inline(always)]
    pub fn compress<R: Real>(&mut self, first: usize, mask: R::Mask, s: SampledSpectrum<R>) {
        R::compress_four(s.0, mask, self.0[first..].as_flattened_mut());
    }

    /// The spectra of rows.
    #[inline(always)]
    pub fn get<R: Real>(&self, rows: Indices<R>) -> SampledSpectrum<R> {
        const { assert!(N == 4) };
        SampledSpectrum(R::gather_rows(self.0.as_flattened(), rows.indices.shl(2)))
    }

    /// Changes the spectra of a mask's lanes.
    #[inline(always)]
    pub fn set<R: Real>(&mut self, rows: Indices<R>, mask: R::Mask, s: SampledSpectrum<R>) {
        let mut spectra = [[0.0; N]; MAX_LANES];
        R::compress_four(s.0, R::Mask::splat(true), spectra.as_flattened_mut());
        rows.each_of(mask, |lane, row| self.0[row] = spectra[lane]);
    }
}
