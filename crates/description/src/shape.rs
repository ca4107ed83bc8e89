//! Shapes, objects made of shapes, and instances of objects.

use std::sync::Arc;

use math::{Normal3, Point2, Point3, Vector3};

use crate::names::names;
use crate::{
    AreaLightDesc, Arena, FloatParameter, Handle, ImageDesc, MaterialDesc, MediumInterface, Spanned,
    TransformDesc,
};

/// A shape with its transform, material, emission and media.
#[derive(Clone, Debug)]
pub struct ShapeDesc {
    /// Which one.
    pub kind: ShapeKind,
    /// From the shape's space to the world (for a shape of an object: to the object's space).
    pub world_from_object: TransformDesc,
    /// Flip its normals.
    pub reverse_orientation: bool,
    /// Whether the camera sees its front alone, and all behind it through its back. Other rays meet
    /// both sides.
    pub single_sided: bool,
    /// Its material; the format's default (grey, diffuse) if absent.
    pub material: Option<Handle<MaterialDesc>>,
    /// Its emission.
    pub area_light: Option<Handle<AreaLightDesc>>,
    /// Alpha: 0 cuts the surface out, 1 is opaque.
    pub alpha: Option<FloatParameter>,
    /// The media on its two sides; the camera's side if absent.
    pub medium_interface: Option<MediumInterface>,
}

impl From<ShapeKind> for ShapeDesc {
    fn from(kind: ShapeKind) -> Self {
        Self {
            kind,
            world_from_object: TransformDesc::default(),
            reverse_orientation: false,
            single_sided: false,
            material: None,
            area_light: None,
            alpha: None,
            medium_interface: None,
        }
    }
}

/// The shapes of the format, the quadrics of its third version, and an infinite plane. Angles are
/// in degrees.
#[derive(Clone, Debug)]
pub enum ShapeKind {
    /// About the origin.
    Sphere {
        /// Radius.
        radius: f32,
        /// Lowest z.
        z_min: f32,
        /// Highest z.
        z_max: f32,
        /// Sweep about z.
        phi_max: f32,
    },
    /// About the z axis.
    Cylinder {
        /// Radius.
        radius: f32,
        /// Lowest z.
        z_min: f32,
        /// Highest z.
        z_max: f32,
        /// Sweep about z.
        phi_max: f32,
    },
    /// From a circle around the z axis in z = 0 to a point on it.
    Cone {
        /// Radius of the circle.
        radius: f32,
        /// z of the point.
        height: f32,
        /// Sweep about z.
        phi_max: f32,
    },
    /// A bowl with its lowest point at the origin, open along z.
    Paraboloid {
        /// Radius at the highest z.
        radius: f32,
        /// Lowest z.
        z_min: f32,
        /// Highest z.
        z_max: f32,
        /// Sweep about z.
        phi_max: f32,
    },
    /// The surface of revolution of a line about the z axis.
    Hyperboloid {
        /// The ends of the line, of different z.
        ends: [Point3; 2],
        /// Sweep about z.
        phi_max: f32,
    },
    /// Across the z axis.
    Disk {
        /// Its z.
        height: f32,
        /// Radius.
        radius: f32,
        /// Radius of the hole.
        inner_radius: f32,
        /// Sweep about z.
        phi_max: f32,
    },
    /// The plane z = 0.
    Plane,
    /// Many whole spheres.
    Spheres(SpheresDesc),
    /// Where a formula is zero.
    Implicit {
        /// The formula, of x, y and z.
        formula: Spanned<String>,
        /// Two corners of the box to which the surface is clipped.
        bounds: [Point3; 2],
    },
    /// Constructive solid geometry. Every shape of an operand is a body, closed where it is
    /// clipped; several shapes are their union.
    Solid {
        /// How they are combined.
        operation: SolidOperation,
        /// The bodies. A solid in an object refers only to earlier objects, so that no solid is a
        /// part of itself.
        operands: Vec<Spanned<Handle<ObjectDesc>>>,
    },
    /// Triangles.
    Triangles(MeshDesc),
    /// Bilinear patches.
    Patches(PatchMeshDesc),
    /// The contents of a mesh file: triangles and quadrilaterals (rendered as bilinear patches),
    /// which share vertices. One of the two may be empty.
    PlyMesh {
        /// Its triangles (and triangulated larger polygons).
        triangles: MeshDesc,
        /// Its quadrilaterals.
        patches: PatchMeshDesc,
        /// Displacement along the normal.
        displacement: Option<FloatParameter>,
        /// Before displacement, the surface is tessellated until its edges are shorter than this,
        /// in world space.
        edge_length: f32,
    },
    /// A curve.
    Curve(CurveDesc),
    /// The limit surface of a triangle mesh.
    LoopSubdivision {
        /// The coarse mesh.
        mesh: MeshDesc,
        /// Number of subdivisions.
        levels: i32,
    },
}

