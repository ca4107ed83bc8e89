//! What rays cost.

use std::ops::AddAssign;

/// Counts of the work done for rays, so that one sees what bounding volumes save.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayStats {
    /// Rays traced.
    pub rays: u64,
    /// Tests of a ray, or of a beam around several, against an extent (a bounding volume).
    pub extents: u64,
    /// Tests of a ray against a primitive. Triangles are tested by fours, which count as four
    /// however many there are.
    pub primitives: u64,
}

impl AddAssign for RayStats {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.extents += other.extents;
        self.primitives += other.primitives;
    }
}
