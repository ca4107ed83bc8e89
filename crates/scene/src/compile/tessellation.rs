//! Shapes that are tessellated: subdivision surfaces and displaced meshes.

use super::Compiler;
use crate::texture::TextureContext;
use description::{FloatParameter, MeshDesc, PatchMeshDesc, ShapeDesc, Span, Stated};
use geometry::{Geometry, MeshArrays, MeshAttributes, MeshError, TriangleMesh, displaced, loop_subdivision};
use math::Transform;

impl Compiler<'_> {
    pub(super) fn loop_subdivision(
        &mut self,
        mesh: &MeshDesc,
        levels: i32,
        shape: &Stated<ShapeDesc>,
        transform: &Transform,
    ) -> Option<Geometry> {
        let levels = levels.max(0) as u32;
        let result = loop_subdivision(&mesh.positions, &mesh.indices, levels);
        let span =
            shape.origin.parameter(if result == Err(MeshError::TooLarge) { "levels" } else { "indices" });
        self.fine_mesh(result, span, shape, transform)
    }

    /// A mesh displaced along its normals. Quadrilaterals are split into triangles.
    pub(super) fn displaced(
        &mut self,
        triangles: &MeshDesc,
        patches: &PatchMeshDesc,
        height: &FloatParameter,
        edge_length: f32,
        shape: &Stated<ShapeDesc>,
        transform: &Transform,
    ) -> Option<Geometry> {
        let height = self.float_texture(height, shape.origin.parameter("displacement"));
        // Of points in render space, wherever those of the group are.
        let render_from_object = Transform::from_f64(self.render_from_world * shape.world_from_object.start);
        let render_from_object = render_from_object.unwrap_or(*transform);
        let (textures, edge_scale) = (self.textures.textures(), self.desc.options.displacement_edge_scale);
        let result =
            displaced(joined(triangles, patches), transform, edge_length * edge_scale, |p, n, uv| {
                let context = TextureContext {
                    p: render_from_object.point(p),
                    n: render_from_object.normal(n).normalize_or_zero(),
                    uv,
                    ..Default::default()
                };
                textures.float(height, &context)
            });
        let too_large = result == Err(MeshError::TooLarge);
        let span = shape.origin.parameter(if too_large { "edgelength" } else { "displacement" });
        self.fine_mesh(result, span, shape, transform)
    }

    fn fine_mesh(
        &mut self,
        result: Result<MeshArrays, MeshError>,
        span: Span,
        shape: &Stated<ShapeDesc>,
        transform: &Transform,
    ) -> Option<Geometry> {
        let mesh = result.and_then(|mesh| {
            let attributes = MeshAttributes {
                normals: Some(mesh.normals.into()),
                tangents: None,
                uvs: (!mesh.uvs.is_empty()).then(|| mesh.uvs.into()),
            };
            let (positions, indices) = (mesh.positions.into(), mesh.indices.into());
            TriangleMesh::new(positions, indices, attributes, transform, shape.reverse_orientation)
        });
        match mesh {
            Ok(mesh) => Some(mesh.into()),
            Err(error) => {
                self.error("invalid-mesh", error.to_string(), span);
                None
            }
        }
    }
}

/// The triangles of a mesh file and both halves of its quadrilaterals, which share vertices.
fn joined(triangles: &MeshDesc, patches: &PatchMeshDesc) -> MeshArrays {
    let halves = patches.indices.iter().flat_map(|&[a, b, c, d]| [[a, b, d], [a, d, c]]);
    MeshArrays {
        positions: triangles.positions.to_vec(),
        indices: triangles.indices.iter().copied().chain(halves).collect(),
        normals: triangles.normals.to_vec(),
        uvs: triangles.uvs.to_vec(),
    }
}
