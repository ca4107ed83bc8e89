//! Taylor models: a polynomial approximation of a formula along a piece of a ray, with a bound of
//! its error ([Makino 2003]).
//!
//! With s ∈ [−1, 1] over the piece, |F(s) − Σ cₖ sᵏ| ≤ r. Sums and products of models are those of
//! their polynomials; terms beyond the degree and rounding errors are added to r. A function g is
//! expanded about the middle of its argument, Σ aₖ·uᵏ, with the last coefficient taken over the
//! whole range of the argument, so that it includes the remainder. Each model has a range by
//! interval arithmetic too, which is the better bound where a function is about to leave its
//! domain.

use super::interval::Interval;
use super::program::{Function, Number, power};
use std::ops::{Add, Mul, Neg, Sub};

/// A polynomial of degree N − 1 with its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Model<const N: usize> {
    /// By ascending powers of s.
    pub c: [f64; N],
    /// The error bound of the polynomial; infinite where there is none.
    pub r: f64,
    /// All values; empty where the formula is defined nowhere on the piece.
    pub range: Interval,
    /// The formula may be undefined somewhere on the piece.
    pub partial: bool,
}

/// Twice the rounding error of an operation, with a margin for the rounding of the bounds.
const EPSILON: f64 = f64::EPSILON;

impl<const N: usize> Model<N> {
    /// The coordinate o + d·t over t ∈ [a, b].
    pub fn coordinate(o: f64, d: f64, [a, b]: [f64; 2]) -> Self {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let mut c = [0.0; N];
        c[0] = o + d * middle;
        c[1] = d * half;
        let r = 2.0 * EPSILON * (o.abs() + d.abs() * f64::max(a.abs(), b.abs()));
        let reach = c[1].abs() + r;
        Self { c, r, range: Interval::around(c[0] - reach, c[0] + reach), partial: false }
    }

    /// A model without a polynomial: the range alone.
    fn unknown(range: Interval, partial: bool) -> Self {
        Self { c: [0.0; N], r: f64::INFINITY, range, partial }
    }

    /// The middle of a range, and the distance of the ends from it.
    fn flat(range: Interval, partial: bool) -> Self {
        let mut c = [0.0; N];
        c[0] = range.midpoint();
        Self { c, r: range.radius() + c[0].abs() * EPSILON, range, partial }.normalised()
    }

    /// The model, or an unknown one where it overflowed.
    fn normalised(self) -> Self {
        if self.norm() + self.r < f64::INFINITY { self } else { Self::unknown(self.range, self.partial) }
    }

    /// Σ |cₖ|: the polynomial's bound.
    fn norm(&self) -> f64 {
        self.c.iter().map(|c| c.abs()).sum()
    }

    /// All values, by the polynomial and by the range.
    pub fn bound(&self) -> Interval {
        let (mut low, mut high) = (self.c[0], self.c[0]);
        for (k, &c) in self.c.iter().enumerate().skip(1) {
            // sᵏ is in [0, 1] for even k.
            let (least, most) =
                if k % 2 == 0 { (f64::min(c, 0.0), f64::max(c, 0.0)) } else { (-c.abs(), c.abs()) };
            low += least;
            high += most;
        }
        let slack = self.r + self.norm() * (N as f64 * EPSILON);
        self.range.intersect(Interval::around(low - slack, high + slack))
    }

    fn with_error(self, error: f64) -> Self {
        Self { r: self.r + error, ..self }
    }

    /// a·(this) + b ± r for constants.
    fn affine(self, a: f64, b: f64, r: f64, range: Interval) -> Self {
        Self { range, ..self.scale(a).offset(b).with_error(r) }.normalised()
    }

    /// Σ aₖ·uᵏ with u = this − middle, where `function` is defined on the whole of `x`.
    fn expanded(self, function: Function, x: Interval) -> Self {
        let middle = x.midpoint();
        let u = self.offset(-middle);
        let at_middle: [Interval; N] = taylor(function, Interval::constant(middle));
        let over_range: [Interval; N] = taylor(function, x);
        let mut sum = Self::flat(over_range[N - 1], false);
        for a in at_middle[..N - 1].iter().rev() {
            sum = (sum * u).offset(a.midpoint()).with_error(a.radius());
        }
        sum
    }
}

/// The Taylor coefficients g⁽ᵏ⁾(x)/k! over a range of x.
fn taylor<const N: usize>(function: Function, x: Interval) -> [Interval; N] {
    let mut a = [x.apply(function); N];
    // Derivatives of sine and cosine are each other's.
    let turned = match function {
        Function::Sin => x.apply(Function::Cos),
        Function::Cos => -x.apply(Function::Sin),
        _ => a[0],
    };
    for k in 1..N {
        let n = k as f64;
        let inverse = |factor: f64| a[k - 1].scale(factor) * x.apply(Function::Reciprocal);
        a[k] = match function {
            Function::Reciprocal => inverse(-1.0),
            Function::Sqrt => inverse(0.5 - n + 1.0).divided(n),
            Function::Real(p) => inverse(p - n + 1.0).divided(n),
            Function::Log if k == 1 => x.apply(Function::Reciprocal),
            Function::Log => inverse(1.0 - n).divided(n),
            Function::Exp => a[k - 1].divided(n),
            Function::Sin | Function::Cos if k == 1 => turned,
            Function::Sin | Function::Cos => (-a[k - 2]).divided(n * (n - 1.0)),
            Function::Abs => Interval::constant(0.0),
        };
    }
    a
}

