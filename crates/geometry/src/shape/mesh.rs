//! Triangle meshes with shared vertices.

use super::triangle::Triangle;
use lanes::prefetch;
use math::{Bounds3, Normal3, Point3, Transform, Vec2, Vector3};
use std::fmt;
use std::sync::Arc;

/// Optional vertex attributes, one value per vertex. Normals and tangents are in object space.
#[derive(Clone, Debug, Default)]
pub struct MeshAttributes {
    /// Shading normals, of any length.
    pub normals: Option<Arc<[Normal3]>>,
    /// Shading tangents.
    pub tangents: Option<Arc<[Vector3]>>,
    /// Texture coordinates.
    pub uvs: Option<Arc<[Vec2]>>,
}

/// Errors of the arrays of a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MeshError {
    /// A triangle has a vertex index that does not exist.
    Index {
        /// The triangle.
        triangle: usize,
        /// The vertex index.
        vertex: u32,
    },
    /// An attribute does not have one value per vertex.
    AttributeLength {
        /// The attribute.
        attribute: &'static str,
        /// The number of values.
        values: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// The mesh is not manifold at an edge: three triangles meet there, two with inconsistent
    /// orientation, or its ends are the same vertex.
    Edge([u32; 2]),
    /// The mesh is not manifold at a vertex, where parts meet that share no edge.
    Vertex(u32),
    /// There are too many triangles.
    TooLarge,
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index { triangle, vertex } => {
                write!(f, "triangle {triangle} has vertex index {vertex}, which does not exist")
            }
            Self::AttributeLength { attribute, values, vertices } => {
                write!(f, "{values} {attribute} for {vertices} vertices")
            }
            Self::Edge([a, b]) => {
                write!(
                    f,
                    "the edge from vertex {a} to vertex {b} is not shared by two triangles of the same orientation"
                )
            }
            Self::Vertex(vertex) => write!(f, "parts of the mesh are joined at vertex {vertex} only"),
            Self::TooLarge => write!(f, "too many triangles"),
        }
    }
}

impl std::error::Error for MeshError {}

/// A mesh in render space.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    positions: Arc<[Point3]>,
    indices: Arc<[[u32; 3]]>,
    normals: Option<Arc<[Normal3]>>,
    tangents: Option<Arc<[Vector3]>>,
    uvs: Option<Arc<[Vec2]>>,
    flips: bool,
}

