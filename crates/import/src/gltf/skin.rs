//! Skins: vertices that follow the joints of a skeleton.

use math::{DMat4, Vec3};

use super::accessor::Accessor;
use super::buffer::Buffers;
use super::document::Document;
use super::json::{Place, Result};
use crate::primitives::Primitive;

/// A skin.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Skin {
    /// The nodes of the joints.
    joints: Vec<usize>,
    /// From the space of the mesh to that of each joint.
    inverse_bind: Vec<DMat4>,
}

impl Skin {
    /// Reads a skin.
    pub fn parse(document: &Document, buffers: &Buffers, place: &Place) -> Result<Self> {
        let count = document.count("nodes");
        let joints = place.array("joints")?;
        if joints.is_empty() {
            return Err(place.invalid("a skin has at least one joint"));
        }
        let joints = joints.iter().map(|joint| joint.as_index(count, "nodes")).collect::<Result<Vec<_>>>()?;
        document.index(place, "skeleton", "nodes")?;
        let inverse_bind = match Accessor::of(document, place, "inverseBindMatrices")? {
            Some(accessor) => {
                let matrices = accessor.vectors::<16>(buffers)?;
                matrices.iter().map(|m| DMat4::from_cols_array(&m.map(f64::from))).collect()
            }
            None => vec![DMat4::IDENTITY; joints.len()],
        };
        if inverse_bind.len() < joints.len() {
            let message = format!("there are {} matrices for {} joints", inverse_bind.len(), joints.len());
            return Err(place.invalid_member("inverseBindMatrices", message));
        }
        if inverse_bind.iter().any(|m| m.row(3) != math::DMat4::IDENTITY.row(3)) {
            let message = "the last row of these matrices is 0, 0, 0, 1";
            return Err(place.invalid_member("inverseBindMatrices", message));
        }
        Ok(Self { joints, inverse_bind })
    }

    /// The vertices of a primitive in the world, in which nodes are as `world` says; `None` where
    /// it has joints that the skin does not have.
    pub fn posed(&self, primitive: &Primitive, world: &[DMat4]) -> Option<Primitive> {
        let joints = self.joints.iter().zip(&self.inverse_bind);
        let matrices: Vec<DMat4> = joints.map(|(&joint, inverse)| world[joint] * *inverse).collect();
        let mut posed = primitive.clone();
        for (vertex, influences) in primitive.influences.iter().enumerate() {
            let total: f32 = influences.iter().map(|&(_, weight)| weight).sum();
            let mut matrix = DMat4::ZERO;
            for &(joint, weight) in influences.iter().filter(|&&(_, weight)| weight != 0.0) {
                matrix += *matrices.get(joint as usize)? * f64::from(weight / total);
            }
            if total == 0.0 {
                matrix = *matrices.first()?;
            }
            let point = matrix.transform_point3(primitive.positions[vertex].as_dvec3());
            posed.positions[vertex] = Vec3::from(point.as_vec3());
            if let Some(normal) = posed.normals.get_mut(vertex) {
                let turned = math::DMat3::from_mat4(matrix).inverse().transpose() * normal.as_dvec3();
                *normal = Vec3::from(turned.normalize_or(math::DVec3::Z).as_vec3());
            }
            if let Some([x, y, z, _]) = posed.tangents.get_mut(vertex) {
                let turned =
                    matrix.transform_vector3(math::DVec3::new((*x).into(), (*y).into(), (*z).into()));
                [*x, *y, *z] = turned.normalize_or(math::DVec3::X).as_vec3().to_array();
            }
        }
        Some(posed)
    }
}
