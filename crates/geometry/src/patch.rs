//! Triangles and bilinear patches as plain data, from which lanes compute surface points.

use lanes::{Each, Mask, Real};
use math::{Normal3, Point3, Point3Error, Vec2, Vec3, Vector3, coordinate_system, face_forward, gamma};

/// A triangle or a bilinear patch, `p(a, b) = corner + a·sides[0] + b·sides[1] + a·b·twist`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// p(0, 0).
    pub corner: Point3,
    /// To p(1, 0) and to p(0, 1).
    pub sides: [Vector3; 2],
    /// Zero where the primitive is a triangle or a parallelogram.
    pub twist: Vector3,
    /// Shading normals at p(0, 0), p(1, 0) and p(0, 1).
    pub normals: Option<[Normal3; 3]>,
    /// Texture coordinates at p(0, 0), p(1, 0) and p(0, 1).
    pub uv: [Vec2; 3],
    /// Whether the outside is not on the side of `sides[0] × sides[1]`.
    pub flips: bool,
}

/// Points of primitives, one for each lane.
#[derive(Clone, Copy, Debug)]
pub struct PatchPoints<R: Real> {
    /// Position, with a bound of its error.
    pub p: Point3Error<R>,
    /// Unit geometric normal, on the side of the shading normal.
    pub n: Normal3<R>,
    /// Unit shading normal.
    pub ns: Normal3<R>,
    /// Texture coordinates.
    pub uv: Vec2<R>,
    /// ∂p/∂u.
    pub dpdu: Vector3<R>,
    /// ∂p/∂v.
    pub dpdv: Vector3<R>,
    /// A tangent along which shading has its x axis, but for its part along the shading normal.
    pub ss: Vector3<R>,
}

/// Triangles or patches, one in each lane.
#[derive(Clone, Copy)]
pub(crate) struct PatchLanes<R: Real> {
    pub corner: Point3<R>,
    pub sides: [Vector3<R>; 2],
    /// `None` where no lane has any.
    pub twist: Option<Vector3<R>>,
    /// Zero in lanes without shading normals; `None` where no lane has any.
    pub normals: Option<[Normal3<R>; 3]>,
    /// Shading tangents; zero in lanes without, `None` where no lane has any.
    pub tangents: Option<[Vector3<R>; 3]>,
    pub uv: [Vec2<R>; 3],
    /// −1 where the outside is not on the side of `sides[0] × sides[1]`, else 1.
    pub sign: R,
}

impl<R: Real> PatchLanes<R> {
    /// The same in all lanes.
    #[inline(always)]
    pub fn splat(patch: &Patch) -> Self {
        let [right, up] = patch.sides;
        let [a, b, c] = patch.uv;
        let mut normals = None;
        if let Some(given) = patch.normals {
            normals = Some(given.each(Vec3::broadcast));
        }
        let twist = if patch.twist == Vec3::ZERO { None } else { Some(Vec3::broadcast(patch.twist)) };
        Self {
            corner: Vec3::broadcast(patch.corner),
            sides: [Vec3::broadcast(right), Vec3::broadcast(up)],
            twist,
            normals,
            tangents: None,
            uv: [Vec2::broadcast(a), Vec2::broadcast(b), Vec2::broadcast(c)],
            sign: R::splat(if patch.flips { -1.0 } else { 1.0 }),
        }
    }

