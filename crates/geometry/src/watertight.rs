//! Watertight ray–triangle intersection: no gaps between triangles that share an edge.
//!
//! The triangle is translated and sheared so that the ray becomes the +z axis from the origin. Its
//! edge functions there, e₀ = x₁y₂ − y₁x₂ and so on, are twice the areas that the origin makes with
//! each edge; the ray passes inside where no two differ in sign. Two triangles compute the function
//! of a shared edge from the same numbers and get opposite signs, so that no ray passes between
//! them ([Woop et al. 2013]; [Pharr 2023 §6.5.3]).
//!
//! Several triangles are tested at once, one per lane. Cases that floats cannot decide are resolved
//! in doubles, lane by lane: the side of an edge where an edge function vanishes, and whether a hit
//! closer than the rounding error of its distance is in front of the origin. Hits are thus lost
//! neither on edges nor in corners.

#![allow(unsafe_code)]

use lanes::{Each, F32x1, Vector};
use math::{Ray, Vec2, Vec3, Vec4, difference_of_products, gamma};

/// The sign of an edge function below this may be due to underflow.
const VANISHING: f32 = 1e-30;
/// A sum of edge functions below this may be too inaccurate for distances. Above its inverse,
/// products with distances may overflow.
const TINY: f32 = 1e-20;

/// A ray prepared for triangle tests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheared<'a> {
    ray: &'a Ray,
    /// A permutation of the axes with the main axis of the ray last.
    axes: [usize; 3],
    /// −d_x/d_z, −d_y/d_z and 1/d_z in permuted axes.
    shear: [f32; 3],
}

/// A ray in every lane, with permuted axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShearedLanes<V> {
    axes: [usize; 3],
    shear: [V; 3],
    o: [V; 3],
}

/// The result of each lane: a bit for each hit, and one where it is uncertain, to be resolved by
/// [`Sheared::resolve`]. Distances and barycentric coordinates are valid for certain hits.
pub(crate) struct LaneHits<V> {
    pub hits: u32,
    pub uncertain: u32,
    pub t: V,
    pub b1: V,
    pub b2: V,
}