impl TriangleMesh {
    /// Transforms an object's triangles to render space. Arrays that do not change are shared, not
    /// copied.
    ///
    /// Given normals point to the outside; with `reverse_orientation`, to the inside.
    pub fn new(
        positions: Arc<[Point3]>,
        indices: Arc<[[u32; 3]]>,
        attributes: MeshAttributes,
        render_from_object: &Transform,
        reverse_orientation: bool,
    ) -> Result<Self, MeshError> {
        let vertices = positions.len();
        if indices.len() >= u32::MAX as usize {
            return Err(MeshError::TooLarge);
        }
        for (triangle, corners) in indices.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::Index { triangle, vertex });
            }
        }
        let MeshAttributes { normals, tangents, uvs } = attributes;
        let lengths = [
            ("normals", normals.as_ref().map(|a| a.len())),
            ("tangents", tangents.as_ref().map(|a| a.len())),
            ("texture coordinates", uvs.as_ref().map(|a| a.len())),
        ];
        check_lengths(vertices, lengths)?;
        let moved = !render_from_object.is_identity();
        let turn = if reverse_orientation { -1.0 } else { 1.0 };
        Ok(Self {
            positions: if moved {
                positions.iter().map(|&p| render_from_object.point(p)).collect()
            } else {
                positions
            },
            indices,
            normals: normals.map(|normals| {
                if moved || reverse_orientation {
                    normals.iter().map(|&n| turn * render_from_object.normal(n)).collect()
                } else {
                    normals
                }
            }),
            tangents: tangents.map(|tangents| {
                if moved {
                    tangents.iter().map(|&s| render_from_object.vector(s)).collect()
                } else {
                    tangents
                }
            }),
            uvs,
            flips: reverse_orientation != render_from_object.swaps_handedness(),
        })
    }

    /// The same triangles with other positions and shading normals (of any length, towards the
    /// outside), all in render space. Texture coordinates are kept; tangents, which would change
    /// too, are not.
    pub fn moved(
        &self,
        positions: Arc<[Point3]>,
        normals: Option<Arc<[Normal3]>>,
    ) -> Result<Self, MeshError> {
        let vertices = self.positions.len();
        let lengths = [("positions", Some(positions.len())), ("normals", normals.as_ref().map(|a| a.len()))];
        check_lengths(vertices, lengths)?;
        let (indices, uvs) = (self.indices.clone(), self.uvs.clone());
        Ok(Self { positions, indices, normals, tangents: None, uvs, flips: self.flips })
    }

    /// The number of triangles.
    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Whether there is no triangle.
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: usize) -> [Point3; 3] {
        self.indices[triangle].map(|i| self.positions[i as usize])
    }

    /// Whether both have the same vertex indices.
    pub(crate) fn has_triangles_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.indices, &other.indices) || self.indices == other.indices
    }

    /// Whether vertices have shading normals or tangents.
    pub fn is_smooth(&self) -> bool {
        self.normals.is_some() || self.tangents.is_some()
    }

    /// The number of vertices.
    pub(crate) fn vertices(&self) -> usize {
        self.positions.len()
    }

    /// The vertex indices of a triangle.
    #[inline]
    pub fn indices(&self, triangle: usize) -> [u32; 3] {
        self.indices[triangle]
    }

    /// The position of a vertex.
    #[inline]
    pub(crate) fn position(&self, vertex: u32) -> Point3 {
        self.positions[vertex as usize]
    }

    /// The vertex indices of all triangles, one after another.
    #[inline(always)]
    pub(crate) fn all_indices(&self) -> &[u32] {
        self.indices.as_flattened()
    }

    /// The positions of all vertices.
    #[inline(always)]
    pub fn positions(&self) -> &[Point3] {
        &self.positions
    }

    /// The shading normals of all vertices.
    #[inline(always)]
    pub(crate) fn normals(&self) -> Option<&[Normal3]> {
        self.normals.as_deref()
    }

    /// The texture coordinates of all vertices.
    #[inline(always)]
    pub(crate) fn uvs(&self) -> Option<&[Vec2]> {
        self.uvs.as_deref()
    }

    /// The shading tangents of all vertices.
    #[inline(always)]
    pub(crate) fn tangents(&self) -> Option<&[Vector3]> {
        self.tangents.as_deref()
    }

    /// Whether the outside is where the corners run clockwise.
    #[inline(always)]
    pub(crate) fn flips(&self) -> bool {
        self.flips
    }

    /// Prefetches the indices of a triangle.
    #[inline(always)]
    pub(crate) fn prefetch_indices(&self, triangle: usize) {
        prefetch(&raw const self.indices[triangle]);
    }

    /// Prefetches the corners of a triangle.
    #[inline(always)]
    pub(crate) fn prefetch_corners(&self, triangle: usize) {
        self.indices[triangle].iter().for_each(|&i| prefetch(&raw const self.positions[i as usize]));
    }

    /// One triangle with its vertex attributes.
    pub fn triangle(&self, triangle: usize) -> Triangle {
        let corners = self.indices[triangle];
        let pick = |values: &Arc<[Vector3]>| corners.map(|i| values[i as usize]);
        Triangle {
            p: corners.map(|i| self.positions[i as usize]),
            n: self.normals.as_ref().map(pick),
            s: self.tangents.as_ref().map(pick),
            uv: match &self.uvs {
                Some(uvs) => corners.map(|i| uvs[i as usize]),
                None => Triangle::DEFAULT_UV,
            },
            flips: self.flips,
        }
    }

    /// Bytes of memory of the arrays.
    pub fn bytes(&self) -> usize {
        let vectors =
            [&self.normals, &self.tangents].into_iter().flatten().map(|values| size_of_val(&**values));
        let uvs = self.uvs.as_ref().map_or(0, |uvs| size_of_val(&**uvs));
        size_of_val(&*self.positions) + size_of_val(&*self.indices) + vectors.sum::<usize>() + uvs
    }

    /// The box around all vertices that a triangle uses.
    pub fn bounds(&self) -> Bounds3 {
        Bounds3::around((0..self.len()).flat_map(|i| self.corners(i)))
    }
}

/// Checks that all attributes have one value per vertex.
fn check_lengths(
    vertices: usize,
    lengths: impl IntoIterator<Item = (&'static str, Option<usize>)>,
) -> Result<(), MeshError> {
    let wrong = lengths.into_iter().find_map(|(name, n)| n.filter(|&n| n != vertices).map(|n| (name, n)));
    match wrong {
        Some((attribute, values)) => Err(MeshError::AttributeLength { attribute, values, vertices }),
        None => Ok(()),
    }
}
