//! The limit surface of a triangle mesh under Loop subdivision.
//!
//! Each level splits every triangle into four. A vertex with n neighbours moves to (1 − nβ)·v + β·Σ
//! neighbours, β = 3/16 for n = 3 and 3/(8n) otherwise; a new vertex on an edge is 3/8 of its
//! ends plus 1/8 of the two opposite corners. On the boundary the weights are those of a
//! cubic B-spline: 1/8, 3/4, 1/8 and 1/2, 1/2. Finally vertices move to their limits, by the
//! weight 1/(n + 3/(8β)), and normals are the cross products of the
//! limit's tangents ([Loop 1987]; [Hoppe 1994]; [Pharr 2016 §3.8]).
//!
//! Three things are as in pbrt. Normals are on the side from which triangles run clockwise, and
//! keep the length of the cross product. Tangents are computed from neighbours that are at their
//! limit already. On the boundary the limit weight is 1/5, where that of a B-spline is 1/6.
//!
//! Connectivity is kept by half-edges: number 3f + k leads from corner k of triangle f to the next;
//! its twin leads back. Twins of a level follow from those of the level before.

use super::arrays::{MAX_TRIANGLES, MeshArrays};
use crate::shape::MeshError;
use math::{DVec3, Point3};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// The twin of a half-edge on the boundary.
const NONE: u32 = u32::MAX;

/// Subdivides a mesh `levels` times, and moves its vertices to the limit.
pub fn loop_subdivision(
    positions: &[Point3],
    indices: &[[u32; 3]],
    levels: u32,
) -> Result<MeshArrays, MeshError> {
    let triangles = 4usize.checked_pow(levels).and_then(|parts| parts.checked_mul(indices.len()));
    if triangles.is_none_or(|n| n > MAX_TRIANGLES) {
        return Err(MeshError::TooLarge);
    }
    let mut mesh = Mesh::new(positions, indices)?;
    for _ in 0..levels {
        mesh = mesh.divided();
    }
    mesh.points = mesh.vertices().map(|v| mesh.limit(v)).collect();
    let positions = mesh.points.iter().map(|p| p.as_vec3().into()).collect();
    let normals = mesh.vertices().map(|v| mesh.normal(v).as_vec3().into()).collect();
    Ok(MeshArrays { positions, indices: mesh.faces, normals, uvs: Vec::new() })
}

struct Mesh {
    points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// The twin of each half-edge, or [`NONE`].
    twins: Vec<u32>,
    /// A half-edge that leaves each vertex: on the border, the one that has no twin.
    leaving: Vec<u32>,
}

/// The half-edges before and after one in its triangle.
fn previous(edge: u32) -> u32 {
    if edge.is_multiple_of(3) { edge + 2 } else { edge - 1 }
}

fn next(edge: u32) -> u32 {
    if edge % 3 == 2 { edge - 2 } else { edge + 1 }
}

impl Mesh {
    /// Builds the connectivity, without vertices that no triangle uses.
    fn new(positions: &[Point3], indices: &[[u32; 3]]) -> Result<Self, MeshError> {
        let mut number = vec![NONE; positions.len()];
        let mut mesh = Self { points: Vec::new(), faces: Vec::new(), twins: Vec::new(), leaving: Vec::new() };
        for (triangle, corners) in indices.iter().enumerate() {
            let mut face = [0; 3];
            for (to, &vertex) in face.iter_mut().zip(corners) {
                let Some(number) = number.get_mut(vertex as usize) else {
                    return Err(MeshError::Index { triangle, vertex });
                };
                if *number == NONE {
                    *number = mesh.points.len() as u32;
                    mesh.points.push(positions[vertex as usize].as_dvec3());
                }
                *to = *number;
            }
            mesh.faces.push(face);
        }
        let original = |v: u32| number.iter().position(|&n| n == v).unwrap_or_default() as u32;
        let mut between = HashMap::new();
        for edge in 0..3 * mesh.faces.len() as u32 {
            let ends = (mesh.origin(edge), mesh.origin(next(edge)));
            if ends.0 == ends.1 || between.insert(ends, edge).is_some() {
                return Err(MeshError::Edge([ends.0, ends.1].map(original)));
            }
        }
        mesh.twins = (0..3 * mesh.faces.len() as u32)
            .map(|edge| (mesh.origin(next(edge)), mesh.origin(edge)))
            .map(|ends| between.get(&ends).copied().unwrap_or(NONE))
            .collect();
        mesh.find_leaving();
        // All triangles of a vertex must be met on one way around it.
        let mut corners = vec![0usize; mesh.points.len()];
        mesh.faces.iter().flatten().for_each(|&v| corners[v as usize] += 1);
        for v in mesh.vertices() {
            if mesh.around(v).count() != corners[v as usize] {
                return Err(MeshError::Vertex(original(v)));
            }
        }
        Ok(mesh)
    }

    fn find_leaving(&mut self) {
        self.leaving = vec![NONE; self.points.len()];
        for edge in 0..self.twins.len() as u32 {
            let leaving = &mut self.leaving[self.faces[edge as usize / 3][edge as usize % 3] as usize];
            if *leaving == NONE || self.twins[edge as usize] == NONE {
                *leaving = edge;
            }
        }
    }

    fn origin(&self, edge: u32) -> u32 {
        self.faces[edge as usize / 3][edge as usize % 3]
    }

    fn twin(&self, edge: u32) -> Option<u32> {
        Some(self.twins[edge as usize]).filter(|&twin| twin != NONE)
    }

