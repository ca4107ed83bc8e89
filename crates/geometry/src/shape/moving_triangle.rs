//! Deforming meshes: vertex positions are given at uniformly spaced times and interpolated
//! linearly.
//!
//! With keys k = 0 … n − 1 over the times t₀ … t₁, let x = (n − 1)·(t − t₀)/(t₁ − t₀), clamped to
//! the keys; a vertex is then at (1 − f)·p_k + f·p_{k+1}, k = ⌊x⌋, f = x − k. Normals and tangents
//! follow the same way. All triangles at a vertex compute the same point, so that no ray passes
//! between them. Moving triangles have no fixed area and are not sampled.

use super::mesh::TriangleMesh;
use super::sample::{ShapeHit, ShapeSample};
use super::triangle::Triangle;
use crate::surface::SurfacePoint;
use crate::watertight::Sheared;
use math::{Bounds3, Point3, Ray, Vec2, Vec3, gamma};
use std::sync::Arc;

/// A deforming mesh.
#[derive(Clone, Debug)]
pub struct MovingMesh {
    keys: Vec<TriangleMesh>,
    times: [f32; 2],
}

impl MovingMesh {
    /// A mesh that interpolates its keys; it is at rest before the first and after the last.
    ///
    /// # Panics
    /// When there is no key, or keys differ in the number of their triangles.
    pub fn new(keys: Vec<TriangleMesh>, times: [f32; 2]) -> Self {
        assert!(!keys.is_empty(), "a moving mesh has a key");
        assert!(keys.iter().all(|key| key.len() == keys[0].len()), "all keys have the same triangles");
        Self { keys, times }
    }

    /// All triangles as shapes.
    pub fn triangles(self) -> impl Iterator<Item = MovingTriangle> {
        let mesh = Arc::new(self);
        (0..mesh.keys[0].len() as u32).map(move |triangle| MovingTriangle { mesh: mesh.clone(), triangle })
    }

    /// The key before a time, and the fraction of the way to the next.
    fn key(&self, time: f32) -> (usize, f32) {
        let last = self.keys.len() - 1;
        let [start, end] = self.times;
        let x = (time - start) / (end - start) * last as f32;
        // Written so that NaN, where both times are equal, is the start.
        let x = if x > 0.0 { x.min(last as f32) } else { 0.0 };
        let key = (x as usize).min(last.saturating_sub(1));
        (key, x - key as f32)
    }
}

/// A triangle of a deforming mesh.
#[derive(Clone, Debug)]
pub struct MovingTriangle {
    mesh: Arc<MovingMesh>,
    triangle: u32,
}

impl MovingTriangle {
    /// The triangle at a time.
    pub fn at(&self, time: f32) -> Triangle {
        let (key, fraction) = self.mesh.key(time);
        let triangle = |key: usize| self.mesh.keys[key].triangle(self.triangle as usize);
        let start = triangle(key);
        if fraction == 0.0 {
            return start;
        }
        let end = triangle(key + 1);
        Triangle {
            p: mixed(start.p, end.p, fraction),
            n: start.n.zip(end.n).map(|(a, b)| mixed(a, b, fraction)),
            s: start.s.zip(end.s).map(|(a, b)| mixed(a, b, fraction)),
            ..start
        }
    }

    fn corners(&self, time: f32) -> [Point3; 3] {
        let (key, fraction) = self.mesh.key(time);
        let corners = |key: usize| self.mesh.keys[key].corners(self.triangle as usize);
        if fraction == 0.0 { corners(key) } else { mixed(corners(key), corners(key + 1), fraction) }
    }

    /// A box around it at all times, with a margin for rounding between keys.
    pub(super) fn bounds(&self) -> Option<Bounds3> {
        let corners = self.mesh.keys.iter().flat_map(|key| key.corners(self.triangle as usize));
        let bounds = Bounds3::around(corners);
        Some(bounds.expand(bounds.min.abs().max(bounds.max.abs()).max_element() * gamma(3)))
    }

    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<ShapeHit> {
        Sheared::new(ray).triangle(&self.corners(ray.time), t_max).map(|(t, uv)| ShapeHit { t, uv })
    }

    pub(super) fn surface(&self, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        self.at(ray.time).surface(ray, hit.uv)
    }

    pub(super) fn area(&self) -> f32 {
        0.0
    }

    pub(super) fn sample(&self, _: Vec2) -> Option<ShapeSample> {
        None
    }
}

fn mixed(a: [Vec3; 3], b: [Vec3; 3], fraction: f32) -> [Vec3; 3] {
    [0, 1, 2].map(|i| a[i] * (1.0 - fraction) + b[i] * fraction)
}
