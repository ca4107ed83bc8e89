//! How many samples each pixel takes, where that differs.

use math::Bounds2i;

/// How many samples each pixel takes.
#[derive(Clone, Debug)]
pub(crate) struct SampleCounts {
    bounds: Bounds2i,
    /// The most samples of a pixel; what follows repeats these.
    most: u32,
    /// Row by row.
    counts: Vec<u32>,
}

impl SampleCounts {
    /// Of the pixels of a rectangle, row by row, each of the next `most` samples.
    ///
    /// # Panics
    /// If there are not as many counts as pixels.
    pub fn new(bounds: Bounds2i, most: u32, counts: Vec<u32>) -> Self {
        assert_eq!(bounds.area(), counts.len());
        Self { bounds, most, counts }
    }

    /// Whether a pixel of the rectangle takes the sample of an index.
    pub fn takes(&self, [x, y]: [i32; 2], index: u32) -> bool {
        let [column, row] = [x - self.bounds.min[0], y - self.bounds.min[1]].map(|i| i as usize);
        index % self.most < self.counts[row * self.bounds.width() as usize + column]
    }

    /// The mean number of samples of a pixel.
    pub fn mean(&self) -> f64 {
        let sum: u64 = self.counts.iter().map(|&count| u64::from(count)).sum();
        sum as f64 / self.counts.len() as f64
    }
}
