//! Indices of paths and of hits, in lanes.

use lanes::{Int, Mask, Real};

/// Indices of elements of columns, one for each lane.
#[derive(Clone, Copy)]
pub(super) struct Indices<R: Real> {
    /// The indices; lanes that are not active repeat one of them.
    pub indices: R::Int,
    /// The lanes in use.
    pub active: R::Mask,
}

impl<R: Real> Indices<R> {
    /// The first of a queue, which must not be empty.
    #[inline(always)]
    pub fn first(queue: &[u32]) -> Self {
        let count = queue.len().min(R::LANES);
        let indices = if queue.len() >= R::LANES {
            R::Int::load(queue)
        } else {
            R::Int::from_fn(|lane| queue[lane.min(count - 1)])
        };
        Self { indices, active: R::Mask::from_bits(u32::MAX >> (32 - count)) }
    }

    /// Calls `f` with lane and index of each lane of a mask.
    #[inline(always)]
    pub fn each_of(&self, mask: R::Mask, mut f: impl FnMut(usize, usize)) {
        let indices = self.indices.to_array();
        let mut bits = mask.bits();
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize;
            f(lane, indices[lane] as usize);
            bits &= bits - 1;
        }
    }
}

/// Indices of paths in a batch: rows of its [`PathColumns`](super::path_columns::PathColumns).
pub(super) type PathIndices<R> = Indices<R>;

/// Indices of hits, which are those of the rays: rows of
/// [`SegmentColumns`](super::segment_columns::SegmentColumns).
pub(super) type HitIndices<R> = Indices<R>;
