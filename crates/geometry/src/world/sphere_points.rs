//! Surface points of hits on spheres of sets, one hit in each lane.
//!
//! A hit is projected on its sphere: with the unit vector n from the centre to o + t·d, the point
//! is c + r·n. So the error of t moves it along the surface, where it does no harm, and its own
//! error is that of the last sum alone. Where the error of o + t·d is not small beside the radius,
//! lanes are left out.

use crate::patch::PatchPoints;
use crate::sphere_set::SphereSet;
use lanes::{Each, Real, acos, atan2};
use math::{MACHINE_EPSILON, Point3, Point3Error, Vec2, Vec3, Vector3, gamma};
use std::f32::consts::{PI, TAU};

/// The largest error of a hit before its projection, relative to the radius.
const ROUGH: f32 = 0.01;

/// Hits in lanes: spheres of a set, rays, and distances along them.
pub(super) struct SphereHits<R: Real> {
    pub sphere: R::Int,
    pub o: Point3<R>,
    pub d: Vector3<R>,
    pub t: R,
}

impl<R: Real> SphereHits<R> {
    /// The points on spheres of a set, and a mask of the lanes that have one.
    #[inline(always)]
    pub fn points(&self, set: &SphereSet) -> (PatchPoints<R>, R::Mask) {
        let (center, radius) = set.gather::<R>(self.sphere);
        let reached = self.d * self.t;
        let way = self.o + reached - center;
        let size = self.o.abs() + reached.abs() + center.abs();
        let error = size.max_element() * R::splat(4.0 * MACHINE_EPSILON);
        let (outwards, is_apart) = way.normalize_masked();
        let found = is_apart & error.le(radius * R::splat(ROUGH));
        // As for a single sphere, whose poles are on its z axis.
        let axes = set.axes();
        let [x, y, z] = axes.each(|axis| outwards.dot(Vec3::broadcast(axis)));
        let phi = atan2(y, x);
        let phi = R::select(phi.lt(R::zero()), phi + R::splat(TAU), phi);
        let one = R::one();
        let theta = acos(R::select(z.lt(-one), -one, R::select(one.lt(z), one, z)));
        let across = (x * x + y * y).sqrt();
        // A direction for the tangents at the pole.
        let is_pole = across.eq(R::zero());
        let x = R::select(is_pole, R::splat(1e-5), x);
        let across = R::select(is_pole, R::splat(1e-5), across);
        let tau = R::splat(TAU);
        let dpdu = turned(&axes, [-y * tau, x * tau, R::zero()]) * radius;
        let down = R::splat(-PI);
        let dpdv = turned(&axes, [z * x / across * down, z * y / across * down, -across * down]) * radius;
        let n = if set.flips() { -outwards } else { outwards };
        let p = center + outwards * radius;
        let error = (center.abs() + Vec3::splat(radius)) * R::splat(gamma(6));
        let uv = Vec2::new(phi / tau, one - theta / R::splat(PI));
        (PatchPoints { p: Point3Error::new(p, error), n, ns: n, uv, dpdu, dpdv, ss: dpdu }, found)
    }
}

/// A vector of these coordinates along axes.
#[inline(always)]
fn turned<R: Real>(&[a, b, c]: &[Vector3; 3], [x, y, z]: [R; 3]) -> Vector3<R> {
    Vec3::broadcast(a) * x + Vec3::broadcast(b) * y + Vec3::broadcast(c) * z
}

/// The points of `a` in the lanes of a mask, those of `b` in the others.
#[inline(always)]
pub(super) fn select<R: Real>(mask: R::Mask, a: &PatchPoints<R>, b: &PatchPoints<R>) -> PatchPoints<R> {
    PatchPoints {
        p: Point3Error::new(Vec3::select(mask, a.p.p, b.p.p), Vec3::select(mask, a.p.error, b.p.error)),
        n: Vec3::select(mask, a.n, b.n),
        ns: Vec3::select(mask, a.ns, b.ns),
        uv: Vec2::select(mask, a.uv, b.uv),
        dpdu: Vec3::select(mask, a.dpdu, b.dpdu),
        dpdv: Vec3::select(mask, a.dpdv, b.dpdv),
        ss: Vec3::select(mask, a.ss, b.ss),
    }
}
