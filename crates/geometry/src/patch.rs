//! Triangles and bilinear patches as plain data, from which lanes compute surface points.

use crate::surface::any_tangents;
use lanes::{MAX_LANES, Real};
use math::{Normal3, Point3, Point3Error, Vec2, Vec3, Vector3, face_forward, gamma};

/// A triangle or a bilinear patch, `p(a, b) = corner + a·sides[0] + b·sides[1] + a·b·twist`.
#[derive(Clone, Copy, Debug)]
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
    /// ∂p/∂u at p(0, 0).
    pub dpdu: Vector3,
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
}

/// Primitives, one for each lane, with the parameters of the hits.
#[derive(Clone, Debug)]
pub struct PatchLanes {
    values: [[f32; MAX_LANES]; Self::COLUMNS],
}

impl PatchLanes {
    /// Corner, sides, normals, ∂p/∂u, twist, parameters, the signs of the normals, texture
    /// coordinates.
    const COLUMNS: usize = 3 + 6 + 9 + 3 + 3 + 2 + 1 + 6;

    /// No primitives.
    #[inline(always)]
    pub fn new() -> Self {
        Self { values: [[0.0; MAX_LANES]; Self::COLUMNS] }
    }

    /// Sets a lane.
    #[inline]
    pub fn set(&mut self, lane: usize, patch: &Patch, uv: Vec2) {
        let normals = patch.normals.unwrap_or([Vec3::ZERO; 3]);
        let Patch { corner, sides, dpdu, twist, .. } = *patch;
        let vectors = [corner, sides[0], sides[1], normals[0], normals[1], normals[2], dpdu, twist];
        for (i, v) in vectors.into_iter().enumerate() {
            for (axis, value) in v.to_array().into_iter().enumerate() {
                self.values[3 * i + axis][lane] = value;
            }
        }
        let sign = if patch.flips { -1.0 } else { 1.0 };
        let [st0, st1, st2] = patch.uv;
        let numbers = [uv.x, uv.y, sign, st0.x, st0.y, st1.x, st1.y, st2.x, st2.y];
        for (i, value) in numbers.into_iter().enumerate() {
            self.values[3 * vectors.len() + i][lane] = value;
        }
    }

    #[inline(always)]
    fn number<R: Real>(&self, column: usize) -> R {
        R::load(&self.values[column])
    }

    #[inline(always)]
    fn pair<R: Real>(&self, first: usize) -> Vec2<R> {
        Vec2::new(self.number(first), self.number(first + 1))
    }

    #[inline(always)]
    fn vector<R: Real>(&self, first: usize) -> Vector3<R> {
        Vec3::new(self.number(first), self.number(first + 1), self.number(first + 2))
    }

    /// The points of the hits.
    #[inline(always)]
    pub fn points<R: Real>(&self) -> PatchPoints<R> {
        let (corner, sides) = (self.vector::<R>(0), [self.vector::<R>(3), self.vector::<R>(6)]);
        let normals = [self.vector::<R>(9), self.vector::<R>(12), self.vector::<R>(15)];
        let (dpdu, twist) = (self.vector::<R>(18), self.vector::<R>(21));
        let (a, b, sign) = (self.number::<R>(24), self.number::<R>(25), self.number::<R>(26));
        let [along, across, twisted] = [sides[0] * a, sides[1] * b, twist * (a * b)];
        let size = corner.abs() + along.abs() + across.abs() + twisted.abs();
        let p = Point3Error::new(corner + along + across + twisted, size * R::splat(gamma(5)));
        let cross = (sides[0] + twist * b).cross(sides[1] + twist * a);
        let n = cross.normalize() * sign;
        let c = R::one() - a - b;
        let uv = self.pair(27) * c + self.pair(29) * a + self.pair(31) * b;
        let mixed = normals[0] * c + normals[1] * a + normals[2] * b;
        let (ns, is_smooth) = mixed.normalize_masked();
        let ns = Vec3::select(is_smooth, ns, n);
        PatchPoints { p, n: face_forward(n, ns), ns, uv, dpdu: dpdu + twist * b }
    }
}

impl Default for PatchLanes {
    fn default() -> Self {
        Self::new()
    }
}

/// ∂p/∂u of a triangle by its texture coordinates, or any tangent.
pub(crate) fn tangent(sides: [Vector3; 2], uv: &[Vec2; 3], n: Normal3) -> Vector3 {
    let (du, dv) = (uv[1] - uv[0], uv[2] - uv[0]);
    let determinant = du.x * dv.y - dv.x * du.y;
    let dpdu = (sides[0] * dv.y - sides[1] * du.y) / determinant;
    if dpdu.is_finite() && dpdu.length_squared() > 0.0 { dpdu } else { any_tangents(n)[0] }
}
