//! Geometries: the objects that a scene gives materials, lights and names.

use crate::curve::Curves;
use crate::shape::{PlainShape, Shape, TriangleMesh};
use crate::sphere_set::SphereSet;
use math::Bounds3;
use std::borrow::Cow;
use std::sync::Arc;

/// A geometry, counted over the whole world in the order of
/// [`WorldBuilder::add_geometry`](crate::WorldBuilder::add_geometry).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GeometryId(pub u32);

/// One object of a scene: one or more primitives with one [`GeometryId`].
#[derive(Clone, Debug)]
pub enum Geometry {
    /// The triangles of a mesh.
    Mesh(Arc<TriangleMesh>),
    /// Any other shapes: one quadric, the patches of a bilinear mesh.
    Shapes(Arc<[Shape]>),
    /// The spheres of a set.
    Spheres(Arc<SphereSet>),
    /// The segments of curves.
    Curves(Arc<Curves>),
}

impl From<TriangleMesh> for Geometry {
    fn from(mesh: TriangleMesh) -> Self {
        Self::Mesh(Arc::new(mesh))
    }
}

impl From<Shape> for Geometry {
    fn from(shape: Shape) -> Self {
        Self::Shapes(Arc::new([shape]))
    }
}

impl From<SphereSet> for Geometry {
    fn from(set: SphereSet) -> Self {
        Self::Spheres(Arc::new(set))
    }
}

impl From<Curves> for Geometry {
    fn from(curves: Curves) -> Self {
        Self::Curves(Arc::new(curves))
    }
}

impl Geometry {
    /// The number of primitives.
    pub fn len(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.len(),
            Self::Shapes(shapes) => shapes.len(),
            Self::Spheres(set) => set.len(),
            Self::Curves(curves) => curves.len(),
        }
    }

    /// Whether there is no primitive.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes of memory of the primitives, without what shapes own on the heap.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.bytes(),
            Self::Shapes(shapes) => size_of_val(&**shapes),
            Self::Spheres(set) => set.bytes(),
            Self::Curves(curves) => curves.bytes(),
        }
    }

    /// Whether its primitives move by themselves.
    pub fn is_moving(&self) -> bool {
        matches!(self, Self::Shapes(shapes) if matches!(shapes.first(), Some(Shape::MovingTriangle(_))))
    }

    /// One primitive as a shape; `None` for curves.
    #[inline]
    pub fn shape(&self, primitive: u32) -> Option<Cow<'_, Shape>> {
        match self {
            Self::Mesh(mesh) => Some(Cow::Owned(mesh.triangle(primitive as usize).into())),
            Self::Shapes(shapes) => Some(Cow::Borrowed(&shapes[primitive as usize])),
            Self::Spheres(set) => Some(Cow::Owned(set.sphere(primitive as usize).into())),
            Self::Curves(_) => None,
        }
    }

    /// A box around a primitive at rest; `None` where it is unbounded.
    pub fn bounds(&self, primitive: u32) -> Option<Bounds3> {
        match self {
            Self::Curves(curves) => Some(curves.bounds(primitive)),
            Self::Spheres(set) => Some(set.bounds(primitive as usize)),
            Self::Mesh(_) | Self::Shapes(_) => self.shape(primitive)?.bounds(),
        }
    }

    /// One primitive at rest as plain data; `None` where it has none.
    pub fn plain(&self, primitive: u32) -> Option<PlainShape> {
        match self {
            Self::Curves(curves) => curves.plain(primitive),
            Self::Mesh(_) | Self::Shapes(_) | Self::Spheres(_) => self.shape(primitive)?.plain(),
        }
    }
}
