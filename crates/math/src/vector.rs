//! Vectors of two and three coordinates, each one `f32` or one for each lane.
//!
//! Matrices, and vectors of four coordinates or of double precision, are those of glam. What makes
//! sense for one lane only is defined for `f32` alone.

use crate::balance;
use glam::{BVec2, BVec3, DVec2, DVec3, Vec4};
use lanes::{Each, Real};
use std::fmt;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};

/// Two coordinates.
#[derive(Clone, Copy, Default, PartialEq)]
#[repr(C)]
pub struct Vec2<R = f32> {
    /// The first coordinate.
    pub x: R,
    /// The second coordinate.
    pub y: R,
}

/// Three coordinates.
#[derive(Clone, Copy, Default, PartialEq)]
#[repr(C)]
pub struct Vec3<R = f32> {
    /// The first coordinate.
    pub x: R,
    /// The second coordinate.
    pub y: R,
    /// The third coordinate.
    pub z: R,
}

/// An operator between vectors, between a vector and a number, and with assignment.
macro_rules! operator {
    ($vector:ident($($c:ident)*): $Op:ident $op:ident, $Assign:ident $assign:ident) => {
        impl<R: Real> $Op for $vector<R> {
            type Output = Self;
            #[inline(always)]
            fn $op(self, b: Self) -> Self {
                Self { $($c: self.$c.$op(b.$c)),* }
            }
        }
        impl<R: Real> $Op<R> for $vector<R> {
            type Output = Self;
            #[inline(always)]
            fn $op(self, b: R) -> Self {
                Self { $($c: self.$c.$op(b)),* }
            }
        }
        impl $Op<$vector> for f32 {
            type Output = $vector;
            #[inline(always)]
            fn $op(self, b: $vector) -> $vector {
                $vector { $($c: self.$op(b.$c)),* }
            }
        }
        impl<R: Real> $Assign for $vector<R> {
            #[inline(always)]
            fn $assign(&mut self, b: Self) {
                *self = (*self).$op(b);
            }
        }
        impl<R: Real> $Assign<R> for $vector<R> {
            #[inline(always)]
            fn $assign(&mut self, b: R) {
                *self = (*self).$op(b);
            }
        }
    };
}