    /// The half-edges that leave a vertex, counterclockwise; on the border from its one end to the
    /// other.
    fn around(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let first = self.leaving[vertex as usize];
        std::iter::successors(Some(first), move |&edge| self.twin(previous(edge)).filter(|&e| e != first))
    }

    fn is_border(&self, vertex: u32) -> bool {
        self.twin(self.leaving[vertex as usize]).is_none()
    }

    fn vertices(&self) -> std::ops::Range<u32> {
        0..self.points.len() as u32
    }

    fn point(&self, vertex: u32) -> DVec3 {
        self.points[vertex as usize]
    }

    /// The neighbours of a vertex, in the order of [`Self::around`].
    fn ring(&self, vertex: u32) -> Vec<DVec3> {
        let ends = self.around(vertex).map(|edge| self.point(self.origin(next(edge))));
        // The border's other end is where no further edge leaves to.
        let last = self.around(vertex).last().filter(|_| self.is_border(vertex));
        ends.chain(last.map(|edge| self.point(self.origin(previous(edge))))).collect()
    }

    /// A vertex and its neighbours, weighted: on the border by `border` for the two along it, else
    /// by `inner` of their number.
    fn weighted(&self, vertex: u32, inner: impl Fn(f64) -> f64, border: f64) -> DVec3 {
        let (p, ring) = (self.point(vertex), self.ring(vertex));
        if self.is_border(vertex) {
            return p * (1.0 - 2.0 * border) + (ring[0] + ring[ring.len() - 1]) * border;
        }
        let n = ring.len() as f64;
        p * (1.0 - n * inner(n)) + ring.iter().sum::<DVec3>() * inner(n)
    }

    fn limit(&self, vertex: u32) -> DVec3 {
        self.weighted(vertex, |n| 1.0 / (n + 3.0 / (8.0 * beta(n))), 1.0 / 5.0)
    }

    /// The normal at a vertex, by tangents whose weights of the neighbours sum to zero. Both are at
    /// their limit.
    fn normal(&self, vertex: u32) -> DVec3 {
        let ring = self.ring(vertex);
        let n = ring.len();
        if !self.is_border(vertex) {
            let sum = |weight: fn(f64) -> f64| {
                let weighted = |(j, &p): (usize, &DVec3)| p * weight(TAU * j as f64 / n as f64);
                ring.iter().enumerate().map(weighted).sum::<DVec3>()
            };
            return sum(libm::sin).cross(sum(libm::cos));
        }
        let (first, last, p) = (ring[0], ring[n - 1], self.point(vertex));
        let inward = match ring[..] {
            [_, _] => first + last - p * 2.0,
            [_, middle, _] => middle - p,
            [_, a, b, _] => (a + b) * 2.0 - first - last - p * 2.0,
            _ => {
                let theta = PI / (n - 1) as f64;
                let inner = (1..n - 1).map(|k| ring[k] * libm::sin(k as f64 * theta)).sum::<DVec3>();
                inner * (2.0 - 2.0 * libm::cos(theta)) - (first + last) * libm::sin(theta)
            }
        };
        (last - first).cross(inward)
    }

    /// The next level. Triangle f becomes 4f, 4f + 1, 4f + 2 at its corners, and 4f + 3 between
    /// them.
    fn divided(&self) -> Self {
        let edges = self.twins.len() as u32;
        let mut points: Vec<DVec3> = self.vertices().map(|v| self.weighted(v, beta, 1.0 / 8.0)).collect();
        let mut middles = vec![NONE; edges as usize];
        for edge in 0..edges {
            if middles[edge as usize] != NONE {
                continue;
            }
            middles[edge as usize] = points.len() as u32;
            let ends = self.point(self.origin(edge)) + self.point(self.origin(next(edge)));
            let facing = |edge: u32| self.point(self.origin(previous(edge)));
            points.push(match self.twin(edge) {
                None => ends * 0.5,
                Some(twin) => {
                    middles[twin as usize] = points.len() as u32;
                    ends * 0.375 + (facing(edge) + facing(twin)) * 0.125
                }
            });
        }
        let mut faces = Vec::with_capacity(4 * self.faces.len());
        let mut twins = Vec::with_capacity(12 * self.faces.len());
        for (f, &[a, b, c]) in self.faces.iter().enumerate() {
            let [ab, bc, ca] = [0, 1, 2].map(|k| middles[3 * f + k]);
            faces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
            // Half-edge k of the old triangle begins as one of child k, and ends as one of the
            // child after that.
            let beginning = |edge: u32| 12 * (edge / 3) + 4 * (edge % 3);
            let ending = |edge: u32| 12 * (edge / 3) + 3 * (next(edge) % 3) + edge % 3;
            let old = |k: u32| 3 * f as u32 + k;
            let begins_beside = |k: u32| self.twin(old(k)).map_or(NONE, ending);
            let ends_beside = |k: u32| self.twin(old(k)).map_or(NONE, beginning);
            let inner = |child: u32, k: u32| 12 * f as u32 + 3 * child + k;
            twins.extend([begins_beside(0), inner(3, 2), ends_beside(2)]);
            twins.extend([ends_beside(0), begins_beside(1), inner(3, 0)]);
            twins.extend([inner(3, 1), ends_beside(1), begins_beside(2)]);
            twins.extend([inner(1, 2), inner(2, 0), inner(0, 1)]);
        }
        let mut divided = Self { points, faces, twins, leaving: Vec::new() };
        divided.find_leaving();
        divided
    }
}

/// The weight of each of n neighbours.
fn beta(n: f64) -> f64 {
    if n == 3.0 { 3.0 / 16.0 } else { 3.0 / (8.0 * n) }
}
