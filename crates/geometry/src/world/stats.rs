//! Counters of the work done for rays.

use std::ops::AddAssign;

/// Numbers of rays and of intersection tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayStats {
    /// Rays traced.
    pub rays: u64,
    /// Tests of a ray, or of a ray packet, against a bounding volume. Boxes are tested in nodes of
    /// sixteen, which count as sixteen however many children they have.
    pub extents: u64,
    /// Tests of a ray against a primitive. Triangles are tested in blocks of four, which count as
    /// four however many lanes are in use.
    pub primitives: u64,
}

impl AddAssign for RayStats {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.extents += other.extents;
        self.primitives += other.primitives;
    }
}
