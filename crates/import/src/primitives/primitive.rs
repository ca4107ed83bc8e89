//! Triangles with what is known of their vertices, before their surface is known.

use math::{Point2, Vec3};

/// The triangles of a primitive. Arrays are empty, or as long as `positions`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Primitive {
    pub triangles: Vec<[u32; 3]>,
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    /// Directions of increasing u, and the sign of the handedness.
    pub tangents: Vec<[f32; 4]>,
    /// With v down.
    pub uvs: Vec<Point2>,
    /// The same of other sets, by their numbers.
    pub other_uvs: Vec<(usize, Vec<Point2>)>,
    /// Linear colours.
    pub colors: Vec<[f32; 3]>,
    /// Opacities.
    pub opacities: Vec<f32>,
    /// The joints that move each vertex, with their weights.
    pub influences: Vec<[(u32, f32); 4]>,
    /// What is added to positions and normals with the weight of each target.
    pub targets: Vec<Target>,
}

/// A morph target.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Target {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub tangents: Vec<Vec3>,
}

impl Primitive {
    /// The same with the morph targets added by their weights.
    pub fn morphed(&self, weights: &[f64]) -> Self {
        let mut primitive = Self { targets: Vec::new(), ..self.clone() };
        for (target, &weight) in self.targets.iter().zip(weights) {
            if weight == 0.0 {
                continue;
            }
            let weight = weight as f32;
            for (v, d) in primitive.positions.iter_mut().zip(&target.positions) {
                *v += *d * weight;
            }
            for (v, d) in primitive.normals.iter_mut().zip(&target.normals) {
                *v += *d * weight;
            }
            for (v, d) in primitive.tangents.iter_mut().zip(&target.tangents) {
                let d = *d * weight;
                *v = [v[0] + d.x, v[1] + d.y, v[2] + d.z, v[3]];
            }
        }
        primitive
    }
}
