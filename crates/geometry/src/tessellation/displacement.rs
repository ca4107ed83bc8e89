//! Displacement: a mesh is refined until its edges are short, then its vertices are moved along
//! their normals.
//!
//! A triangle with an edge that is too long is bisected at the midpoint of its longest edge.
//! Whether an edge is split depends on the edge alone, so that there are no cracks ([Rivara 1984]).
//! New normals are those of the displaced surface: at each vertex the mean of its triangles'
//! normals.

use super::arrays::{MAX_TRIANGLES, MeshArrays};
use crate::shape::MeshError;
use math::{Normal3, Point3, Transform, Vec2};
use std::collections::HashMap;

/// Refines a mesh with texture coordinates until all edges are shorter than `edge_length` in render
/// space, and displaces it by `height` along its normals (those of its triangles, where it has
/// none). `height` is a function of a vertex's position, unit normal and texture coordinates.
pub fn displaced(
    mut mesh: MeshArrays,
    render_from_object: &Transform,
    edge_length: f32,
    height: impl Fn(Point3, Normal3, Vec2) -> f32,
) -> Result<MeshArrays, MeshError> {
    check(&mesh)?;
    if mesh.normals.is_empty() {
        mesh.normals = vertex_normals(&mesh);
    }
    mesh.normals.iter_mut().for_each(|n| *n = n.normalize_or_zero());
    let mut mesh = Dicer { mesh, render_from_object, edge_length, middles: HashMap::new() }.dice()?;
    for ((p, &n), &uv) in mesh.positions.iter_mut().zip(&mesh.normals).zip(&mesh.uvs) {
        *p += n * height(*p, n, uv);
    }
    mesh.normals = vertex_normals(&mesh);
    Ok(mesh)
}

fn check(mesh: &MeshArrays) -> Result<(), MeshError> {
    let vertices = mesh.positions.len();
    for (triangle, corners) in mesh.indices.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&i| i as usize >= vertices) {
            return Err(MeshError::Index { triangle, vertex });
        }
    }
    let length = |attribute, values| match values == vertices {
        true => Ok(()),
        false => Err(MeshError::AttributeLength { attribute, values, vertices }),
    };
    length("texture coordinates", mesh.uvs.len())?;
    if mesh.normals.is_empty() { Ok(()) } else { length("normals", mesh.normals.len()) }
}

/// The mean of the unit normals of each vertex's triangles.
fn vertex_normals(mesh: &MeshArrays) -> Vec<Normal3> {
    let mut normals = vec![Normal3::ZERO; mesh.positions.len()];
    for corners in &mesh.indices {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize].as_dvec3());
        let n = Normal3::from((b - a).cross(c - a).normalize_or_zero().as_vec3());
        corners.iter().for_each(|&i| normals[i as usize] += n);
    }
    normals.into_iter().map(|n| n.normalize_or_zero()).collect()
}

struct Dicer<'a> {
    mesh: MeshArrays,
    render_from_object: &'a Transform,
    edge_length: f32,
    /// The midpoint of each edge that was split.
    middles: HashMap<[u32; 2], u32>,
}

impl Dicer<'_> {
    fn dice(mut self) -> Result<MeshArrays, MeshError> {
        let mut pending = std::mem::take(&mut self.mesh.indices);
        // No edge is shorter than 0 or NaN.
        if !(self.edge_length > 0.0 && self.least(&pending) <= MAX_TRIANGLES as f64) {
            return Err(MeshError::TooLarge);
        }
        while let Some(corners) = pending.pop() {
            let Some(longest) = self.edge_to_cut(corners) else {
                self.mesh.indices.push(corners);
                continue;
            };
            if self.mesh.indices.len() + pending.len() > MAX_TRIANGLES || self.middles.len() > MAX_TRIANGLES {
                return Err(MeshError::TooLarge);
            }
            let [a, b, c] = [0, 1, 2].map(|i| corners[(longest + i) % 3]);
            let middle = self.middle([a.min(b), a.max(b)]);
            pending.extend([[middle, b, c], [a, middle, c]]);
        }
        Ok(self.mesh)
    }

    /// A lower bound of the number of triangles: the largest with such edges is equilateral.
    fn least(&self, triangles: &[[u32; 3]]) -> f64 {
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|i| self.in_render_space(i).as_dvec3());
            0.5 * (b - a).cross(c - a).length()
        };
        let edge = f64::from(self.edge_length);
        triangles.iter().map(area).filter(|a| a.is_finite()).sum::<f64>()
            / (0.75f64.sqrt() * 0.5 * edge * edge)
    }

    /// The longest edge, unless it is short enough or NaN.
    fn edge_to_cut(&self, corners: [u32; 3]) -> Option<usize> {
        let p = corners.map(|i| self.in_render_space(i));
        let lengths = [0, 1, 2].map(|i| p[i].distance(p[(i + 1) % 3]));
        let longest = (0..3).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))?;
        let length = lengths[longest];
        (length >= self.edge_length && length.is_finite()).then_some(longest)
    }

    fn in_render_space(&self, vertex: u32) -> Point3 {
        self.render_from_object.point(self.mesh.positions[vertex as usize])
    }

    fn middle(&mut self, ends: [u32; 2]) -> u32 {
        let mesh = &mut self.mesh;
        *self.middles.entry(ends).or_insert_with(|| {
            let [a, b] = ends.map(|i| i as usize);
            mesh.positions.push(mesh.positions[a].midpoint(mesh.positions[b]));
            mesh.normals.push((mesh.normals[a] + mesh.normals[b]).normalize_or_zero());
            mesh.uvs.push(mesh.uvs[a].midpoint(mesh.uvs[b]));
            mesh.positions.len() as u32 - 1
        })
    }
}
