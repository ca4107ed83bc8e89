//! The resolution of pictures while the camera moves.

use std::time::Duration;

use alhazen::math::Bounds2i;

/// The share of the target that a finer picture may be expected to take, so that the resolution
/// does not alternate.
const MARGIN: f64 = 0.85;

/// The fewest pixels of a draft's shorter side.
const LEAST_SIDE: u32 = 24;

/// Chooses how coarse pictures are, so that each takes about the same time: it measures what a
/// sample costs.
#[derive(Clone, Debug)]
pub struct Pace {
    target: Duration,
    /// The pixels of the whole picture.
    full: Bounds2i,
    n: u32,
    /// Seconds that a sample of a pixel takes, smoothed.
    cost: f64,
    /// The drafts that it was learnt from.
    drafts: u32,
}

impl Pace {
    /// For frames that take this long, of pictures with these pixels. The first has an eighth of
    /// them along each side.
    pub fn new(target: Duration, full: Bounds2i) -> Self {
        let mut pace = Self { target, full, n: 1, cost: 0.0, drafts: 0 };
        pace.n = 8.min(pace.most());
        pace
    }

    /// Pixels of the picture along a side of a pixel of the next draft.
    pub fn n(&self) -> u32 {
        self.n
    }

    /// Learns from a draft of `pixels` pixels with `samples` samples each, which took `time`.
    pub fn after(&mut self, pixels: usize, samples: u32, time: Duration) {
        let samples = f64::from(samples.max(1));
        let cost = time.as_secs_f64() / (pixels.max(1) as f64 * samples);
        // The first draft also compiles kernels and fills caches, so that its cost is replaced.
        self.cost = if self.drafts < 2 { cost } else { 0.5 * (self.cost + cost) };
        self.drafts += 1;
        let all = self.full.area() as f64 * samples * self.cost;
        let side = |share: f64| (all / (share * self.target.as_secs_f64())).sqrt().ceil().max(1.0) as u32;
        let (coarser, finer) = (side(1.0), side(MARGIN));
        // Between the two the resolution is good as it is.
        self.n = if self.n < coarser { coarser } else { self.n.min(finer) }.min(self.most());
    }

    fn most(&self) -> u32 {
        (self.full.width().min(self.full.height()) as u32 / LEAST_SIDE).max(1)
    }
}