impl<const N: usize> Neg for Model<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { c: self.c.map(|c| -c), range: -self.range, ..self }
    }
}

impl<const N: usize> Add for Model<N> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let mut c = self.c;
        let mut norm = 0.0;
        for (c, other) in c.iter_mut().zip(other.c) {
            *c += other;
            norm += c.abs();
        }
        let r = (self.r + other.r) * (1.0 + EPSILON) + norm * EPSILON;
        let sum = Self { c, r, range: self.range + other.range, partial: self.partial | other.partial };
        if norm + r < f64::INFINITY { sum } else { Self::unknown(sum.range, sum.partial) }
    }
}

impl<const N: usize> Sub for Model<N> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const N: usize> Mul for Model<N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (&self.c, &other.c);
        let mut c = [0.0; N];
        for i in 0..N {
            for j in 0..N - i {
                c[i + j] = a[i].mul_add(b[j], c[i + j]);
            }
        }
        // Terms beyond the degree: |aᵢ| times the last i of |b|.
        let (mut lost, mut tail) = (0.0, 0.0);
        for i in 1..N {
            tail += b[N - i].abs();
            lost += a[i].abs() * tail;
        }
        let (norm_a, norm_b) = (self.norm(), other.norm());
        let rounding = norm_a * norm_b * ((N + 3) as f64 * EPSILON);
        let r =
            (norm_a * other.r + norm_b * self.r + self.r * other.r + lost) * (1.0 + 8.0 * EPSILON) + rounding;
        let (range, partial) = (self.range * other.range, self.partial | other.partial);
        if norm_a * norm_b + r < f64::INFINITY {
            Self { c, r, range, partial }
        } else {
            Self::unknown(range, partial)
        }
    }
}

impl<const N: usize> Number for Model<N> {
    fn constant(value: f64) -> Self {
        let mut c = [0.0; N];
        c[0] = value;
        Self { c, r: 0.0, range: Interval::constant(value), partial: false }.normalised()
    }

    #[inline]
    fn scale(self, factor: f64) -> Self {
        let mut c = self.c;
        let mut norm = 0.0;
        for c in &mut c {
            *c *= factor;
            norm += c.abs();
        }
        let r = self.r * factor.abs() * (1.0 + EPSILON) + norm * EPSILON;
        let range = self.range.scale(factor);
        if norm + r < f64::INFINITY {
            Self { c, r, range, ..self }
        } else {
            Self::unknown(range, self.partial)
        }
    }

    fn offset(self, term: f64) -> Self {
        let mut c = self.c;
        c[0] += term;
        let r = self.r * (1.0 + EPSILON) + c[0].abs() * EPSILON;
        Self { c, r, range: self.range.offset(term), ..self }.normalised()
    }

    fn power(self, n: u32) -> Self {
        let product = power(self, n);
        Self { range: product.range.intersect(self.range.power(n)), ..product }
    }

    /// ½(a + b − |a − b|).
    fn min(self, other: Self) -> Self {
        let partial = self.partial | other.partial;
        let difference = (self - other).bound();
        if difference.high <= 0.0 {
            return Self { partial, ..self };
        }
        if difference.low >= 0.0 {
            return Self { partial, ..other };
        }
        let range = Number::min(self.range, other.range);
        if difference.is_empty() {
            return Self::unknown(range, partial);
        }
        let most = f64::max(-difference.low, difference.high);
        Self { partial, ..(self + other).affine(0.5, -0.25 * most, 0.25 * most, range) }
    }

    fn max(self, other: Self) -> Self {
        -Number::min(-self, -other)
    }

    fn apply(self, function: Function) -> Self {
        let x = self.bound();
        let range = x.apply(function);
        let partial = self.partial || !x.is_within_domain(function);
        if range.is_empty() {
            return Self::unknown(range, partial);
        }
        if function == Function::Abs {
            return match x {
                Interval { low, .. } if low >= 0.0 => Self { range, ..self },
                Interval { high, .. } if high <= 0.0 => Self { range, ..-self },
                // The chord over the range is above, less by at most its value at 0.
                Interval { low, high } => {
                    let chord = -low * high / (high - low);
                    let r = chord + (high - low) * (8.0 * EPSILON);
                    self.affine((high + low) / (high - low), chord, r, range)
                }
            };
        }
        let flat = Self::flat(range, partial);
        if !x.is_within_domain(function) {
            return flat;
        }
        let expanded = self.expanded(function, x);
        if expanded.r < flat.r { Self { range, partial, ..expanded } } else { flat }
    }
}
