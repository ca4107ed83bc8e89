//! What stages hand to each other.

use super::segments::Segments;
use super::shadows::{Passages, ShadowRays};
use crate::transport::path_state::PathState;

/// The queues of a batch.
#[derive(Default)]
pub(super) struct Queues {
    /// The paths that go on.
    pub next: Segments,
    /// Hits to be shaded one by one: path, and index of its hit.
    pub scalar: Vec<(u32, u32)>,
    /// Shadow rays; those that interfaces occlude, and those that pass them.
    pub shadows: [ShadowRays; 2],
    /// Those of scenes with media.
    pub passages: Passages,
    /// Rays that wait until their path has no other, the last first; one stack for each path.
    pub waiting: Vec<Vec<PathState>>,
}

impl Queues {
    /// Lets a ray of a path wait.
    pub fn wait(&mut self, path: u32, state: PathState) {
        let path = path as usize;
        if self.waiting.len() <= path {
            self.waiting.resize_with(path + 1, Vec::new);
        }
        self.waiting[path].push(state);
    }
}
