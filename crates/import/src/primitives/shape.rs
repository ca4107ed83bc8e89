//! Primitives as shapes of a scene.

use std::sync::Arc;

use description::{MeshDesc, MeshKey, SceneDesc, ShapeDesc, ShapeKind};
use math::{DVec2, Point2, Vec3};

use super::emission::Emitting;
use super::primitive::Primitive;
use super::surface::{Coordinates, Surface};

/// The vertices of a primitive, at the start and, where they move, at the end of the shutter's
/// time.
pub(crate) struct Vertices {
    pub start: Primitive,
    pub end: Option<Primitive>,
}

/// What shapes are made with.
pub(crate) struct Look {
    /// Whether the surface has a normal map.
    pub has_normals: bool,
    /// Whether its highlights have a direction.
    pub is_stretched: bool,
    /// Triangles with their surface, and with that where texture coordinates are mirrored. All
    /// surfaces are of one material.
    pub parts: Vec<(Vec<[u32; 3]>, [Surface; 2])>,
}

impl Look {
    /// The shapes of a primitive: of each part one for each of the triangles that emit or do not,
    /// and that have mirrored texture coordinates or not.
    pub fn shapes(&self, vertices: &Vertices, desc: &SceneDesc) -> Vec<ShapeDesc> {
        let primitive = &vertices.start;
        let Some((_, [surface, _])) = self.parts.first() else { return Vec::new() };
        let uvs = mapped(&primitive.uvs, &surface.coordinates);
        // Parts have the same image, which may be mapped to each in another way.
        let emission = surface.area_light.and_then(|light| desc.area_lights[light].image);
        let emission = emission.filter(|_| !uvs.is_empty());
        let emitting = emission.map(|map| (Emitting::of(&desc.images[map.image].image), desc));
        let shared = self.mesh(vertices, uvs.clone(), surface.tangent_rotation);
        let parts = self.parts.iter();
        let shapes = parts.flat_map(|(triangles, surfaces)| {
            self.part(triangles, surfaces, primitive, &uvs, emitting.as_ref(), &shared)
        });
        shapes.collect()
    }

    /// The shapes of a part.
    fn part(
        &self,
        triangles: &[[u32; 3]],
        surfaces: &[Surface; 2],
        primitive: &Primitive,
        uvs: &[Point2],
        emitting: Option<&(Emitting, &SceneDesc)>,
        shared: &MeshDesc,
    ) -> Vec<ShapeDesc> {
        let emitting = emitting
            .and_then(|(emitting, desc)| Some((emitting, desc.area_lights[surfaces[0].area_light?].image?)));
        let mut parts = [const { Vec::new() }; 4];
        for triangle in triangles {
            let corners = (!uvs.is_empty()).then(|| triangle.map(|vertex| uvs[vertex as usize]));
            let is_mirrored = self.has_normals && is_mirrored(primitive, triangle, corners);
            let is_dark = match (&emitting, corners) {
                (Some((emitting, map)), Some(corners)) => !emitting.is_met(map, corners),
                _ => false,
            };
            parts[usize::from(is_mirrored) + 2 * usize::from(is_dark)].push(*triangle);
        }
        let parts = parts.into_iter().enumerate().filter(|(_, triangles)| !triangles.is_empty());
        parts
            .map(|(part, triangles)| {
                let surface = &surfaces[part % 2];
                let mesh = MeshDesc { indices: triangles.into(), ..shared.clone() };
                ShapeDesc {
                    material: Some(surface.material),
                    area_light: surface.area_light.filter(|_| part < 2),
                    alpha: surface.alpha.clone(),
                    medium_interface: surface.media,
                    single_sided: surface.single_sided,
                    ..ShapeDesc::from(ShapeKind::Triangles(mesh))
                }
            })
            .collect()
    }

    /// The vertices as a mesh without triangles.
    fn mesh(&self, vertices: &Vertices, uvs: Vec<Point2>, tangent_rotation: f32) -> MeshDesc {
        let primitive = &vertices.start;
        let later = vertices.end.as_ref().map(|end| MeshKey {
            positions: end.positions.as_slice().into(),
            normals: end.normals.as_slice().into(),
        });
        MeshDesc {
            indices: Arc::default(),
            positions: primitive.positions.as_slice().into(),
            normals: primitive.normals.as_slice().into(),
            tangents: self.tangents(primitive, &uvs, tangent_rotation).into(),
            uvs: uvs.into(),
            face_indices: Arc::default(),
            later: later.into_iter().collect(),
        }
    }

    /// The tangents that shading needs besides the directions of increasing u.
    fn tangents(&self, primitive: &Primitive, uvs: &[Point2], angle: f32) -> Vec<Vec3> {
        let is_used = self.has_normals || self.is_stretched;
        if !is_used || primitive.normals.is_empty() || (angle == 0.0 && primitive.tangents.is_empty()) {
            return Vec::new();
        }
        let tangents = match primitive.tangents.is_empty() {
            false => primitive.tangents.iter().map(|&[x, y, z, sign]| (Vec3::new(x, y, z), sign)).collect(),
            true => along_u(primitive, uvs),
        };
        let (sin, cos) = libm::sincosf(angle);
        let turned = |((tangent, sign), normal): ((Vec3, f32), &Vec3)| {
            let normal = normal.normalize_or(Vec3::Z);
            tangent * cos + normal.cross(tangent) * (sin * sign.signum())
        };
        tangents.into_iter().zip(&primitive.normals).map(turned).collect()
    }
}

/// Texture coordinates of the file as those of a mesh.
fn mapped(uvs: &[Point2], coordinates: &Coordinates) -> Vec<Point2> {
    let map = |uv: &Point2| {
        let uv = coordinates.transform.transform_point2(DVec2::new(uv.x.into(), 1.0 - f64::from(uv.y)));
        Point2::from(uv.as_vec2())
    };
    uvs.iter().map(map).collect()
}

/// Whether the texture coordinates of a triangle go round it the other way than its corners.
fn is_mirrored(primitive: &Primitive, triangle: &[u32; 3], corners: Option<[Point2; 3]>) -> bool {
    if let Some([_, _, _, sign]) = primitive.tangents.get(triangle[0] as usize) {
        return *sign < 0.0;
    }
    corners.is_some_and(|[a, b, c]| area(a, b, c) < 0.0)
}

/// Twice the area of a triangle, negative if it is clockwise.
fn area(a: Point2, b: Point2, c: Point2) -> f32 {
    (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)
}

/// Directions of increasing u at the vertices, means of those of the triangles around them.
fn along_u(primitive: &Primitive, uvs: &[Point2]) -> Vec<(Vec3, f32)> {
    let mut sums = vec![(Vec3::ZERO, 0.0); primitive.positions.len()];
    if uvs.is_empty() {
        return sums;
    }
    for triangle in &primitive.triangles {
        let [p, q, r] = triangle.map(|vertex| primitive.positions[vertex as usize]);
        let [a, b, c] = triangle.map(|vertex| uvs[vertex as usize]);
        let area = area(a, b, c);
        let direction = ((q - p) * (c.y - a.y) - (r - p) * (b.y - a.y)) * area.signum();
        for &vertex in triangle {
            let (sum, sign) = &mut sums[vertex as usize];
            (*sum, *sign) = (*sum + direction, *sign + area);
        }
    }
    sums
}
