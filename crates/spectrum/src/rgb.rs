//! Colours as three linear values: [`Xyz`] tristimulus values and [`Rgb`] values of some colour
//! space.

use std::ops::{Add, AddAssign, Div, DivAssign, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};

/// Defines a colour of three named components with arithmetic per component.
macro_rules! triple {
    ($(#[$doc:meta])* $name:ident { $a:ident $b:ident $c:ident }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        #[expect(missing_docs, reason = "the components are what the type's name says")]
        pub struct $name {
            pub $a: f32,
            pub $b: f32,
            pub $c: f32,
        }

        impl $name {
            /// All components zero.
            pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);

            /// From its components.
            #[inline]
            pub const fn new($a: f32, $b: f32, $c: f32) -> Self {
                Self { $a, $b, $c }
            }

            /// The same value for every component.
            #[inline]
            pub const fn splat(value: f32) -> Self {
                Self::new(value, value, value)
            }

            /// The components in order.
            #[inline]
            pub const fn to_array(self) -> [f32; 3] {
                [self.$a, self.$b, self.$c]
            }

            /// Applies `f` to each component.
            #[inline]
            pub fn map(self, mut f: impl FnMut(f32) -> f32) -> Self {
                Self::new(f(self.$a), f(self.$b), f(self.$c))
            }

            /// The largest component.
            #[inline]
            pub fn max_component(self) -> f32 {
                self.$a.max(self.$b).max(self.$c)
            }

            /// The smallest component.
            #[inline]
            pub fn min_component(self) -> f32 {
                self.$a.min(self.$b).min(self.$c)
            }

            /// The mean of the components.
            #[inline]
            pub fn average(self) -> f32 {
                (self.$a + self.$b + self.$c) / 3.0
            }

            /// Negative components become zero.
            #[inline]
            pub fn clamp_zero(self) -> Self {
                self.map(|v| v.max(0.0))
            }

            /// Each component between `low` and `high`.
            #[inline]
            pub fn clamp(self, low: f32, high: f32) -> Self {
                self.map(|v| v.clamp(low, high))
            }

            /// (1 − t)·`self` + t·`other`.
            #[inline]
            pub fn lerp(self, other: Self, t: f32) -> Self {
                self * (1.0 - t) + other * t
            }

            /// Whether no component is infinite or not a number.
            #[inline]
            pub fn is_finite(self) -> bool {
                self.$a.is_finite() && self.$b.is_finite() && self.$c.is_finite()
            }
        }

        impl From<[f32; 3]> for $name {
            #[inline]
            fn from([$a, $b, $c]: [f32; 3]) -> Self {
                Self::new($a, $b, $c)
            }
        }

        impl Index<usize> for $name {
            type Output = f32;

            #[inline]
            fn index(&self, i: usize) -> &f32 {
                [&self.$a, &self.$b, &self.$c][i]
            }
        }

        impl IndexMut<usize> for $name {
            #[inline]
            fn index_mut(&mut self, i: usize) -> &mut f32 {
                match i {
                    0 => &mut self.$a,
                    1 => &mut self.$b,
                    2 => &mut self.$c,
                    _ => panic!("a colour has three components, not a component {i}"),
                }
            }
        }

        impl Neg for $name {
            type Output = Self;

            #[inline]
            fn neg(self) -> Self {
                self.map(|v| -v)
            }
        }

        triple!(@operator $name { $a $b $c } Add add AddAssign add_assign +);
        triple!(@operator $name { $a $b $c } Sub sub SubAssign sub_assign -);
        triple!(@operator $name { $a $b $c } Mul mul MulAssign mul_assign *);
        triple!(@operator $name { $a $b $c } Div div DivAssign div_assign /);
        triple!(@scale $name Mul mul MulAssign mul_assign *);
        triple!(@scale $name Div div DivAssign div_assign /);

        impl Mul<$name> for f32 {
            type Output = $name;

            #[inline]
            fn mul(self, colour: $name) -> $name {
                colour * self
            }
        }
    };
    (@operator $name:ident { $a:ident $b:ident $c:ident } $trait:ident $method:ident $assign_trait:ident $assign_method:ident $op:tt) => {
        impl $trait for $name {
            type Output = Self;

            #[inline]
            fn $method(self, other: Self) -> Self {
                Self::new(self.$a $op other.$a, self.$b $op other.$b, self.$c $op other.$c)
            }
        }

        impl $assign_trait for $name {
            #[inline]
            fn $assign_method(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
    };
    (@scale $name:ident $trait:ident $method:ident $assign_trait:ident $assign_method:ident $op:tt) => {
        impl $trait<f32> for $name {
            type Output = Self;

            #[inline]
            fn $method(self, other: f32) -> Self {
                self.map(|v| v $op other)
            }
        }

        impl $assign_trait<f32> for $name {
            #[inline]
            fn $assign_method(&mut self, other: f32) {
                *self = *self $op other;
            }
        }
    };
}

triple! {
    /// Linear red, green and blue of a colour space given by the context.
    Rgb { r g b }
}

triple! {
    /// CIE 1931 tristimulus values; `y` is luminance.
    Xyz { x y z }
}

impl Xyz {
    /// The colour of chromaticity (x, y) and luminance `luminance`; zero where y = 0.
    pub fn from_xy(xy: [f32; 2], luminance: f32) -> Self {
        let [x, y] = xy;
        if y == 0.0 {
            return Self::ZERO;
        }
        Self::new(x * luminance / y, luminance, (1.0 - x - y) * luminance / y)
    }

    /// The chromaticity (x, y); not a number for black.
    pub fn xy(self) -> [f32; 2] {
        let sum = self.x + self.y + self.z;
        [self.x / sum, self.y / sum]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chromaticity_and_luminance_round_trip() {
        let colour = Xyz::new(0.3, 0.4, 0.7);
        let again = Xyz::from_xy(colour.xy(), colour.y);
        assert!((again - colour).map(f32::abs).max_component() < 1e-6);
        assert_eq!(Xyz::from_xy([0.3, 0.0], 1.0), Xyz::ZERO);
    }

    #[test]
    fn components_are_indexed_in_order() {
        let mut colour = Rgb::new(1.0, 2.0, 3.0);
        colour[1] = 5.0;
        assert_eq!([colour[0], colour[1], colour[2]], [1.0, 5.0, 3.0]);
        assert_eq!(2.0 * colour / Rgb::splat(2.0), colour);
    }
}