/// What vectors of all sizes have.
macro_rules! vector {
    ($vector:ident($($c:ident $i:literal),*), $n:literal, $glam:ident $double:ident $mask:ident) => {
        operator!($vector($($c)*): Add add, AddAssign add_assign);
        operator!($vector($($c)*): Sub sub, SubAssign sub_assign);
        operator!($vector($($c)*): Mul mul, MulAssign mul_assign);
        operator!($vector($($c)*): Div div, DivAssign div_assign);

        impl<R: Real> Neg for $vector<R> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self { $($c: -self.$c),* }
            }
        }

        impl<R: Real> $vector<R> {
            /// The vector with these coordinates.
            #[inline(always)]
            pub const fn new($($c: R),*) -> Self {
                Self { $($c),* }
            }

            /// The vector whose coordinates are all `c`.
            #[inline(always)]
            pub const fn splat(c: R) -> Self {
                Self { $($c: c),* }
            }

            /// The vector of the coordinates of an array.
            #[inline(always)]
            pub const fn from_array([$($c),*]: [R; $n]) -> Self {
                Self { $($c),* }
            }

            /// The coordinates.
            #[inline(always)]
            pub const fn to_array(self) -> [R; $n] {
                [$(self.$c),*]
            }

            /// The same vector in all lanes.
            #[inline(always)]
            pub fn broadcast(v: $vector) -> Self {
                v.map(R::splat)
            }

            /// `a` where the mask is true, else `b`.
            #[inline(always)]
            pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
                a.zip(b, |a, b| R::select(mask, a, b))
            }

            /// `f` of each coordinate.
            #[inline(always)]
            pub fn map<S>(self, mut f: impl FnMut(R) -> S) -> $vector<S> {
                $vector { $($c: f(self.$c)),* }
            }

            /// `f` of each pair of coordinates.
            #[inline(always)]
            pub fn zip<S>(self, b: Self, mut f: impl FnMut(R, R) -> S) -> $vector<S> {
                $vector { $($c: f(self.$c, b.$c)),* }
            }

            /// The absolute value of each coordinate.
            #[inline(always)]
            pub fn abs(self) -> Self {
                self.map(R::abs)
            }
        }

        impl $vector {
            /// All zeros.
            pub const ZERO: Self = Self::splat(0.0);
            /// All ones.
            pub const ONE: Self = Self::splat(1.0);
            /// All +∞.
            pub const INFINITY: Self = Self::splat(f32::INFINITY);
            /// All −∞.
            pub const NEG_INFINITY: Self = Self::splat(f32::NEG_INFINITY);
            /// All NaN.
            pub const NAN: Self = Self::splat(f32::NAN);

            /// The vector of length one with the same direction; `None` where a coordinate is not
            /// finite, or all are zero.
            #[inline(always)]
            pub fn try_normalize(self) -> Option<Self> {
                let (v, valid) = self.normalize_masked();
                valid.then_some(v)
            }

            /// [`try_normalize`](Self::try_normalize), or `otherwise`.
            #[inline(always)]
            pub fn normalize_or(self, otherwise: Self) -> Self {
                self.try_normalize().unwrap_or(otherwise)
            }

            /// [`try_normalize`](Self::try_normalize), or the zero vector.
            #[inline(always)]
            pub fn normalize_or_zero(self) -> Self {
                self.normalize_or(Self::ZERO)
            }

            /// Whether the length is one, but for rounding.
            #[inline]
            pub fn is_normalized(self) -> bool {
                (self.length_squared() - 1.0).abs() <= 2e-4
            }

            /// Whether all coordinates are finite.
            #[inline]
            pub fn is_finite(self) -> bool {
                true $(&& self.$c.is_finite())*
            }

            /// Whether any coordinate is NaN.
            #[inline]
            pub fn is_nan(self) -> bool {
                false $(|| self.$c.is_nan())*
            }

            /// Whether each coordinate is < that of `b`.
            #[inline(always)]
            pub fn cmplt(self, b: Self) -> $mask {
                $mask::new($(self.$c < b.$c),*)
            }

            /// Whether each coordinate is ≤ that of `b`.
            #[inline(always)]
            pub fn cmple(self, b: Self) -> $mask {
                $mask::new($(self.$c <= b.$c),*)
            }

            /// Whether each coordinate is > that of `b`.
            #[inline(always)]
            pub fn cmpgt(self, b: Self) -> $mask {
                b.cmplt(self)
            }

            /// Whether each coordinate is ≥ that of `b`.
            #[inline(always)]
            pub fn cmpge(self, b: Self) -> $mask {
                b.cmple(self)
            }
        }

        impl<R> Index<usize> for $vector<R> {
            type Output = R;
            /// # Panics
            /// If there is no such coordinate.
            #[inline(always)]
            fn index(&self, axis: usize) -> &R {
                match axis {
                    $($i => &self.$c,)*
                    _ => panic!("no axis {axis}"),
                }
            }
        }

        impl<R> IndexMut<usize> for $vector<R> {
            #[inline(always)]
            fn index_mut(&mut self, axis: usize) -> &mut R {
                match axis {
                    $($i => &mut self.$c,)*
                    _ => panic!("no axis {axis}"),
                }
            }
        }

        impl<R: fmt::Debug> fmt::Debug for $vector<R> {
            fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
                let mut tuple = f.debug_tuple(stringify!($vector));
                $(tuple.field(&self.$c);)*
                tuple.finish()
            }
        }

        impl fmt::Display for $vector {
            fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
                fmt::Display::fmt(&glam::$glam::from(*self), f)
            }
        }

        impl Sum for $vector {
            fn sum<I: Iterator<Item = Self>>(vectors: I) -> Self {
                vectors.fold(Self::ZERO, Self::add)
            }
        }

        impl<R: Real> From<[R; $n]> for $vector<R> {
            #[inline(always)]
            fn from(coordinates: [R; $n]) -> Self {
                Self::from_array(coordinates)
            }
        }

        impl<R: Real> From<$vector<R>> for [R; $n] {
            #[inline(always)]
            fn from(v: $vector<R>) -> Self {
                v.to_array()
            }
        }

        impl From<glam::$glam> for $vector {
            #[inline(always)]
            fn from(v: glam::$glam) -> Self {
                Self::from_array(v.to_array())
            }
        }

        impl From<$vector> for glam::$glam {
            #[inline(always)]
            fn from(v: $vector) -> Self {
                Self::from_array(v.to_array())
            }
        }

        impl From<$vector> for $double {
            #[inline(always)]
            fn from(v: $vector) -> Self {
                Self::from_array(v.to_array().each(f64::from))
            }
        }
    };
}

