//! Paths by stages.

use super::record;

/// The most queues of `shaders/wavefront/queues.wgsl`.
pub const MAX_QUEUES: usize = 17;

record! {
    /// The samples of a rectangle of pixels, of each as many as of the others from an index on; and
    /// the places for paths. Each sample has a number: those of the first index come first, row by
    /// row.
    pub struct Batch {
        low: [u32; 2],
        size: [u32; 2],
        index: u32,
        samples: u32,
        places: u32,
        /// The kinds of materials that are hit, a bit for each, and the number of queues of hits.
        kinds: u32,
        sorts: u32,
        /// Of a turn: the number of the first sample that begins and how many do, the paths that go
        /// on, and the shadow rays of the turn before.
        first: u32,
        beginning: u32,
        going_on: u32,
        shadows: u32,
        /// The turns so far that had paths, and the paths of all of them.
        turns: u32,
        paths: u32,
        lengths: [u32; MAX_QUEUES] as "array<atomic<u32>, QUEUES>",
    }
    "queues: array<u32>"
}
