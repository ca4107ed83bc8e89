//! Interval arithmetic in doubles: ranges that contain the exact result ([Moore 1966]).
//!
//! Ends are rounded outwards. The elementary functions of the system's library are assumed to be
//! accurate to four units in the last place, as all common ones are. A function is evaluated over
//! the part of a range where it is defined; where it is defined nowhere, the result is empty.

use super::program::{Function, Number, power};
use std::f64::consts::TAU;
use std::ops::{Add, Mul, Neg, Sub};

/// The closed range from `low` to `high`. Ends may be infinite: the range is then unbounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    pub const EMPTY: Self = Self { low: f64::NAN, high: f64::NAN };
    pub const ENTIRE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    pub fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Between the two, rounded outwards.
    pub fn around(low: f64, high: f64) -> Self {
        Self { low: low.next_down(), high: high.next_up() }
    }

    pub fn is_empty(self) -> bool {
        self.low.is_nan() || self.high.is_nan()
    }

    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    pub fn midpoint(self) -> f64 {
        0.5 * self.low + 0.5 * self.high
    }

    /// Half of the width.
    pub fn radius(self) -> f64 {
        (0.5 * self.high - 0.5 * self.low).next_up()
    }

    /// The intersection; empty where the ranges are disjoint.
    pub fn intersect(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::EMPTY;
        }
        let both = Self { low: f64::max(self.low, other.low), high: f64::min(self.high, other.high) };
        if both.low <= both.high { both } else { Self::EMPTY }
    }

    /// Whether `function` is defined on the whole range.
    pub fn is_within_domain(self, function: Function) -> bool {
        match function {
            Function::Reciprocal => self.low > 0.0 || self.high < 0.0,
            Function::Sqrt => self.low >= 0.0,
            Function::Real(p) => self.low > 0.0 || (self.low >= 0.0 && p >= 0.0),
            Function::Log => self.low > 0.0,
            Function::Abs | Function::Sin | Function::Cos | Function::Exp => !self.is_empty(),
        }
    }

    /// Divided by a positive constant.
    pub fn divided(self, by: f64) -> Self {
        Self::around(self.low / by, self.high / by)
    }

    fn reciprocal(self) -> Self {
        match (self.low, self.high) {
            (low, high) if low > 0.0 || high < 0.0 => Self::around(1.0 / high, 1.0 / low),
            (0.0, 0.0) => Self::EMPTY,
            (0.0, high) => Self::new((1.0 / high).next_down(), f64::INFINITY),
            (low, 0.0) => Self::new(f64::NEG_INFINITY, (1.0 / low).next_up()),
            _ => Self::ENTIRE,
        }
    }

    /// The range of a function that rises between the ends, whose values may be wrong by four
    /// units.
    fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        let wide = |x: f64, up: bool| {
            let margin = x.abs() * (4.0 * f64::EPSILON) + f64::MIN_POSITIVE;
            if up { x + margin } else { x - margin }
        };
        let (low, high) = (f(self.low), f(self.high));
        Self {
            low: if low == f64::INFINITY { f64::MAX } else { wide(low, false) },
            high: if high == f64::NEG_INFINITY { f64::MIN } else { wide(high, true) },
        }
    }

    /// The range of a wave of period 2π that is `f`, with its crest at `crest` turns.
    fn wave(self, f: fn(f64) -> f64, crest: f64) -> Self {
        // Beyond this, rounding leaves the position of a crest unknown.
        const FAR: f64 = 1e6;
        if self.high - self.low >= TAU || self.low < -FAR || self.high > FAR {
            return Self::new(-1.0, 1.0);
        }
        let holds = |turn: f64| {
            let (low, high) = (self.low / TAU - turn - 1e-9, self.high / TAU - turn + 1e-9);
            low.ceil() <= high
        };
        let a = f(self.low);
        let b = if self.low == self.high { a } else { f(self.high) };
        let margin = 4.0 * f64::EPSILON;
        Self {
            low: if holds(crest + 0.5) { -1.0 } else { f64::max(f64::min(a, b) - margin, -1.0) },
            high: if holds(crest) { 1.0 } else { f64::min(f64::max(a, b) + margin, 1.0) },
        }
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::around(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::around(self.low - other.high, self.high - other.low)
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::EMPTY;
        }
        // An infinite end means arbitrarily large finite numbers, so that zero times it is zero.
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let (a, b) = (product(self.low, other.low), product(self.low, other.high));
        let (c, d) = (product(self.high, other.low), product(self.high, other.high));
        Self::around(f64::min(f64::min(a, b), f64::min(c, d)), f64::max(f64::max(a, b), f64::max(c, d)))
    }
}

impl Number for Interval {
    fn constant(value: f64) -> Self {
        Self { low: value, high: value }
    }

    fn scale(self, factor: f64) -> Self {
        self * Self::constant(factor)
    }

    fn offset(self, term: f64) -> Self {
        self + Self::constant(term)
    }

    fn power(self, n: u32) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        // Products of what is not negative, each rounded down or up.
        let raise = |x: f64| power(Self::constant(x.abs()), n);
        let (low, high) = (raise(self.low), raise(self.high));
        if n % 2 == 1 {
            let signed = |x: f64, raised: Self| if x < 0.0 { -raised } else { raised };
            return Self { low: signed(self.low, low).low, high: signed(self.high, high).high };
        }
        let smallest = if self.contains(0.0) { 0.0 } else { f64::max(f64::min(low.low, high.low), 0.0) };
        Self { low: smallest, high: f64::max(low.high, high.high) }
    }

    fn min(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::EMPTY;
        }
        Self { low: f64::min(self.low, other.low), high: f64::min(self.high, other.high) }
    }

    fn max(self, other: Self) -> Self {
        -Number::min(-self, -other)
    }

    fn apply(self, function: Function) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let positive = || self.intersect(Self::new(0.0, f64::INFINITY));
        match function {
            Function::Reciprocal => self.reciprocal(),
            Function::Sqrt => {
                let root = positive().rising(f64::sqrt);
                Self { low: if root.low < 0.0 { 0.0 } else { root.low }, ..root }
            }
            Function::Abs if self.low >= 0.0 => self,
            Function::Abs if self.high <= 0.0 => -self,
            Function::Abs => Self::new(0.0, f64::max(-self.low, self.high)),
            Function::Sin => self.wave(libm::sin, 0.25),
            Function::Cos => self.wave(libm::cos, 0.0),
            Function::Exp => {
                let raised = self.rising(libm::exp);
                Self { low: f64::max(raised.low, 0.0), ..raised }
            }
            Function::Log => positive().rising(libm::log),
            Function::Real(p) => {
                let base = positive();
                if base.is_empty() {
                    return Self::EMPTY;
                }
                let base = if p < 0.0 { Self { low: base.high, high: base.low } } else { base };
                let raised = base.rising(|x| libm::pow(x, p));
                Self { low: f64::max(raised.low, 0.0), ..raised }
            }
        }
    }
}