    /// `a` where the mask is true, else `b`.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: &Self, b: &Self) -> Self {
        let none = Vec3::splat(R::zero());
        let twist = match (a.twist, b.twist) {
            (None, None) => None,
            (a, b) => Some(Vec3::select(mask, a.unwrap_or(none), b.unwrap_or(none))),
        };
        let normals = match (a.normals, b.normals) {
            (None, None) => None,
            (a, b) => Some(select_each(mask, a.unwrap_or([none; 3]), b.unwrap_or([none; 3]))),
        };
        let tangents = match (a.tangents, b.tangents) {
            (None, None) => None,
            (a, b) => Some(select_each(mask, a.unwrap_or([none; 3]), b.unwrap_or([none; 3]))),
        };
        let [right, up] = [0, 1].each(|side: usize| Vec3::select(mask, a.sides[side], b.sides[side]));
        Self {
            corner: Vec3::select(mask, a.corner, b.corner),
            sides: [right, up],
            twist,
            normals,
            tangents,
            uv: [0, 1, 2].each(|corner: usize| Vec2::select(mask, a.uv[corner], b.uv[corner])),
            sign: R::select(mask, a.sign, b.sign),
        }
    }

    /// The points with parameters (a, b), and a mask of those that have a normal.
    #[inline(always)]
    pub fn points(&self, a: R, b: R) -> (PatchPoints<R>, R::Mask) {
        let Self { corner, sides: [right, up], .. } = *self;
        let [along, across] = [right * a, up * b];
        let (mut p, mut size) = (corner + along + across, corner.abs() + along.abs() + across.abs());
        let [mut du, mut dv] = [right, up];
        if let Some(twist) = self.twist {
            let twisted = twist * (a * b);
            (p, size) = (p + twisted, size + twisted.abs());
            (du, dv) = (du + twist * b, dv + twist * a);
        }
        let p = Point3Error::new(p, size * R::splat(gamma(5)));
        let cross = du.balanced().cross(dv.balanced());
        let squared = cross.length_squared();
        let mut n = cross * (self.sign / squared.sqrt());
        let [dpdu, dpdv] = tangents([du, dv], &self.uv, n);
        let c = R::one() - a - b;
        let mut ns = n;
        if let Some(normals) = self.normals {
            let (mixed, is_smooth) = (normals[0] * c + normals[1] * a + normals[2] * b).normalize_masked();
            ns = Vec3::select(is_smooth, mixed, n);
            n = face_forward(n, ns);
        }
        let mut ss = dpdu;
        if let Some(tangents) = self.tangents {
            let mixed = tangents[0] * c + tangents[1] * a + tangents[2] * b;
            ss = Vec3::select(mixed.abs().max_element().gt(R::zero()), mixed, dpdu);
        }
        let uv = self.uv[0] * c + self.uv[1] * a + self.uv[2] * b;
        let points = PatchPoints { p, n, ns, uv, dpdu, dpdv, ss };
        (points, squared.ge(R::splat(f32::MIN_POSITIVE)))
    }
}

#[inline(always)]
fn select_each<R: Real>(mask: R::Mask, a: [Vector3<R>; 3], b: [Vector3<R>; 3]) -> [Vector3<R>; 3] {
    [Vec3::select(mask, a[0], b[0]), Vec3::select(mask, a[1], b[1]), Vec3::select(mask, a[2], b[2])]
}

/// ∂p/∂u and ∂p/∂v by the texture coordinates of the corners, or any tangents where they have no
/// area.
#[inline(always)]
fn tangents<R: Real>([du, dv]: [Vector3<R>; 2], uv: &[Vec2<R>; 3], n: Normal3<R>) -> [Vector3<R>; 2] {
    let (st_du, st_dv) = (uv[1] - uv[0], uv[2] - uv[0]);
    let determinant = st_du.x * st_dv.y - st_dv.x * st_du.y;
    let inverse = R::one() / determinant;
    let dpdu = (du * st_dv.y - dv * st_du.y) * inverse;
    let dpdv = (dv * st_du.x - du * st_dv.x) * inverse;
    let squared = dpdu.balanced().cross(dpdv.balanced()).length_squared();
    let is_regular = squared.gt(R::zero()) & squared.lt(R::splat(f32::INFINITY));
    if is_regular.all() {
        return [dpdu, dpdv];
    }
    let (any_u, any_v) = coordinate_system(n);
    [Vec3::select(is_regular, dpdu, any_u), Vec3::select(is_regular, dpdv, any_v)]
}
