//! The faces of a mesh, and what is given for their corners.

use std::collections::HashMap;

use math::{Point2, Vec3};

use super::primvar::{Counts, Interpolation, Primvar};
use super::stage::Prim;
use crate::log::Result;
use crate::primitives::Primitive;
use assets::mesh::polygon;

/// Faces of any number of corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Faces {
    /// How many corners each face has.
    pub counts: Vec<usize>,
    /// The points of all corners.
    pub points: Vec<u32>,
    /// The face of the file that each is of.
    pub origins: Vec<u32>,
}

impl Faces {
    /// The faces of a mesh with a number of points.
    pub fn read(prim: &Prim, points: usize) -> Result<Self> {
        const COUNTS: &str = "faceVertexCounts";
        const INDICES: &str = "faceVertexIndices";
        let counts = prim.integers(COUNTS)?.unwrap_or_default();
        let indices = prim.integers(INDICES)?.unwrap_or_default();
        let mut faces = Self { origins: (0..counts.len() as u32).collect(), ..Self::default() };
        for count in counts {
            let count = usize::try_from(count).ok().filter(|&count| count <= indices.len());
            faces.counts.push(count.ok_or_else(|| prim.fault(COUNTS, "there is a number that cannot be"))?);
        }
        let sum = faces.counts.iter().try_fold(0_usize, |sum, &count| sum.checked_add(count));
        if sum != Some(indices.len()) {
            let message = format!("the faces do not have the {} corners of `{INDICES}`", indices.len());
            return Err(prim.fault(COUNTS, message));
        }
        for index in indices {
            let index = u32::try_from(index).ok().filter(|&index| (index as usize) < points);
            let message = || format!("there is an index that none of the {points} points has");
            faces.points.push(index.ok_or_else(|| prim.fault(INDICES, message()))?);
        }
        Ok(faces)
    }

    pub fn len(&self) -> usize {
        self.counts.len()
    }

    /// The numbers of elements that values on a mesh have.
    pub fn elements(&self, points: usize) -> Counts {
        Counts { faces: self.len(), points, varying: points, corners: self.points.len() }
    }

    /// The first corner of each face, and its corners' points.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[u32])> {
        let mut first = 0;
        self.counts.iter().map(move |&count| {
            let corners = (first, &self.points[first..first + count]);
            first += count;
            corners
        })
    }
}

/// What is given for the vertices of a mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct Values {
    pub normals: Option<Primvar<3>>,
    pub uvs: Option<Primvar<2>>,
    pub colors: Option<Primvar<3>>,
}

impl Values {
    /// Whether corners at the same point may differ.
    fn split_points(&self) -> bool {
        let splits = |interpolation: Interpolation| {
            matches!(interpolation, Interpolation::Uniform | Interpolation::FaceVarying)
        };
        [
            self.normals.as_ref().map(|values| values.interpolation),
            self.uvs.as_ref().map(|values| values.interpolation),
            self.colors.as_ref().map(|values| values.interpolation),
        ]
        .into_iter()
        .flatten()
        .any(splits)
    }
}

/// Cuts the chosen faces into triangles, whose vertices are as many as there are different corners.
/// The faces are those of the file by their numbers. Gives the point of each vertex, too.
pub(super) fn triangulate(
    positions: &[Vec3],
    faces: &Faces,
    values: &Values,
    is_left_handed: bool,
    is_chosen: impl Fn(u32) -> bool,
) -> (Primitive, Vec<u32>) {
    let mut primitive = Primitive::default();
    let mut points = Vec::new();
    let mut known: HashMap<(u32, [u32; 8]), u32> = HashMap::new();
    let splits = values.split_points();
    let mut vertices = Vec::new();
    for (face, (first, corners)) in faces.iter().enumerate() {
        if corners.len() < 3 || !is_chosen(faces.origins[face]) {
            continue;
        }
        vertices.clear();
        for (index, &point) in corners.iter().enumerate() {
            let at = (first + index, point as usize, face);
            let normal = values.normals.as_ref().map(|n| n.at(at.0, at.1, at.2).map(|v| v as f32));
            let uv = values.uvs.as_ref().map(|uv| uv.at(at.0, at.1, at.2).map(|v| v as f32));
            let color = values.colors.as_ref().map(|c| c.at(at.0, at.1, at.2).map(|v| v as f32));
            let mut key = [0; 8];
            if splits {
                let numbers = normal.unwrap_or_default().into_iter();
                let numbers = numbers.chain(uv.unwrap_or_default()).chain(color.unwrap_or_default());
                for (bits, number) in key.iter_mut().zip(numbers) {
                    *bits = number.to_bits();
                }
            }
            let vertex = *known.entry((point, key)).or_insert_with(|| {
                primitive.positions.push(positions[point as usize]);
                primitive.normals.extend(normal.map(Vec3::from));
                // v is down in primitives.
                primitive.uvs.extend(uv.map(|[u, v]| Point2::new(u, 1.0 - v)));
                primitive.colors.extend(color);
                points.push(point);
                points.len() as u32 - 1
            });
            vertices.push(vertex);
        }
        let count = primitive.triangles.len();
        match vertices.as_slice() {
            &[a, b, c] => primitive.triangles.push([a, b, c]),
            &[a, b, c, d] if polygon::is_convex(&primitive.positions, &vertices) => {
                primitive.triangles.extend([[a, b, c], [a, c, d]]);
            }
            corners => primitive.triangles.extend(polygon::triangulate(&primitive.positions, corners)),
        }
        if is_left_handed {
            primitive.triangles[count..].iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
    }
    (primitive, points)
}