names! {
    /// The names of shapes. Triangles are also called `polygon`.
    ShapeType of ShapeKind {
        Sphere = "sphere",
        Spheres = "spheres",
        Cylinder = "cylinder",
        Cone = "cone",
        Paraboloid = "paraboloid",
        Hyperboloid = "hyperboloid",
        Disk = "disk",
        Plane = "plane",
        Triangles = "trianglemesh",
        Patches = "bilinearmesh",
        PlyMesh = "plymesh",
        Curve = "curve",
        LoopSubdivision = "loopsubdiv",
        Implicit = "implicit",
        Solid = "csg",
    }
}

/// Properties of a kind of shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeTraits {
    /// Whether it may be an area light.
    pub can_emit: bool,
    /// Whether it can be subdivided into patches, as radiosity requires.
    pub has_patches: bool,
}

impl ShapeKind {
    /// The properties of its kind.
    pub fn traits(&self) -> ShapeTraits {
        let (can_emit, has_patches) = match self {
            Self::Implicit { .. } | Self::Solid { .. } => (false, false),
            Self::Plane | Self::Curve(_) => (true, false),
            Self::Sphere { .. }
            | Self::Cylinder { .. }
            | Self::Cone { .. }
            | Self::Paraboloid { .. }
            | Self::Hyperboloid { .. }
            | Self::Disk { .. }
            | Self::Spheres(_)
            | Self::Triangles(_)
            | Self::Patches(_)
            | Self::PlyMesh { .. }
            | Self::LoopSubdivision { .. } => (true, true),
        };
        ShapeTraits { can_emit, has_patches }
    }
}

/// Whole spheres, as arrays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpheresDesc {
    /// Centres.
    pub centers: Arc<[Point3]>,
    /// One radius for all, or one for each.
    pub radii: Arc<[f32]>,
}

/// How bodies are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidOperation {
    /// Points in any of the bodies.
    Union,
    /// Points in all of the bodies.
    Intersection,
    /// Points in the first body and in no other.
    Difference,
}

/// Triangles that share vertices. Per-vertex arrays are empty or as long as `positions`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshDesc {
    /// Three vertices each.
    pub indices: Arc<[[u32; 3]]>,
    /// Vertex positions.
    pub positions: Arc<[Point3]>,
    /// Vertex normals.
    pub normals: Arc<[Normal3]>,
    /// Vertex tangents.
    pub tangents: Arc<[Vector3]>,
    /// Vertex texture coordinates.
    pub uvs: Arc<[Point2]>,
    /// A face index per triangle, from the file; or empty.
    pub face_indices: Arc<[i32]>,
    /// The vertices at later keys, at uniform intervals from the first to the last time of the
    /// shape's transform (`positions` are those at the first); empty if no vertex moves.
    pub later: Vec<MeshKey>,
}

/// The vertices of a mesh at a later key.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshKey {
    /// Vertex positions, as many as at the start.
    pub positions: Arc<[Point3]>,
    /// Vertex normals, as many as at the start.
    pub normals: Arc<[Normal3]>,
}

/// Bilinear patches that share vertices. Per-vertex arrays are empty or as long as `positions`.
#[derive(Clone, Debug, Default)]
pub struct PatchMeshDesc {
    /// Vertices at (u, v) = (0, 0), (1, 0), (0, 1), (1, 1).
    pub indices: Arc<[[u32; 4]]>,
    /// Vertex positions.
    pub positions: Arc<[Point3]>,
    /// Vertex normals.
    pub normals: Arc<[Normal3]>,
    /// Vertex texture coordinates.
    pub uvs: Arc<[Point2]>,
    /// A face index per patch, from the file; or empty.
    pub face_indices: Arc<[i32]>,
    /// An image by whose brightness points of the patch are sampled as a light.
    pub emission_image: Option<Handle<ImageDesc>>,
}

/// A curve: cubic or quadratic segments swept by a profile.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveDesc {
    /// Control points.
    pub control_points: Arc<[Point3]>,
    /// 2 or 3.
    pub degree: i32,
    /// Basis of the control points.
    pub basis: CurveBasis,
    /// The profile.
    pub profile: CurveProfile,
    /// Normals at the ends of segments, for ribbons; else empty.
    pub normals: Arc<[Normal3]>,
    /// Width at the start and at the end.
    pub width: [f32; 2],
    /// Each segment is split into 2^depth parts.
    pub split_depth: i32,
}

/// Basis of a curve's control points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CurveBasis {
    /// Bézier.
    #[default]
    Bezier,
    /// Uniform B-spline.
    BSpline,
}

/// The profile of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CurveProfile {
    /// A line that always faces the ray.
    #[default]
    Flat,
    /// A line shaded as a round fibre.
    Cylinder,
    /// A line oriented by normals.
    Ribbon,
}

/// A named group of shapes, rendered by its instances.
#[derive(Clone, Debug, Default)]
pub struct ObjectDesc {
    /// Its name.
    pub name: String,
    /// Its shapes, in the object's space.
    pub shapes: Arena<ShapeDesc>,
    /// Instances of other objects in it, up to eight levels deep.
    pub instances: Arena<InstanceDesc>,
}

/// An instance of an object.
#[derive(Clone, Debug)]
pub struct InstanceDesc {
    /// Which one.
    pub object: Handle<ObjectDesc>,
    /// From the object's space to the world (for an instance in an object: to the space of that).
    pub world_from_object: TransformDesc,
}
