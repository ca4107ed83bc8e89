//! Changing the size of an image by a windowed sinc filter.
//!
//! A new texel at source position p is Σ w(i + ½ − p) v_i / Σ w(i + ½ − p) along x, then along y,
//! with w(x) = sinc(x / s) · sinc(x / (2s)) for |x| < 2s, sinc(x) = sin(πx) / (πx), and s = max(1,
//! old size / new size), so that a smaller image is low-passed. Results are clamped to ≥ 0, as the
//! filter's negative lobes may ring. Enlarging is what pbrt-v4 does to make texture sizes powers of
//! two. Source: [Pharr 2023 §10.4.3].

use std::f32::consts::PI;

use rayon::prelude::*;

use crate::{
    error::ImageError,
    image::{Image, Pixels},
    memory::filled,
    wrap::WrapMode,
};

/// Radius of the filter, in source texels where the image grows.
const RADIUS: f32 = 2.0;

/// The normalised weights of consecutive source texels, of which one new texel is made.
struct Taps {
    first: i32,
    weights: Vec<f32>,
}

impl Image {
    /// The image at another size, stored as single floats; `wrap` gives the texels beyond the
    /// edges. Refused where there is no memory for it.
    pub fn resize(&self, width: u32, height: u32, wrap: WrapMode) -> Result<Self, ImageError> {
        if width == 0 || height == 0 {
            return Err(ImageError::Invalid(format!("cannot resize to {width} × {height} pixels")));
        }
        let count = self.channel_count();
        let new_row = width as usize * count;
        let mut values = filled(new_row.saturating_mul(height as usize), 0.0)?;
        let (columns, rows) = (taps(self.width(), width), taps(self.height(), height));
        let (x0, x1) = extent(&columns);
        let (y0, y1) = extent(&rows);

        let mut narrow = filled((y1 - y0) as usize * new_row, 0.0)?;
        narrow.par_chunks_mut(new_row).zip(y0..y1).for_each(|(target, y)| {
            let mut source = vec![0.0; (x1 - x0) as usize * count];
            for (texel, x) in source.chunks_exact_mut(count).zip(x0..x1) {
                if let Some((x, y)) = wrap.apply(x, y, self.width(), self.height()) {
                    self.pixel(x, y, texel);
                }
            }
            match count {
                1 => weigh::<1>(target, &source, &columns, x0),
                2 => weigh::<2>(target, &source, &columns, x0),
                3 => weigh::<3>(target, &source, &columns, x0),
                4 => weigh::<4>(target, &source, &columns, x0),
                _ => {
                    for (texel, taps) in target.chunks_exact_mut(count).zip(&columns) {
                        let near = source[(taps.first - x0) as usize * count..].chunks_exact(count);
                        accumulate(texel, near.zip(&taps.weights));
                    }
                }
            }
        });

        values.par_chunks_mut(new_row).zip(&rows).for_each(|(target, taps)| {
            let near = narrow[(taps.first - y0) as usize * new_row..].chunks_exact(new_row);
            accumulate(target, near.zip(&taps.weights));
            target.iter_mut().for_each(|value| *value = value.max(0.0));
        });
        let mut image = Self::new(width, height, self.channels(), Pixels::F32(values))?;
        image.metadata = self.metadata.clone();
        (image.metadata.data_window, image.metadata.display_window) = (None, None);
        Ok(image)
    }
}

/// New texels of `N` channels from a row of old ones, of which `x0` is the first.
fn weigh<const N: usize>(target: &mut [f32], source: &[f32], columns: &[Taps], x0: i32) {
    let source = source.as_chunks::<N>().0;
    for (texel, taps) in target.as_chunks_mut::<N>().0.iter_mut().zip(columns) {
        for (near, weight) in source[(taps.first - x0) as usize..].iter().zip(&taps.weights) {
            for (sum, value) in texel.iter_mut().zip(near) {
                *sum += weight * value;
            }
        }
    }
}

/// Adds weighted slices to `target`.
fn accumulate<'a>(target: &mut [f32], weighted: impl Iterator<Item = (&'a [f32], &'a f32)>) {
    for (source, weight) in weighted {
        for (sum, value) in target.iter_mut().zip(source) {
            *sum += weight * value;
        }
    }
}

/// The range of source texels that some new texel needs.
fn extent(taps: &[Taps]) -> (i32, i32) {
    let first = taps.iter().map(|taps| taps.first).min().unwrap_or(0);
    let end = taps.iter().map(|taps| taps.first + taps.weights.len() as i32).max().unwrap_or(0);
    (first, end)
}

fn taps(old_size: u32, new_size: u32) -> Vec<Taps> {
    let stretch = (old_size as f32 / new_size as f32).max(1.0);
    let radius = RADIUS * stretch;
    let tap_count = (2.0 * radius).ceil() as i32;
    (0..new_size)
        .map(|texel| {
            let center = (texel as f32 + 0.5) * old_size as f32 / new_size as f32;
            let first = (center - radius + 0.5).floor() as i32;
            let mut weights: Vec<f32> = (first..first + tap_count)
                .map(|source| windowed_sinc((source as f32 + 0.5 - center) / stretch))
                .collect();
            let sum: f32 = weights.iter().sum();
            weights.iter_mut().for_each(|weight| *weight /= sum);
            Taps { first, weights }
        })
        .collect()
}

fn windowed_sinc(x: f32) -> f32 {
    if x.abs() > RADIUS { 0.0 } else { sinc(x) * sinc(x / RADIUS) }
}

fn sinc(x: f32) -> f32 {
    let x = PI * x;
    if 1.0 - x * x == 1.0 { 1.0 } else { lanes::sin(x) / x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_without_memory_is_refused() {
        let image = Image::from_fn(1, 1, ["Y"], |_, _| [1.0]);
        let result = image.resize(1 << 30, 1 << 30, WrapMode::Repeat);
        assert!(matches!(result, Err(ImageError::Limits(_))));
    }

    #[test]
    fn a_constant_stays_constant() {
        let image = Image::from_fn(5, 3, ["R", "G"], |_, _| [0.25, 4.0]);
        for wrap in [WrapMode::Repeat, WrapMode::Clamp, WrapMode::OctahedralSphere] {
            for (width, height) in [(8, 4), (2, 9), (5, 3), (1, 1)] {
                let resized = image.resize(width, height, wrap).unwrap();
                for (index, value) in resized.values().enumerate() {
                    let expected = [0.25, 4.0][index % 2];
                    assert!((value - expected).abs() < 1e-5 * expected, "{value}");
                }
            }
        }
    }

    #[test]
    fn the_same_size_changes_nothing() {
        let image = Image::from_fn(6, 5, ["Y"], |x, y| [(x * 7 + y * 3) as f32]);
        let same = image.resize(6, 5, WrapMode::Repeat).unwrap();
        for (a, b) in image.values().zip(same.values()) {
            assert!((a - b).abs() < 1e-4);
        }
    }

    #[test]
    fn a_ramp_is_followed_in_both_directions() {
        let image = Image::from_fn(32, 1, ["Y"], |x, _| [x as f32 + 0.5]);
        for new_size in [64, 16] {
            let resized = image.resize(new_size, 1, WrapMode::Clamp).unwrap();
            for x in new_size / 4..3 * new_size / 4 {
                let expected = (x as f32 + 0.5) * 32.0 / new_size as f32;
                assert!((resized.channel(x, 0, 0) - expected).abs() < 0.05);
            }
        }
    }
}
