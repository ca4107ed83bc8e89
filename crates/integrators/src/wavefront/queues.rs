//! What stages hand to each other.

use super::segment_columns::SegmentColumns;
use super::shadows::{Passages, ShadowRays};
use super::spectrum_column::SpectrumColumn;
use crate::transport::path_state::PathState;

/// The queues of a batch.
#[derive(Default)]
pub(super) struct Queues {
    /// The paths that go on.
    pub next: SegmentColumns,
    /// Hits to be shaded one by one.
    pub scalar: Vec<PathHit>,
    /// Shadow rays; those that interfaces occlude, and those that pass them.
    pub shadows: [ShadowRays; 2],
    /// Those of scenes with media.
    pub passages: Passages,
    pub waiting: Waiting,
    /// Paths that go on under the surface of a body.
    pub entering: Entering,
}

/// A hit of a path.
#[derive(Clone, Copy)]
pub(super) struct PathHit {
    /// The index of the path.
    pub path: u32,
    /// The index of the hit.
    pub hit: u32,
}

/// Paths that go on under the surface of a body, in the order of their hits.
#[derive(Default)]
pub(super) struct Entering {
    pub rows: Vec<u32>,
    pub hit_indices: Vec<u32>,
    /// Throughput beyond the boundary.
    pub beta: SpectrumColumn,
}

/// Rays that wait until their path has no other: a stack for each path. All stacks share memory,
/// because most paths have none.
#[derive(Default)]
pub(super) struct Waiting {
    /// The rays, each with the index of the one below it.
    rays: Vec<(Option<PathState>, u32)>,
    /// The index of the last ray of each path, as far as there is one.
    last: Vec<u32>,
}

impl Waiting {
    const NONE: u32 = u32::MAX;

    /// Removes all rays.
    pub fn clear(&mut self) {
        self.rays.clear();
        self.last.clear();
    }

    /// Whether no ray has waited.
    pub fn is_empty(&self) -> bool {
        self.rays.is_empty()
    }

    /// Adds a ray of a path.
    pub fn push(&mut self, path: u32, state: PathState) {
        let path = path as usize;
        if self.last.len() <= path {
            self.last.resize(path + 1, Self::NONE);
        }
        let below = std::mem::replace(&mut self.last[path], self.rays.len() as u32);
        self.rays.push((Some(state), below));
    }

    /// Takes the last ray of a path.
    pub fn pop(&mut self, path: u32) -> Option<PathState> {
        let last = self.last.get_mut(path as usize)?;
        let (state, below) = self.rays.get_mut(*last as usize)?;
        *last = *below;
        state.take()
    }
}