impl<'a> Sheared<'a> {
    #[inline(always)]
    pub fn new(ray: &'a Ray) -> Self {
        const AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];
        let axes = AXES[main_axis(ray.d)];
        let d = ray.d.to_array();
        let [x, y, z] = axes.each(|a| d[a]);
        let [sx, sy, sz, _] = (Vec4::new(-x, -y, 1.0, 1.0) / Vec4::splat(z)).to_array();
        Self { ray, axes, shear: [sx, sy, sz] }
    }

    /// # Safety
    /// The processor must have the instruction set of `V`.
    #[inline(always)]
    pub unsafe fn lanes<const N: usize, V: Vector<N>>(&self) -> ShearedLanes<V> {
        let o = self.ray.o.to_array();
        // SAFETY: as the caller promises.
        unsafe {
            ShearedLanes {
                axes: self.axes,
                shear: self.shear.each(|x| V::splat(x)),
                o: self.axes.each(|a| V::splat(o[a])),
            }
        }
    }

    /// Several rays, one in each lane. All must have the same main axis.
    ///
    /// # Safety
    /// The processor must have the instruction set of `V`.
    #[inline(always)]
    pub unsafe fn each<const N: usize, V: Vector<N>>(rays: &[Self; N]) -> ShearedLanes<V> {
        let axes = rays[0].axes;
        let (mut shear, mut o) = ([[0.0; N]; 3], [[0.0; N]; 3]);
        for (lane, ray) in rays.iter().enumerate() {
            for i in 0..3 {
                shear[i][lane] = ray.shear[i];
                o[i][lane] = ray.ray.o[axes[i]];
            }
        }
        // SAFETY: as the caller promises.
        let load =
            |from: &[[f32; N]; 3]| unsafe { [V::load(&from[0]), V::load(&from[1]), V::load(&from[2])] };
        ShearedLanes { axes, shear: load(&shear), o: load(&o) }
    }

    /// The hit on a triangle at 0 < t < `t_max`: t, and the barycentric coordinates of corners 1
    /// and 2.
    #[inline]
    pub fn triangle(&self, corners: &[Vec3; 3], t_max: f32) -> Option<(f32, Vec2)> {
        // SAFETY: every processor computes with single floats.
        let (lane, float) = unsafe { (self.lanes::<1, F32x1>(), |x: f32| F32x1::splat(x)) };
        let found =
            LaneHits::of(corners.each(|corner| lane.shear(|axis| float(corner[axis]))), float(t_max))?;
        if found.uncertain != 0 {
            return self.resolve(corners).filter(|hit| hit.0 < t_max);
        }
        let (t, uv) = found.at(0);
        (t < t_max).then_some((t, uv))
    }

    /// Resolves an uncertain hit in doubles. Most are on the triangle that the ray leaves, behind
    /// its origin.
    #[cold]
    #[inline(never)]
    pub fn resolve(&self, corners: &[Vec3; 3]) -> Option<(f32, Vec2)> {
        let (height, slope) = self.exact_distance(corners);
        if height * slope <= 0.0 {
            return None;
        }
        let [ax, ay, az] = self.axes;
        let [sx, sy, sz] = self.shear;
        let sheared = |p: Vec3| {
            let v = p - self.ray.o;
            [sx.mul_add(v[az], v[ax]), sy.mul_add(v[az], v[ay]), v[az] * sz]
        };
        let [a, b, c] = [sheared(corners[0]), sheared(corners[1]), sheared(corners[2])];
        let mut e = [edge(b, c), edge(c, a), edge(a, b)];
        if e.iter().any(|e| e.abs() < VANISHING) {
            e = [exact_edge(b, c), exact_edge(c, a), exact_edge(a, b)];
        }
        if e.iter().any(|&e| e < 0.0) && e.iter().any(|&e| e > 0.0) {
            return None;
        }
        let determinant = e[0] + e[1] + e[2];
        let size = determinant.abs();
        // NaN fails.
        if !(TINY..=1.0 / TINY).contains(&size) {
            return in_doubles([a, b, c], height / slope);
        }
        let inverse = 1.0 / determinant;
        let mut t = e[0].mul_add(a[2], e[1].mul_add(b[2], e[2] * c[2])) * inverse;
        if !t.is_finite() {
            return None;
        }
        if t <= distance_error([a, b, c], e, inverse) {
            let exact = height / slope;
            if !(exact > 0.0 && exact.is_finite()) {
                return None;
            }
            t = exact as f32;
        }
        Some((t, Vec2::new(e[1] * inverse, e[2] * inverse)))
    }

    /// The distance of the triangle's plane as a quotient, in doubles.
    fn exact_distance(&self, corners: &[Vec3; 3]) -> (f64, f64) {
        let [a, b, c] = [corners[0].as_dvec3(), corners[1].as_dvec3(), corners[2].as_dvec3()];
        let n = (b - a).cross(c - a);
        (n.dot(a - self.ray.o.as_dvec3()), n.dot(self.ray.d.as_dvec3()))
    }
}

impl<V> ShearedLanes<V> {
    /// Translates and shears a point in each lane, given by its coordinates.
    #[inline(always)]
    pub fn shear<const N: usize>(&self, coordinate: impl Fn(usize) -> V) -> [V; 3]
    where
        V: Vector<N>,
    {
        let [ax, ay, az] = self.axes;
        let [sx, sy, sz] = self.shear;
        let [ox, oy, oz] = self.o;
        let [x, y, z] = [coordinate(ax).sub(ox), coordinate(ay).sub(oy), coordinate(az).sub(oz)];
        [sx.mul_add(z, x), sy.mul_add(z, y), z.mul(sz)]
    }
}

impl<V> LaneHits<V> {
    /// The distance and barycentric coordinates of a lane.
    #[inline(always)]
    pub fn at<const N: usize>(&self, lane: usize) -> (f32, Vec2)
    where
        V: Vector<N>,
    {
        (self.t.lane(lane), Vec2::new(self.b1.lane(lane), self.b2.lane(lane)))
    }

