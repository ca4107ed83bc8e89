//! The picture of a render at one time, with all its layers, for those who watch the render.

use alhazen::image::{Channel, ImageMetadata, PixelSource};
use rayon::prelude::*;

/// A picture in memory.
pub struct Snapshot {
    /// Counts the snapshots of a render, from 1.
    pub revision: u32,
    width: u32,
    height: u32,
    channels: Vec<Channel>,
    metadata: ImageMetadata,
    /// Rows from the top, pixels from the left, channels.
    values: Vec<f32>,
}

impl Snapshot {
    /// Copies a picture, on all threads; `None` where there is no memory for it.
    pub fn take(picture: &dyn PixelSource, revision: u32) -> Option<Self> {
        let (width, height, channels) = (picture.width(), picture.height(), picture.channels());
        let row = width as usize * channels.len();
        let mut values = Vec::new();
        values.try_reserve_exact(row.checked_mul(height as usize)?).ok()?;
        values.resize(row * height as usize, 0.0);
        values.par_chunks_exact_mut(row).enumerate().for_each(|(y, values)| picture.row(y as u32, values));
        Some(Self { revision, width, height, channels, metadata: picture.metadata().clone(), values })
    }
}

impl PixelSource for Snapshot {
    fn width(&self) -> u32 {
        self.width
    }

    fn height(&self) -> u32 {
        self.height
    }

    fn channels(&self) -> Vec<Channel> {
        self.channels.clone()
    }

    fn metadata(&self) -> &ImageMetadata {
        &self.metadata
    }

    fn row(&self, y: u32, values: &mut [f32]) {
        let first = y as usize * values.len();
        values.copy_from_slice(&self.values[first..first + values.len()]);
    }
}
