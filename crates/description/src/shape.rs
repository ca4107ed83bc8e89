//! Shapes, objects made of shapes, and instances of objects.

use std::sync::Arc;

use math::{Normal3, Point2, Point3, Vec3, Vector3};

use crate::schema::{Domain, above, choices, from, members, settings};
use crate::{
    AreaLightDesc, Arena, FloatParameter, Handle, ImageDesc, MaterialDesc, MediumInterface, Span, Spanned,
    TransformDesc,
};

settings! {
    /// A shape with its transform, material, emission and media.
    #[derive(Clone, Debug)]
    pub struct ShapeDesc {
        /// The member of the set.
        kind: ShapeKind = ShapeKind::default() => ..;
        /// From the shape's space to the world (for a shape of an object: to the object's space).
        world_from_object: TransformDesc = TransformDesc::default();
        /// Flip its normals.
        reverse_orientation: bool = false;
        /// Whether the camera sees the front alone, and through the back what is behind. Other rays
        /// meet both sides.
        single_sided: bool = false => ["singlesided"];
        /// Its material; the format's default (grey, diffuse) if absent.
        material: Option<Handle<MaterialDesc>> = None;
        /// Its emission.
        area_light: Option<Handle<AreaLightDesc>> = None;
        /// Opacity, 0 to 1. If absent, 1. Where it is less, random points are cut out.
        alpha: Option<FloatParameter> = None => ["alpha"];
        /// The media on its two sides; the camera's side if absent.
        medium_interface: Option<MediumInterface> = None;
    }
}

impl From<ShapeKind> for ShapeDesc {
    fn from(kind: ShapeKind) -> Self {
        Self { kind, ..Self::default() }
    }
}

/// Radii, and the angle of sweeps.
const RADIUS: Domain = above(0.0).unit("scene units");
const SWEEP: Domain = above(0.0).unit("degrees");
/// Places along z, and lengths.
const LENGTH: Domain = Domain::ANY.unit("scene units");