    /// Tests for hits at 0 < t ≤ `t_max` in each lane, given the sheared corners.
    #[inline(always)]
    pub fn of<const N: usize>([a, b, c]: [[V; 3]; 3], t_max: V) -> Option<Self>
    where
        V: Vector<N>,
    {
        let edge = |p: [V; 3], q: [V; 3]| {
            let yx = p[1].mul(q[0]);
            let difference = p[0].mul_sub(q[1], yx);
            difference.add(p[1].neg_mul_add(q[0], yx))
        };
        let e = [edge(b, c), edge(c, a), edge(a, b)];
        // SAFETY: vectors are the proof of the instruction set.
        let (zero, vanishing) = unsafe { (V::splat(0.0), V::splat(VANISHING)) };
        // Compared as integers, which takes less time: the most negative number is the greatest
        // unsigned integer, and the greatest positive number is the greatest signed one.
        let most_negative = e[0].max_uint(e[1]).max_uint(e[2]);
        let most_positive = e[0].max_int(e[1]).max_int(e[2]);
        let inside = zero.sub(vanishing).le(most_negative) | most_positive.le(vanishing);
        if inside == 0 {
            return None;
        }
        let determinant = e[0].add(e[1]).add(e[2]);
        // SAFETY: vectors are the proof of the instruction set.
        let (one, tiny, huge) = unsafe { (V::splat(1.0), V::splat(TINY), V::splat(1.0 / TINY)) };
        let inverse = one.div(determinant);
        let sum = e[0].mul_add(a[2], e[1].mul_add(b[2], e[2].mul(c[2])));
        let t = sum.mul(inverse);
        let size = determinant.abs();
        let is_extreme = size.lt(tiny) | huge.lt(size);
        let candidates = inside & (t.le(t_max) | is_extreme);
        if candidates == 0 {
            return None;
        }
        let least_positive = e[0].min_int(e[1]).min_int(e[2]);
        let least_negative = e[0].min_uint(e[1]).min_uint(e[2]);
        let clear = vanishing.le(least_positive) | least_negative.le(zero.sub(vanishing));
        let unsure = !clear | is_extreme;
        // A bound of the error of the sum, at least that of `distance_error`: one magnitude for x
        // and y, and the sum of the edge functions instead of the largest.
        let largest = |axis: usize| a[axis].abs().max_int(b[axis].abs()).max_int(c[axis].abs());
        let (xy, z) = (largest(0).max_int(largest(1)), largest(2));
        // SAFETY: vectors are the proof of the instruction set.
        let splat = |x: f32| unsafe { V::splat(x) };
        let (g3, g5, two, three) = (splat(6.0 * gamma(3)), splat(6.0 * gamma(5)), splat(2.0), splat(3.0));
        let of_edges = g5.mul(xy).mul(three.mul_add(xy, two.mul(z)));
        let error = g3.mul_add(determinant.abs(), of_edges).mul(z);
        let certain = error.lt(sum.abs());
        let hits = candidates & (unsure | !(certain & t.lt(zero)));
        let uncertain = hits & (unsure | !certain);
        (hits != 0).then(|| Self { hits, uncertain, t, b1: e[1].mul(inverse), b2: e[2].mul(inverse) })
    }
}

/// The axis of the largest component of a direction.
#[inline(always)]
pub(crate) fn main_axis(d: Vec3) -> usize {
    let size = d.abs();
    let x_leads = (size.x > size.y) & (size.x > size.z);
    if x_leads { 0 } else { 2 - (size.y > size.z) as usize }
}

#[inline]
fn edge(a: [f32; 3], b: [f32; 3]) -> f32 {
    difference_of_products(a[0], b[1], a[1], b[0])
}

/// A hit at the distance `t` on a triangle with these sheared corners, whose edge functions floats
/// cannot hold.
fn in_doubles([a, b, c]: [[f32; 3]; 3], t: f64) -> Option<(f32, Vec2)> {
    let e = [double_edge(b, c), double_edge(c, a), double_edge(a, b)];
    let (t, determinant) = (t as f32, e[0] + e[1] + e[2]);
    let is_hit = t > 0.0 && t.is_finite() && determinant.is_normal();
    is_hit.then(|| (t, Vec2::new((e[1] / determinant) as f32, (e[2] / determinant) as f32)))
}

