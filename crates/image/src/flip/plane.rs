//! One channel of a picture and its convolution.

use rayon::prelude::*;

/// One channel, row by row.
#[derive(Clone)]
pub struct Plane {
    width: usize,
    pub values: Vec<f32>,
}

impl Plane {
    pub fn new(width: usize, values: Vec<f32>) -> Self {
        Self { width, values }
    }

    /// The convolution with `column` ⊗ `row`, both of odd length; edge pixels are repeated beyond
    /// the edges.
    pub fn convolved(&self, row: &[f32], column: &[f32]) -> Self {
        let width = self.width;
        let height = self.values.len() / width;
        let mut across = vec![0.0; self.values.len()];
        across.par_chunks_mut(width).zip(self.values.par_chunks(width)).for_each(|(target, source)| {
            for (x, value) in target.iter_mut().enumerate() {
                *value = row
                    .iter()
                    .enumerate()
                    .map(|(tap, weight)| weight * source[near(x, tap, row, width)])
                    .sum();
            }
        });
        let mut both = vec![0.0; self.values.len()];
        both.par_chunks_mut(width).enumerate().for_each(|(y, target)| {
            for (tap, weight) in column.iter().enumerate() {
                let source = &across[near(y, tap, column, height) * width..][..width];
                for (value, sample) in target.iter_mut().zip(source) {
                    *value += weight * sample;
                }
            }
        });
        Self { width, values: both }
    }
}

/// The index that tap `tap` of `kernel`, centred at `position`, reads.
fn near(position: usize, tap: usize, kernel: &[f32], size: usize) -> usize {
    (position + tap).saturating_sub(kernel.len() / 2).min(size - 1)
}
