//! Geometries: eight words for each, its material, its first light plus one or 0, the offset of its
//! vertices' attributes, 1 where the outside of a mesh is where corners run clockwise, the texture
//! of its alpha or 0, 1 where it is single-sided, and zeros.
//!
//! Attributes are bits, and then for each
//! triangle what it has at its three corners, in this order, without gaps to save memory. Those of
//! ribbons are the normals at both ends of each primitive, four words each.

use geometry::{CurveKind, Curves, Geometry, GeometryId, PlainShape, Triangle, TriangleMesh};
use scene::GeometryEntry;

use super::Flattener;
use super::slab::padded;
use crate::tags::{AttributeBit, bit};

impl Flattener<'_> {
    /// The table of geometries; its offset.
    pub fn geometries(&mut self) -> u32 {
        let mut rows = Vec::new();
        for (entry, id) in self.scene.geometries().iter().zip(0..) {
            let (mut attributes, mut flips) = (0, false);
            match self.scene.world().geometry(GeometryId(id)) {
                Geometry::Mesh(mesh) if !mesh.is_empty() => {
                    attributes = self.attributes(mesh);
                    flips = mesh.triangle(0).flips;
                }
                Geometry::Mesh(_) | Geometry::Spheres(_) | Geometry::Shapes(_) => {}
                Geometry::Curves(curves) => {
                    attributes = self.normals(curves);
                    self.parts.curves = true;
                }
            }
            // Media have a table of their own.
            let &GeometryEntry { material, alpha, single_sided, first_light, media: _, span } = entry;
            self.parts.holes |= alpha.is_some();
            self.parts.single_sided |= single_sided;
            let alpha = alpha.map_or(0, |alpha| self.number_texture(alpha, span));
            let light = first_light.map_or(0, |light| light + 1);
            let sides = [flips, single_sided].map(u32::from);
            rows.extend([material.0, light, attributes, sides[0], alpha, sides[1], 0, 0]);
        }
        self.slab.add(rows)
    }

    /// The normals of ribbons; their offset, or 0 of other curves.
    fn normals(&mut self, curves: &Curves) -> u32 {
        let normals = |primitive| match curves.plain(primitive) {
            Some(PlainShape::Curve { kind: CurveKind::Ribbon, normals, .. }) => Some(normals),
            _ => None,
        };
        if curves.is_empty() || normals(0).is_none() {
            return 0;
        }
        let all = (0..curves.len() as u32).filter_map(normals).flatten();
        self.slab.add_numbers(padded(all.map(|n| n.to_array())))
    }

    /// The attributes of a mesh's vertices; their offset, or 0 where there are none.
    fn attributes(&mut self, mesh: &TriangleMesh) -> u32 {
        let first = mesh.triangle(0);
        // Meshes without coordinates have the same at each triangle.
        let has_coordinates = (0..mesh.len()).any(|i| mesh.triangle(i).uv != Triangle::DEFAULT_UV);
        let flags = bit(first.n.is_some(), AttributeBit::Normals)
            | bit(has_coordinates, AttributeBit::Coordinates)
            | bit(first.s.is_some(), AttributeBit::Tangents);
        if flags == 0 {
            return 0;
        }
        let at = self.slab.add([flags]);
        for triangle in (0..mesh.len()).map(|i| mesh.triangle(i)) {
            let vectors = |vectors: Option<[_; 3]>| {
                vectors.into_iter().flatten().flat_map(|v: math::Vec3| v.to_array())
            };
            let coordinates =
                triangle.uv.into_iter().filter(|_| has_coordinates).flat_map(|uv| uv.to_array());
            let numbers = vectors(triangle.n).chain(coordinates).chain(vectors(triangle.s));
            self.slab.extend_numbers(numbers);
        }
        at
    }
}
