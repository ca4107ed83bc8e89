//! Points where paths leave bodies.

use geometry::{PointColumns, SurfacePoint};
use math::Ray;

use super::segments::{Besides, Segments};
use crate::transport::path_state::PathState;

/// The points where paths leave bodies, in columns.
#[derive(Default)]
pub(super) struct Exits {
    /// The paths, as if rays along their shading normals had come to these points.
    pub segments: Segments,
    pub points: PointColumns,
    /// The indices of the paths.
    pub turns: Vec<u32>,
}

impl Exits {
    /// Makes room for as many paths, and has none.
    pub fn start(&mut self, count: usize) {
        self.segments.start(count, Besides { differentials: false, media: false });
        self.points.grow(count);
        self.turns.clear();
    }

    /// Adds a path that has been scattered `depth` times before it entered.
    pub fn push(&mut self, row: u32, state: &PathState, exit: &SurfacePoint, depth: u32) {
        let turn = self.segments.rows.len();
        let SurfacePoint { p, shading, time, .. } = exit;
        let ray = Ray::new(p.p, -shading.n, *time);
        let PathState { beta, eta_scale, .. } = *state;
        self.segments.push(row, &PathState { beta, eta_scale, ..PathState::new(ray.into(), depth) });
        self.points.set_one(turn, exit);
        self.turns.push(turn as u32);
    }
}
