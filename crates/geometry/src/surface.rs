//! Surface points: position, normals and partial derivatives.
//!
//! Conventions are those of [Pharr 2023 §3.11, §6.5]: `n` is the geometric normal, dpdu × dpdv
//! normalised, flipped when the shape's orientation is reversed or its transform swaps handedness,
//! but not both. Where there are interpolated shading normals, `n` is flipped to their side.

use crate::placement::Placement;
use math::{
    DVec3, MACHINE_EPSILON, Normal3, Point3Error, Ray, Vec2, Vec3, Vector3, coordinate_system, face_forward,
};

/// The shading geometry, which interpolated normals or tangents make differ from the geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shading<R = f32> {
    /// Unit normal.
    pub n: Normal3<R>,
    /// ∂p/∂u.
    pub dpdu: Vector3<R>,
    /// ∂p/∂v.
    pub dpdv: Vector3<R>,
    /// ∂n/∂u.
    pub dndu: Normal3<R>,
    /// ∂n/∂v.
    pub dndv: Normal3<R>,
}

/// A point on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position, with a bound of its error.
    pub p: Point3Error,
    /// Unit geometric normal.
    pub n: Normal3,
    /// Whether `n` was flipped to the side of interpolated normals, and is that of the back face.
    pub is_flipped: bool,
    /// Texture coordinates.
    pub uv: Vec2,
    /// ∂p/∂u.
    pub dpdu: Vector3,
    /// ∂p/∂v.
    pub dpdv: Vector3,
    /// ∂n/∂u.
    pub dndu: Normal3,
    /// ∂n/∂v.
    pub dndv: Normal3,
    /// Shading geometry.
    pub shading: Shading,
    /// Unit vector back along the ray.
    pub wo: Vector3,
    /// Shutter time.
    pub time: f32,
}

impl SurfacePoint {
    /// A point hit by `ray`, whose shading geometry is its geometry.
    pub(crate) fn new(
        p: Point3Error,
        n: Normal3,
        uv: Vec2,
        [dpdu, dpdv]: [Vector3; 2],
        [dndu, dndv]: [Normal3; 2],
        ray: &Ray,
    ) -> Self {
        let shading = Shading { n, dpdu, dpdv, dndu, dndv };
        let wo = (-ray.d).normalize_or_zero();
        Self { p, n, is_flipped: false, uv, dpdu, dpdv, dndu, dndv, shading, wo, time: ray.time }
    }

    /// Sets the shading geometry, and flips `n` to the side of its normal.
    pub(crate) fn set_shading(&mut self, shading: Shading) {
        let n = face_forward(self.n, shading.n);
        (self.is_flipped, self.n) = (n != self.n, n);
        self.shading = shading;
    }

    /// The geometric normal of the front face, which does not depend on interpolated normals.
    #[inline]
    pub fn front(&self) -> Normal3 {
        if self.is_flipped { -self.n } else { self.n }
    }

    /// A ray along `d` with its origin clear of this surface.
    #[inline]
    pub fn spawn_ray(&self, d: Vector3) -> Ray {
        Ray::spawn(self.p, self.n, d, self.time)
    }

    /// The same point in the space around an instance. The error grows by that of a ray that is
    /// spawned there and transformed back.
    pub(crate) fn placed(&self, placement: &Placement, ray: &Ray) -> Self {
        let vector = |v: Vector3| placement.vector(v.as_dvec3());
        let change = |n: Normal3, dn: Normal3| placement.normal_change(n.as_dvec3(), dn.as_dvec3());
        let unit = |n: Normal3| placement.unit_normal(n.as_dvec3());
        let return_loss = self.p.p.abs() * (2.0 * MACHINE_EPSILON);
        let n = unit(self.n);
        Self {
            p: placement.point(self.p.p.as_dvec3(), (self.p.error + return_loss).as_dvec3()),
            n,
            is_flipped: self.is_flipped,
            uv: self.uv,
            dpdu: vector(self.dpdu),
            dpdv: vector(self.dpdv),
            dndu: change(self.n, self.dndu),
            dndv: change(self.n, self.dndv),
            shading: Shading {
                n: face_forward(unit(self.shading.n), n),
                dpdu: vector(self.shading.dpdu),
                dpdv: vector(self.shading.dpdv),
                dndu: change(self.shading.n, self.shading.dndu),
                dndv: change(self.shading.n, self.shading.dndv),
            },
            wo: (-ray.d).normalize_or_zero(),
            time: ray.time,
        }
    }
}

/// Tangents of a surface with unit normal `n` whose parametrisation is degenerate.
pub(crate) fn any_tangents(n: Normal3) -> [Vector3; 2] {
    let (u, v) = coordinate_system(n);
    [u, v]
}

/// The derivatives by texture coordinates (s, t) from those by (u, v): the inverse of the Jacobian
/// ∂(s,t)/∂(u,v). `None` where it is singular.
pub(crate) fn by_texture(d: [DVec3; 2], st_du: Vec2, st_dv: Vec2) -> Option<[DVec3; 2]> {
    let (du, dv) = (st_du.as_dvec2(), st_dv.as_dvec2());
    let determinant = du.x * dv.y - dv.x * du.y;
    (determinant != 0.0)
        .then(|| [(d[0] * dv.y - d[1] * du.y) / determinant, (d[1] * du.x - d[0] * dv.x) / determinant])
}

/// The interpolation a·(1 − b₁ − b₂) + b·b₁ + c·b₂, whose weights sum to one exactly.
#[inline]
pub(crate) fn barycentric(v: &[Vec3; 3], b: Vec2) -> DVec3 {
    let [v0, v1, v2] = v.map(|v| v.as_dvec3());
    v0 + (v1 - v0) * b.x as f64 + (v2 - v0) * b.y as f64
}
