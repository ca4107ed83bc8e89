//! Axis-aligned boxes.

use crate::{Point3, Ray, Vec2, Vec3, Vector3, gamma};
use lanes::Real;

/// A box in space. The empty box has its minimum above its maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    /// Lowest corner.
    pub min: Point3,
    /// Highest corner.
    pub max: Point3,
}

impl Bounds3 {
    /// The empty box.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box of two opposite corners, in any order.
    #[inline]
    pub fn new(a: Point3, b: Point3) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }

    /// The smallest box around the points.
    pub fn around(points: impl IntoIterator<Item = Point3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.union_point(p))
    }

    /// Whether the box contains no point.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// The smallest box around both.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The smallest box around this one and a point.
    #[inline]
    pub fn union_point(self, p: Point3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The intersection; empty when the boxes are disjoint.
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// The box grown by `delta` on every side.
    #[inline]
    pub fn expand(self, delta: f32) -> Self {
        Self { min: self.min - delta, max: self.max + delta }
    }

    /// From the lowest corner to the highest.
    #[inline]
    pub fn diagonal(&self) -> Vector3 {
        self.max - self.min
    }

    /// The middle.
    #[inline]
    pub fn centroid(&self) -> Point3 {
        (self.min + self.max) * 0.5
    }

    /// The area of the six sides; 0 for the empty box.
    #[inline]
    pub fn surface_area(&self) -> f32 {
        let d = self.diagonal().max(Vec3::ZERO);
        2.0 * (d.x * d.y + d.y * d.z + d.z * d.x)
    }

    /// The axis (0, 1, 2) of the longest side.
    #[inline]
    pub fn longest_axis(&self) -> usize {
        let d = self.diagonal();
        if d.x >= d.y && d.x >= d.z {
            0
        } else if d.y >= d.z {
            1
        } else {
            2
        }
    }

    /// Whether a point lies inside, borders included.
    #[inline]
    pub fn contains(&self, p: Point3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// The corner whose bits 0, 1, 2 choose the high side of x, y, z.
    #[inline]
    pub fn corner(&self, i: usize) -> Point3 {
        let pick = |bit: usize, low: f32, high: f32| if i & bit == 0 { low } else { high };
        Vec3::new(
            pick(1, self.min.x, self.max.x),
            pick(2, self.min.y, self.max.y),
            pick(4, self.min.z, self.max.z),
        )
    }

    /// The eight corners.
    pub fn corners(&self) -> impl Iterator<Item = Point3> + '_ {
        (0..8).map(|i| self.corner(i))
    }

    /// Centre and radius of the sphere through the corners; radius 0 for the empty box.
    pub fn bounding_sphere(&self) -> (Point3, f32) {
        if self.is_empty() {
            return (Vec3::ZERO, 0.0);
        }
        let c = self.centroid();
        (c, c.distance(self.max))
    }

    /// The range [t0, t1] within `[0, t_max]` in which the ray is inside, widened by the rounding
    /// error of the slab test.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<(f32, f32)> {
        let inverse = ray.d.recip();
        let backwards = inverse.map(|c| c < 0.0);
        let pick = |backwards, a, b| if backwards { a } else { b };
        let ends = |a: Point3, b: Point3| {
            Vec3::new(pick(backwards.x, a.x, b.x), pick(backwards.y, a.y, b.y), pick(backwards.z, a.z, b.z))
        };
        let near = (ends(self.max, self.min) - ray.o) * inverse;
        let far = (ends(self.min, self.max) - ray.o) * inverse * (1.0 + 2.0 * gamma(3));
        // `f32::max` drops the NaN of 0 · ∞, which arises when the origin lies on a slab that the
        // ray is parallel to.
        let t0 = near.x.max(near.y).max(near.z).max(0.0);
        let t1 = far.x.min(far.y).min(far.z).min(t_max);
        (t0 <= t1).then_some((t0, t1))
    }
}

