//! Points where paths leave bodies.

use geometry::{PointColumns, SurfacePoint};
use math::Ray;

use super::segment_columns::{OptionalColumns, SegmentColumns};
use crate::transport::path_state::PathState;

/// The points where paths leave bodies, in columns.
#[derive(Default)]
pub(super) struct Exits {
    /// The paths, as if rays along their shading normals had come to these points.
    pub segments: SegmentColumns,
    pub points: PointColumns,
    /// The indices of the paths.
    pub hit_indices: Vec<u32>,
}

impl Exits {
    /// Makes room for as many paths, and has none.
    pub fn start(&mut self, count: usize) {
        self.segments.start(count, OptionalColumns { differentials: false, media: false });
        self.points.grow(count);
        self.hit_indices.clear();
    }

    /// Adds a path that has been scattered `depth` times before it entered.
    pub fn push(&mut self, row: u32, state: &PathState, exit: &SurfacePoint, depth: u32) {
        let hit_index = self.segments.rows.len();
        let SurfacePoint { p, shading, time, .. } = exit;
        let ray = Ray::new(p.p, -shading.n, *time);
        let PathState { beta, eta_scale, .. } = *state;
        self.segments.push(row, &PathState { beta, eta_scale, ..PathState::new(ray.into(), depth) });
        self.points.set_one(hit_index, exit);
        self.hit_indices.push(hit_index as u32);
    }
}