/// The methods of vectors of all sizes that are made of others.
macro_rules! methods {
    ($vector:ident) => {
        impl<R: Real> $vector<R> {
            /// The Euclidean length.
            #[inline(always)]
            pub fn length(self) -> R {
                self.dot(self).sqrt()
            }

            /// The square of the length.
            #[inline(always)]
            pub fn length_squared(self) -> R {
                self.dot(self)
            }

            /// The distance to `b`.
            #[inline(always)]
            pub fn distance(self, b: Self) -> R {
                (self - b).length()
            }

            /// The square of the distance to `b`.
            #[inline(always)]
            pub fn distance_squared(self, b: Self) -> R {
                (self - b).length_squared()
            }

            /// The vector of length one with the same direction; not finite for the zero vector.
            #[inline(always)]
            pub fn normalize(self) -> Self {
                let v = self.balanced();
                v * (R::one() / v.length())
            }

            /// The vector of length one with the same direction, and where there is one: not where
            /// a coordinate is not finite, or all are zero.
            #[inline(always)]
            pub fn normalize_masked(self) -> (Self, R::Mask) {
                let v = self.balanced();
                let inverse = R::one() / v.length();
                let valid = inverse.gt(R::zero()) & inverse.lt(R::splat(f32::INFINITY));
                (v * inverse, valid)
            }

            /// The vector times a power of two that makes the magnitude of its largest coordinate
            /// one to two, so that squares and cubes of coordinates neither overflow nor vanish.
            /// Zero, infinities and NaN stay.
            #[inline(always)]
            pub fn balanced(self) -> Self {
                self * balance(self.abs().max_element())
            }

            /// The smaller of each pair of coordinates; that of `b` where either is NaN.
            #[inline(always)]
            pub fn min(self, b: Self) -> Self {
                self.zip(b, R::min)
            }

            /// The larger of each pair of coordinates; that of `b` where either is NaN.
            #[inline(always)]
            pub fn max(self, b: Self) -> Self {
                self.zip(b, R::max)
            }

            /// Each coordinate limited to the range from that of `low` to that of `high`.
            #[inline(always)]
            pub fn clamp(self, low: Self, high: Self) -> Self {
                self.max(low).min(high)
            }

            /// The magnitudes of `self` with the signs of `sign`.
            #[inline(always)]
            pub fn copysign(self, sign: Self) -> Self {
                self.zip(sign, R::copysign)
            }

            /// `self`·(1 − t) + b·t.
            #[inline(always)]
            pub fn lerp(self, b: Self, t: R) -> Self {
                self * (R::one() - t) + b * t
            }

            /// The point halfway to `b`.
            #[inline(always)]
            pub fn midpoint(self, b: Self) -> Self {
                (self + b) * R::splat(0.5)
            }

            /// The reciprocal of each coordinate.
            #[inline(always)]
            pub fn recip(self) -> Self {
                self.map(|c| R::one() / c)
            }
        }
    };
}

vector!(Vec2(x 0, y 1), 2, Vec2 DVec2 BVec2);
vector!(Vec3(x 0, y 1, z 2), 3, Vec3 DVec3 BVec3);
methods!(Vec2);
methods!(Vec3);

impl<R: Real> Vec2<R> {
    /// The scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> R {
        self.x * b.x + self.y * b.y
    }

    /// The area of the parallelogram of the two vectors, with the sign of the turn from `self` to
    /// `b`.
    #[inline(always)]
    pub fn perp_dot(self, b: Self) -> R {
        self.x * b.y - self.y * b.x
    }

    /// The vector with a third coordinate.
    #[inline(always)]
    pub fn extend(self, z: R) -> Vec3<R> {
        Vec3::new(self.x, self.y, z)
    }

    /// The product of the coordinates.
    #[inline(always)]
    pub fn element_product(self) -> R {
        self.x * self.y
    }

    /// The smaller coordinate.
    #[inline(always)]
    pub fn min_element(self) -> R {
        self.x.min(self.y)
    }

    /// The larger coordinate.
    #[inline(always)]
    pub fn max_element(self) -> R {
        self.x.max(self.y)
    }
}

impl Vec2 {
    /// The first axis.
    pub const X: Self = Self::new(1.0, 0.0);
    /// The second axis.
    pub const Y: Self = Self::new(0.0, 1.0);

    /// In double precision.
    #[inline(always)]
    pub fn as_dvec2(self) -> DVec2 {
        self.into()
    }
}

