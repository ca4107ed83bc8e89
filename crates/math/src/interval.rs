//! Interval arithmetic: ranges of floats that contain the exact result of a computation.
//!
//! Every operation rounds its lower end down and its upper end up, so that `exact ∈ [low, high]`
//! holds after any chain of operations ([Moore 1966]; [Pharr 2023 §6.8.1]).

use std::ops::{Add, Div, Mul, Neg, Sub};

/// The closed range `[low, high]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f32,
    /// Upper end.
    pub high: f32,
}

impl Interval {
    /// The range from `low` to `high`.
    #[inline]
    pub fn new(low: f32, high: f32) -> Self {
        Self { low, high }
    }

    /// The point in the middle.
    #[inline]
    pub fn midpoint(self) -> f32 {
        0.5 * (self.low + self.high)
    }

    /// The distance from one end to the other.
    #[inline]
    pub fn width(self) -> f32 {
        self.high - self.low
    }

    /// Whether `value` lies in the range, ends included.
    #[inline]
    pub fn contains(self, value: f32) -> bool {
        self.low <= value && value <= self.high
    }

    /// The square; tighter than `self * self` where the range contains zero.
    #[inline]
    pub fn sqr(self) -> Self {
        let (a, b) = (self.low.abs(), self.high.abs());
        let (small, large) = (a.min(b), a.max(b));
        let low = if self.contains(0.0) { 0.0 } else { (small * small).next_down() };
        Self::new(low, (large * large).next_up())
    }

    /// The square root; parts below zero, which are due to rounding, count as zero.
    #[inline]
    pub fn sqrt(self) -> Self {
        Self::new(self.low.max(0.0).sqrt().next_down().max(0.0), self.high.max(0.0).sqrt().next_up())
    }
}

impl From<f32> for Interval {
    #[inline]
    fn from(value: f32) -> Self {
        Self::new(value, value)
    }
}

impl Neg for Interval {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.high, -self.low)
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new((self.low + other.low).next_down(), (self.high + other.high).next_up())
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let products =
            [self.low * other.low, self.high * other.low, self.low * other.high, self.high * other.high];
        let low = products.iter().fold(f32::INFINITY, |a, &b| a.min(b));
        let high = products.iter().fold(f32::NEG_INFINITY, |a, &b| a.max(b));
        Self::new(low.next_down(), high.next_up())
    }
}

impl Div for Interval {
    type Output = Self;
    /// A divisor that contains zero gives the whole line.
    #[inline]
    fn div(self, other: Self) -> Self {
        if other.contains(0.0) {
            return Self::new(f32::NEG_INFINITY, f32::INFINITY);
        }
        let quotients =
            [self.low / other.low, self.high / other.low, self.low / other.high, self.high / other.high];
        let low = quotients.iter().fold(f32::INFINITY, |a, &b| a.min(b));
        let high = quotients.iter().fold(f32::NEG_INFINITY, |a, &b| a.max(b));
        Self::new(low.next_down(), high.next_up())
    }
}

macro_rules! with_scalar {
    ($($op:ident :: $method:ident),*) => { $(
        impl $op<f32> for Interval {
            type Output = Self;
            #[inline]
            fn $method(self, other: f32) -> Self {
                $op::$method(self, Self::from(other))
            }
        }
        impl $op<Interval> for f32 {
            type Output = Interval;
            #[inline]
            fn $method(self, other: Interval) -> Interval {
                $op::$method(Interval::from(self), other)
            }
        }
    )* };
}
with_scalar!(Add::add, Sub::sub, Mul::mul, Div::div);

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn range() -> impl Strategy<Value = (Interval, f64)> {
        (-1e4f32..1e4, 0f32..1e2, 0f64..1.0).prop_map(|(v, e, t)| {
            let i = Interval::new((v - e).next_down(), (v + e).next_up());
            (i, i.low as f64 + t * (i.high as f64 - i.low as f64))
        })
    }

    fn holds(i: Interval, exact: f64) -> bool {
        i.low as f64 <= exact && exact <= i.high as f64
    }

    proptest! {
        #[test]
        fn exact_results_stay_inside((a, x) in range(), (b, y) in range()) {
            prop_assert!(holds(a + b, x + y));
            prop_assert!(holds(a - b, x - y));
            prop_assert!(holds(a * b, x * y));
            prop_assert!(holds(a / b, x / y));
            prop_assert!(holds(a.sqr(), x * x));
            prop_assert!(holds(a.sqr().sqrt(), x.abs()));
        }
    }
}