members! {
    /// The shapes of the format, the quadrics of its third version, and an infinite plane.
    #[derive(Clone, Debug)]
    pub enum ShapeKind: ShapeType = Sphere {
        /// A sphere about the origin, cut at two z and swept about z.
        Sphere = "sphere" {
            /// Radius.
            radius: f32 = 1.0 => ["radius": RADIUS];
            /// Lowest z.
            z_min: f32 = -1.0;
            /// Highest z.
            z_max: f32 = 1.0;
            /// The angle by which it is swept.
            phi_max: f32 = 360.0 => ["phimax": SWEEP];
        },
        /// Many whole spheres, which take less memory than as many shapes.
        Spheres(SpheresDesc) = "spheres" [extension],
        /// A cylinder about z, open at its ends.
        Cylinder = "cylinder" {
            /// Radius.
            radius: f32 = 1.0 => ["radius": RADIUS];
            /// Lowest z.
            z_min: f32 = -1.0 => ["zmin": LENGTH];
            /// Highest z.
            z_max: f32 = 1.0 => ["zmax": LENGTH];
            /// The angle by which it is swept.
            phi_max: f32 = 360.0 => ["phimax": SWEEP];
        },
        /// A cone, as in pbrt-v3, with its base at z = 0, open there.
        Cone = "cone" [extension] {
            /// Radius of the base.
            radius: f32 = 1.0 => ["radius": RADIUS];
            /// The z of the apex.
            height: f32 = 1.0 => ["height": RADIUS];
            /// The angle by which it is swept.
            phi_max: f32 = 360.0 => ["phimax": SWEEP];
        },
        /// A paraboloid of revolution about z, as in pbrt-v3, with its apex at the origin.
        Paraboloid = "paraboloid" [extension] {
            /// Radius at z = `zmax`.
            radius: f32 = 1.0 => ["radius": RADIUS];
            /// Lowest z.
            z_min: f32 = 0.0 => ["zmin": LENGTH];
            /// Highest z.
            z_max: f32 = 1.0 => ["zmax": LENGTH];
            /// The angle by which it is swept.
            phi_max: f32 = 360.0 => ["phimax": SWEEP];
        },
        /// The surface that a segment sweeps about z, as in pbrt-v3.
        Hyperboloid = "hyperboloid" [extension] {
            /// The ends of the segment, of different z.
            ends: [Point3; 2] = [Vec3::ZERO, Vec3::ONE] => ["p1"[0], "p2"[1]];
            /// The angle by which it is swept.
            phi_max: f32 = 360.0 => ["phimax": SWEEP];
        },
        /// A disk across z.
        Disk = "disk" {
            /// Its z.
            height: f32 = 0.0 => ["height": LENGTH];
            /// Radius.
            radius: f32 = 1.0 => ["radius": RADIUS];
            /// Radius of the hole, below `radius`.
            inner_radius: f32 = 0.0 => ["innerradius": LENGTH];
            /// The angle by which it is swept.
            phi_max: f32 = 360.0 => ["phimax": SWEEP];
        },
        /// The infinite plane z = 0.
        Plane = "plane" [extension],
        /// Triangles.
        Triangles(MeshDesc) = "trianglemesh",
        /// Bilinear patches.
        Patches(PatchMeshDesc) = "bilinearmesh",
        /// The triangles and quadrilaterals of a mesh file. Quadrilaterals are bilinear patches,
        /// and share vertices with the triangles.
        PlyMesh = "plymesh" {
            /// Its triangles (and triangulated larger polygons).
            triangles: MeshDesc = MeshDesc::default();
            /// Its quadrilaterals.
            patches: PatchMeshDesc = PatchMeshDesc::default();
            /// Distance along the normal by which the surface is displaced, scene units.
            displacement: Option<FloatParameter> = None => ["displacement"];
            /// Longest edges of the tessellation of a displaced surface, in world space.
            edge_length: f32 = 1.0 => ["displacement.edgelength": RADIUS];
        },
        /// A curve of a width.
        Curve(CurveDesc) = "curve",
        /// The limit surface of a mesh of triangles by Loop subdivision.
        LoopSubdivision = "loopsubdiv" {
            /// The coarse mesh.
            mesh: MeshDesc = MeshDesc::default();
            /// Number of subdivisions.
            levels: i32 = 3 => ["levels": from(0.0, 12.0)];
        },
        /// The surface where a formula of x, y and z is zero.
        Implicit = "implicit" [extension] {
            /// The formula; the inside is where it is negative.
            formula: Spanned<String> = Spanned::new(String::new(), Span::NONE);
            /// Lowest and highest corner of the box that clips the surface.
            bounds: [Point3; 2] = [Vec3::splat(-2.0), Vec3::splat(2.0)] => ["bounds"];
        },
        /// Union, intersection or difference of the bodies of objects. Every shape of an object is
        /// a body, closed where it is clipped; several shapes are their union.
        Solid = "csg" [extension] {
            /// How they are combined.
            operation: SolidOperation = SolidOperation::Union;
            /// The bodies. A solid in an object refers only to earlier objects, so that no solid is
            /// a part of itself.
            operands: Vec<Spanned<Handle<ObjectDesc>>> = Vec::new();
        },
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

settings! {
    /// Whole spheres, as arrays.
    #[derive(Clone, Debug, PartialEq)]
    pub struct SpheresDesc {
        /// Centres.
        centers: Arc<[Point3]> = Arc::default();
        /// One radius for all, or one for each.
        radii: Arc<[f32]> = Arc::default();
    }
}

choices! {
    /// How bodies are combined.
    pub enum SolidOperation {
        /// Points in any of the bodies.
        #[default]
        Union = "union",
        /// Points in all of the bodies.
        Intersection = "intersection",
        /// Points in the first body and in no other.
        Difference = "difference",
    }
}

settings! {
    /// Triangles that share vertices. Per-vertex arrays are empty or as long as `positions`.
    #[derive(Clone, Debug, PartialEq)]
    pub struct MeshDesc {
        /// Three vertices each.
        indices: Arc<[[u32; 3]]> = Arc::default();
        /// Vertex positions.
        positions: Arc<[Point3]> = Arc::default();
        /// Vertex normals.
        normals: Arc<[Normal3]> = Arc::default();
        /// Vertex tangents.
        tangents: Arc<[Vector3]> = Arc::default();
        /// Vertex texture coordinates.
        uvs: Arc<[Point2]> = Arc::default();
        /// A face index per triangle, from the file; or empty.
        face_indices: Arc<[i32]> = Arc::default();
        /// The vertices at later keys, at uniform intervals from the first to the last time of the
        /// shape's transform (`positions` are those at the first); empty if no vertex moves.
        later: Vec<MeshKey> = Vec::new();
    }
}

/// The vertices of a mesh at a later key.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshKey {
    /// Vertex positions, as many as at the start.
    pub positions: Arc<[Point3]>,
    /// Vertex normals, as many as at the start.
    pub normals: Arc<[Normal3]>,
}

settings! {
    /// Bilinear patches that share vertices. Per-vertex arrays are empty or as long as `positions`.
    #[derive(Clone, Debug)]
    pub struct PatchMeshDesc {
        /// Vertices at (u, v) = (0, 0), (1, 0), (0, 1), (1, 1).
        indices: Arc<[[u32; 4]]> = Arc::default();
        /// Vertex positions.
        positions: Arc<[Point3]> = Arc::default();
        /// Vertex normals.
        normals: Arc<[Normal3]> = Arc::default();
        /// Vertex texture coordinates.
        uvs: Arc<[Point2]> = Arc::default();
        /// A face index per patch, from the file; or empty.
        face_indices: Arc<[i32]> = Arc::default();
        /// An image by whose brightness points of the patch are sampled as a light.
        emission_image: Option<Handle<ImageDesc>> = None;
    }
}

settings! {
    /// A curve: cubic or quadratic segments swept by a profile.
    #[derive(Clone, Debug, PartialEq)]
    pub struct CurveDesc {
        /// Control points.
        control_points: Arc<[Point3]> = Arc::default();
        /// Degree.
        degree: i32 = 3 => ["degree": from(2.0, 3.0)];
        /// Basis of the control points.
        basis: CurveBasis = CurveBasis::Bezier => ["basis"];
        /// The profile: `flat` faces the ray, `ribbon` has the normals `N`, `cylinder` is shaded as
        /// one.
        profile: CurveProfile = CurveProfile::Flat => ["type"];
        /// Normals at the ends of segments, for ribbons; else empty.
        normals: Arc<[Normal3]> = Arc::default();
        /// Width at the start and at the end.
        width: [f32; 2] = [1.0; 2];
        /// The curve is split into 2 to this power parts.
        split_depth: i32 = 3 => ["splitdepth": from(0.0, 20.0)];
    }
}

choices! {
    /// Basis of a curve's control points.
    pub enum CurveBasis {
        /// Bézier.
        #[default]
        Bezier = "bezier",
        /// Uniform B-spline.
        BSpline = "bspline",
    }
}

choices! {
    /// The profile of a curve.
    pub enum CurveProfile {
        /// A line that always faces the ray.
        #[default]
        Flat = "flat",
        /// A line oriented by normals.
        Ribbon = "ribbon",
        /// A line shaded as a round fibre.
        Cylinder = "cylinder",
    }
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
    /// The member of the set.
    pub object: Handle<ObjectDesc>,
    /// From the object's space to the world (for an instance in an object: to the space of that).
    pub world_from_object: TransformDesc,
}