impl<R: Real> Vec3<R> {
    /// The scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> R {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// The vector product.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self {
            x: self.y * b.z - b.y * self.z,
            y: self.z * b.x - b.z * self.x,
            z: self.x * b.y - b.x * self.y,
        }
    }

    /// Where all coordinates are finite.
    #[inline(always)]
    pub fn are_finite(self) -> R::Mask {
        let largest = R::splat(f32::MAX);
        self.x.abs().le(largest) & self.y.abs().le(largest) & self.z.abs().le(largest)
    }

    /// The first two coordinates.
    #[inline(always)]
    pub fn truncate(self) -> Vec2<R> {
        Vec2::new(self.x, self.y)
    }

    /// The smallest coordinate.
    #[inline(always)]
    pub fn min_element(self) -> R {
        self.x.min(self.y.min(self.z))
    }

    /// The largest coordinate.
    #[inline(always)]
    pub fn max_element(self) -> R {
        self.x.max(self.y.max(self.z))
    }
}

impl Vec3 {
    /// The first axis.
    pub const X: Self = Self::new(1.0, 0.0, 0.0);
    /// The second axis.
    pub const Y: Self = Self::new(0.0, 1.0, 0.0);
    /// The third axis.
    pub const Z: Self = Self::new(0.0, 0.0, 1.0);

    /// The vector with a fourth coordinate.
    #[inline(always)]
    pub fn extend(self, w: f32) -> Vec4 {
        Vec4::new(self.x, self.y, self.z, w)
    }

    /// In double precision.
    #[inline(always)]
    pub fn as_dvec3(self) -> DVec3 {
        self.into()
    }

    /// A bit for each coordinate, that of x the lowest: whether its sign is negative.
    #[inline(always)]
    pub fn is_negative_bitmask(self) -> u32 {
        let bit = |c: f32| c.is_sign_negative() as u32;
        bit(self.x) | bit(self.y) << 1 | bit(self.z) << 2
    }

    /// The index of the first coordinate that is the largest.
    #[inline]
    pub fn max_position(self) -> usize {
        let second = if self.y > self.x { 1 } else { 0 };
        if self.z > self[second] { 2 } else { second }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::*;
    use testkit::{LaneFunction, lanes_agree};

    struct Vectors;

    impl LaneFunction for Vectors {
        #[inline(always)]
        fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
            let vector = |i: usize| Vec3::new(u[i], u[i + 1], u[i + 2]) - R::splat(0.5);
            let (a, b) = (vector(0), vector(3));
            let frame = Frame::from_z_and_x(a.normalize(), b);
            let p = Point3Error::new(a, b.abs() * R::splat(1e-5));
            let ray = Ray::between(p, b, Point3Error::exact(b), a, u[0]);
            let mut results: Vec<R> = [
                a + b,
                a / b,
                a.cross(b),
                cross(a, b),
                a.normalize_masked().0,
                a.lerp(b, u[0]).max(a).clamp(-a, b.abs()),
                frame.x,
                frame.y,
                frame.from_local(frame.to_local(b)),
                face_forward(a, b),
                ray.o,
                ray.d,
                ray.at(u[1]),
                spherical_direction(u[0], u[1], u[2]),
            ]
            .into_iter()
            .flat_map(Vec3::to_array)
            .collect();
            results.extend([a.dot(b), a.distance(b), a.max_element(), a.truncate().perp_dot(b.truncate())]);
            results.extend([sin_theta(a), cos_phi(a), sin_phi(a), exp(u[0]), ln(u[1])]);
            results
        }
    }

    #[test]
    fn vectors_do_not_depend_on_the_number_of_lanes() {
        lanes_agree(&Vectors, 6, 500);
    }

    #[test]
    fn formulas_are_those_of_matrices() {
        let (a, b) = (Vec3::new(0.3, -2.0, 5.5), Vec3::new(1.5, 0.1, -0.7));
        let (ga, gb) = (glam::Vec3::from(a), glam::Vec3::from(b));
        assert_eq!(a.cross(b), ga.cross(gb).into());
        assert_eq!(a.normalize(), ga.normalize().into());
        assert_eq!(a.lerp(b, 0.3), ga.lerp(gb, 0.3).into());
        assert_eq!((a.dot(b), a.distance(b)), (ga.dot(gb), ga.distance(gb)));
        assert_eq!([a, b, -a].map(Vec3::max_position), [ga, gb, -ga].map(glam::Vec3::max_position));
        assert_eq!((format!("{a}"), format!("{a:?}")), (format!("{ga}"), format!("{ga:?}")));
        assert!(Vec3::ZERO.try_normalize().is_none() && Vec3::INFINITY.try_normalize().is_none());
    }
}