fn double_edge(a: [f32; 3], b: [f32; 3]) -> f64 {
    a[0] as f64 * b[1] as f64 - a[1] as f64 * b[0] as f64
}

fn exact_edge(a: [f32; 3], b: [f32; 3]) -> f32 {
    let e = double_edge(a, b);
    // Rounding to a float must not lose the sign.
    if e != 0.0 && e as f32 == 0.0 { f32::MIN_POSITIVE.copysign(e as f32) } else { e as f32 }
}

/// A bound of the error of t ([Pharr 2023 §6.8.7]).
fn distance_error(corners: [[f32; 3]; 3], e: [f32; 3], inverse: f32) -> f32 {
    let largest = |v: [f32; 3]| v[0].abs().max(v[1].abs()).max(v[2].abs());
    let [x, y, z] = [0, 1, 2].each(|axis| largest(corners.each(|c| c[axis])));
    let dx = gamma(5) * (x + z);
    let dy = gamma(5) * (y + z);
    let dz = gamma(3) * z;
    let de = 2.0 * (gamma(2) * x * y + dy * x + dx * y);
    let e = largest(e);
    3.0 * (gamma(3) * e * z + de * z + dz * e) * inverse.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

    fn meet(o: Vec3, d: Vec3, t_max: f32) -> Option<(f32, Vec2)> {
        Sheared::new(&Ray::new(o, d, 0.0)).triangle(&TRIANGLE, t_max)
    }

    #[test]
    fn the_middle_edges_and_corners_are_met() {
        let (t, b) = meet(Vec3::new(0.25, 0.5, 2.0), -2.0 * Vec3::Z, 9.0).expect("hit");
        assert_eq!((t, b), (1.0, Vec2::new(0.25, 0.5)));
        for p in [Vec3::new(0.5, 0.0, 1.0), Vec3::new(0.5, 0.5, 1.0), Vec3::Z, Vec3::new(1.0, 0.0, 1.0)] {
            assert!(meet(p, -Vec3::Z, 2.0).is_some(), "{p}");
        }
    }

    #[test]
    fn misses() {
        let o = Vec3::new(0.25, 0.25, 1.0);
        assert!(meet(o, -Vec3::Z, 1.0).is_none(), "t_max is exclusive");
        assert!(meet(o, Vec3::Z, 9.0).is_none(), "behind");
        assert!(meet(o, Vec3::X, 9.0).is_none(), "along the plane");
        assert!(meet(o, Vec3::ZERO, 9.0).is_none(), "no direction");
        assert!(meet(Vec3::NAN, Vec3::X, 9.0).is_none());
        assert!(meet(Vec3::new(0.6, 0.6, 1.0), -Vec3::Z, 9.0).is_none());
    }

    #[test]
    fn degenerate_triangles_are_never_met() {
        let ray = Ray::new(Vec3::new(0.0, 0.0, 1.0), -Vec3::Z, 0.0);
        let s = Sheared::new(&ray);
        assert!(s.triangle(&[Vec3::ZERO; 3], 9.0).is_none());
        assert!(s.triangle(&[-Vec3::X, Vec3::ZERO, Vec3::X], 9.0).is_none());
        assert!(s.triangle(&[Vec3::NAN, Vec3::ZERO, Vec3::X], 9.0).is_none());
        assert!(s.triangle(&[Vec3::INFINITY, Vec3::ZERO, Vec3::X], 9.0).is_none());
    }

    #[test]
    fn very_near_hits_are_distinguished_from_those_behind() {
        let o = Vec3::new(0.25, 0.25, 1e-9);
        let d = Vec3::new(0.3, 0.1, -1.0);
        assert!(meet(o, d, 9.0).is_some_and(|(t, _)| (t - 1e-9).abs() < 1e-15));
        assert!(meet(-o, d, 9.0).is_none());
    }
}
