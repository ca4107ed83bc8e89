//! A mesh as files have it.

use std::fmt;
use std::sync::Arc;

use description::{MeshDesc, PatchMeshDesc, ShapeKind};
use image::linear_from_srgb;
use math::{Normal3, Point2, Point3};

use super::polygon;

/// Triangles and convex quadrilaterals over shared vertices. All indices are valid; per-vertex
/// arrays are empty or as long as `positions`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<Point3>,
    /// Vertex normals.
    pub normals: Vec<Normal3>,
    /// Vertex texture coordinates.
    pub uvs: Vec<Point2>,
    /// Vertex colours, linear.
    pub colors: Vec<[f32; 3]>,
    /// Triangles: those of the file, and those of triangulated polygons.
    pub triangles: Vec<[u32; 3]>,
    /// Convex quadrilaterals, corners in order around the face.
    pub quads: Vec<[u32; 4]>,
    /// The file's own number for each triangle; or empty.
    pub triangle_faces: Vec<i32>,
    /// The file's own number for each quadrilateral; or empty.
    pub quad_faces: Vec<i32>,
    /// Parts of the file's surface that are not in the mesh.
    pub warnings: Vec<String>,
}

impl Mesh {
    /// Adds a face of any number of corners; one of fewer than three is ignored.
    pub(crate) fn push_face(&mut self, corners: &[u32], number: Option<i32>) {
        match *corners {
            [] | [_] | [_, _] => (),
            [a, b, c] => self.push_triangle([a, b, c], number),
            [a, b, c, d] if polygon::is_convex(&self.positions, corners) => {
                self.quads.push([a, b, c, d]);
                self.quad_faces.extend(number);
            }
            _ => {
                for triangle in polygon::triangulate(&self.positions, corners) {
                    self.push_triangle(triangle, number);
                }
            }
        }
    }

    /// A new vertex that is like another one.
    pub(super) fn copy_vertex(&mut self, vertex: u32) -> u32 {
        fn copy<T: Copy>(values: &mut Vec<T>, vertex: usize) {
            values.extend(values.get(vertex).copied());
        }
        let vertex = vertex as usize;
        copy(&mut self.positions, vertex);
        copy(&mut self.normals, vertex);
        copy(&mut self.uvs, vertex);
        copy(&mut self.colors, vertex);
        self.positions.len() as u32 - 1
    }

    fn push_triangle(&mut self, triangle: [u32; 3], number: Option<i32>) {
        self.triangles.push(triangle);
        self.triangle_faces.extend(number);
    }

    /// The shape of a mesh. Quadrilaterals become bilinear patches, whose corners go in rows.
    pub fn into_shape(self) -> ShapeKind {
        let positions: Arc<[_]> = self.positions.into();
        let normals: Arc<[_]> = self.normals.into();
        let uvs: Arc<[_]> = self.uvs.into();
        ShapeKind::PlyMesh {
            triangles: MeshDesc {
                indices: self.triangles.into(),
                positions: positions.clone(),
                normals: normals.clone(),
                tangents: Arc::default(),
                uvs: uvs.clone(),
                face_indices: self.triangle_faces.into(),
                later: Vec::new(),
            },
            patches: PatchMeshDesc {
                indices: self.quads.into_iter().map(|[a, b, c, d]| [a, b, d, c]).collect(),
                positions,
                normals,
                uvs,
                face_indices: self.quad_faces.into(),
                emission_image: None,
            },
            displacement: None,
            edge_length: 1.0,
        }
    }
}

/// Makes colours of vertices linear, which files have as sRGB codes in [0, 1]. Whether they are
/// codes up to 255 instead: some are above 1.
pub(super) fn decode_colors(colors: &mut [[f32; 3]]) -> bool {
    let is_wide = colors.iter().flatten().any(|&code| code > 1.0);
    let scale = if is_wide { 255.0 } else { 1.0 };
    for code in colors.iter_mut().flatten() {
        *code = if *code > 0.0 { linear_from_srgb((*code / scale).min(1.0)) } else { 0.0 };
    }
    is_wide
}

/// Why a mesh could not be read.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshError {
    /// The bytes contradict their format.
    Invalid(String),
    /// The file has no faces that can be rendered.
    Unsupported(String),
    /// The file declares more data than its bytes can hold.
    Limits(String),
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(text) => write!(f, "invalid mesh: {text}"),
            Self::Unsupported(text) => write!(f, "unsupported mesh: {text}"),
            Self::Limits(text) => write!(f, "mesh too large: {text}"),
        }
    }
}

impl std::error::Error for MeshError {}

/// The error of bytes that contradict their format.
pub(super) fn invalid<T>(text: impl Into<String>) -> Result<T, MeshError> {
    Err(MeshError::Invalid(text.into()))
}
