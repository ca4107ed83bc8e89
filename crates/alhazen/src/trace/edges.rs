//! The rays of a trace as lines.

use math::Vec3;

use super::{PixelTrace, TraceStep};

/// Rays that leave the scene, or end at infinity, are drawn this long.
fn shown_length(trace: &PixelTrace) -> f32 {
    let points: Vec<Vec3> = ends(trace, 0.0).into_iter().flat_map(|edge| edge.ends).collect();
    let low = points.iter().fold(Vec3::splat(f32::INFINITY), |low, p| low.min(*p));
    let high = points.iter().fold(Vec3::splat(f32::NEG_INFINITY), |high, p| high.max(*p));
    let size = (high - low).length();
    if size.is_finite() && size > 0.0 { 0.3 * size } else { 1.0 }
}

/// What an edge is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeKind {
    /// A ray of a path, which hits something.
    Path,
    /// A ray that leaves the scene.
    Escape,
    /// A shadow ray that reaches a light.
    Light,
    /// A shadow ray that does not.
    Shadow,
}

/// A ray as a line.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Its ends in world space.
    pub ends: [Vec3; 2],
    /// What it is.
    pub kind: EdgeKind,
}

impl PixelTrace {
    /// The rays as lines, those without an end not much longer than the others.
    pub fn edges(&self) -> Vec<Edge> {
        ends(self, shown_length(self))
    }
}

impl EdgeKind {
    /// The colour of its edges, in sRGB: blue of paths, orange of shadow rays that reach a light,
    /// grey of others.
    pub fn color(self) -> [u8; 3] {
        match self {
            Self::Path | Self::Escape => [31, 90, 200],
            Self::Light => [230, 140, 0],
            Self::Shadow => [120, 120, 120],
        }
    }
}

/// The rays of a trace; `far` is the length of those without an end.
fn ends(trace: &PixelTrace, far: f32) -> Vec<Edge> {
    let steps = trace.samples.iter().flat_map(|sample| &sample.steps);
    let edge = |step: &TraceStep| match step {
        TraceStep::Ray { from, d, hit, .. } => {
            let (length, kind) = match hit {
                Some((length, _)) => (*length, EdgeKind::Path),
                None => (far, EdgeKind::Escape),
            };
            Some(Edge { ends: [*from, *from + *d * length], kind })
        }
        TraceStep::Shadow { from, d, length, is_clear } => {
            let length = if length.is_finite() { *length } else { far };
            let kind = if *is_clear { EdgeKind::Light } else { EdgeKind::Shadow };
            Some(Edge { ends: [*from, *from + *d * length], kind })
        }
        _ => None,
    };
    steps.filter_map(edge).collect()
}