/// A rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds2 {
    /// Lowest corner.
    pub min: Vec2,
    /// Highest corner.
    pub max: Vec2,
}

impl Bounds2 {
    /// [0, 1]².
    pub const UNIT: Self = Self { min: Vec2::ZERO, max: Vec2::ONE };

    /// The rectangle of two opposite corners, in any order.
    #[inline]
    pub fn new(a: Vec2, b: Vec2) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }

    /// Width and height.
    #[inline]
    pub fn diagonal(&self) -> Vec2 {
        self.max - self.min
    }

    /// Width times height.
    #[inline]
    pub fn area(&self) -> f32 {
        let d = self.diagonal();
        d.x * d.y
    }

    /// The point at the fractions `t` of the sides.
    #[inline(always)]
    pub fn lerp<R: Real>(&self, t: Vec2<R>) -> Vec2<R> {
        Vec2::broadcast(self.min) + Vec2::broadcast(self.diagonal()) * t
    }

    /// The position of `p` as fractions of the sides.
    #[inline]
    pub fn offset(&self, p: Vec2) -> Vec2 {
        (p - self.min) / self.diagonal()
    }

    /// Whether a point lies inside, borders included.
    #[inline]
    pub fn contains(&self, p: Vec2) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }
}

/// A rectangle of pixels: columns `min[0]..max[0]`, rows `min[1]..max[1]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds2i {
    /// First column and row.
    pub min: [i32; 2],
    /// One past the last column and row.
    pub max: [i32; 2],
}

impl Bounds2i {
    /// The rectangle from `min` (inclusive) to `max` (exclusive).
    #[inline]
    pub fn new(min: [i32; 2], max: [i32; 2]) -> Self {
        Self { min, max }
    }

    /// Number of columns.
    #[inline]
    pub fn width(&self) -> i32 {
        (self.max[0] - self.min[0]).max(0)
    }

    /// Number of rows.
    #[inline]
    pub fn height(&self) -> i32 {
        (self.max[1] - self.min[1]).max(0)
    }

    /// Number of pixels.
    #[inline]
    pub fn area(&self) -> usize {
        self.width() as usize * self.height() as usize
    }

    /// The intersection.
    #[inline]
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            min: [self.min[0].max(other.min[0]), self.min[1].max(other.min[1])],
            max: [self.max[0].min(other.max[0]), self.max[1].min(other.max[1])],
        }
    }

    /// Whether the pixel lies inside.
    #[inline]
    pub fn contains(&self, p: [i32; 2]) -> bool {
        (self.min[0]..self.max[0]).contains(&p[0]) && (self.min[1]..self.max[1]).contains(&p[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slabs() {
        let b = Bounds3::new(Vec3::ZERO, Vec3::ONE);
        let ray = |o, d| Ray::new(o, d, 0.0);
        let hit = b.intersect(&ray(Vec3::new(-1.0, 0.5, 0.5), Vec3::X), f32::INFINITY).expect("hit");
        assert!((hit.0 - 1.0).abs() < 1e-6 && (hit.1 - 2.0).abs() < 1e-5);
        assert!(b.intersect(&ray(Vec3::new(-1.0, 0.5, 0.5), Vec3::X), 0.5).is_none());
        assert!(b.intersect(&ray(Vec3::new(-1.0, 1.5, 0.5), Vec3::X), f32::INFINITY).is_none());
        assert!(
            b.intersect(&ray(Vec3::new(-1.0, 0.0, 0.5), Vec3::X), f32::INFINITY).is_some(),
            "along a side"
        );
    }

    #[test]
    fn the_empty_box_is_neutral() {
        let b = Bounds3::new(Vec3::ZERO, Vec3::ONE);
        assert!(Bounds3::EMPTY.is_empty() && Bounds3::EMPTY.surface_area() == 0.0);
        assert_eq!(b.union(Bounds3::EMPTY), b);
        assert_eq!(b.surface_area(), 6.0);
    }
}
