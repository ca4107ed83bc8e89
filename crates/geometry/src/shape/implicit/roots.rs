//! The roots of a formula along a ray, in order, with none missed.
//!
//! A piece of the ray is described by a [`Model`], whose polynomial P is converted to Bernstein
//! form: it lies in the convex hull of its control points (k/n, bₖ). Where |P| > r there is no
//! root. A line from an end's control point below all others (above, where P is negative) bounds
//! the parameter from which on P may come within r of zero; the part before it is clipped, which
//! converges quadratically at a simple root ([Sederberg 1990]). A piece that hardly shrinks is
//! bisected. Where r is no longer small relative to P, the formula is evaluated again on the piece.
//!
//! A piece is a root once it is as short as rounding allows, or so short that a double root cannot
//! be distinguished from a near miss. No root is missed; a near miss within rounding counts as a
//! root. Pieces on which the formula is unbounded (poles) never become roots. The work for a ray is
//! bounded: beyond that, pieces that could not be excluded count as roots.
//!
//! This length is relative to the coordinates on the ray; on a ray through a huge box, to those on
//! the piece, so that a small surface in it is resolved as in a box of its own size.

use super::model::Model;
use super::program::Program;
use math::DVec3;

/// A root of a formula along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Root {
    pub t: f64,
    /// A bound of the error of `t`.
    pub error: f64,
}

/// The most pieces that a ray is cut into.
const MAX_PIECES: u32 = 4096;
/// The length of a root's piece, relative to the largest coordinate.
const RESOLUTION: f64 = 1.0 / (1u64 << 36) as f64;
/// The same for double roots.
const TOUCH: f64 = 1.0 / (1u64 << 27) as f64;
/// The formula is evaluated again once the error is this fraction of the polynomial.
const WORN: f64 = 1.0 / 16.0;
/// The ratio of the numbers on a ray to those on a piece above which the box counts as huge.
const HUGE: f64 = 1024.0;

/// An iterator over the roots of a formula along a ray.
pub(super) struct Roots<'a, const N: usize> {
    program: &'a Program,
    o: DVec3,
    d: DVec3,
    /// The largest coordinate and the largest |t| on the whole ray.
    largest: [f64; 2],
    /// Pieces that are left, the first one last.
    pieces: Vec<Piece<N>>,
    /// How many pieces may still be examined.
    budget: u32,
    /// The end of the last root's piece.
    end: f64,
    values: Vec<Model<N>>,
}

/// A piece of the ray, with its control points and their error where these are known.
#[derive(Clone, Copy)]
struct Piece<const N: usize> {
    t: [f64; 2],
    control: Option<([f64; N], f64)>,
}

impl<'a, const N: usize> Roots<'a, N> {
    /// Along o + d·t for `t` from one end to the other.
    pub fn new(program: &'a Program, o: DVec3, d: DVec3, t: [f64; 2]) -> Self {
        Self {
            program,
            o,
            d,
            largest: [largest_coordinate(o, d, t), f64::max(t[0].abs(), t[1].abs())],
            pieces: vec![Piece { t, control: None }],
            budget: MAX_PIECES,
            end: f64::NEG_INFINITY,
            values: Vec::new(),
        }
    }

    /// The magnitude of coordinates on a piece, in lengths of the direction; not less than rounding
    /// allows to distinguish.
    fn scale(&self, t: [f64; 2]) -> f64 {
        let d = self.d.abs().max_element();
        let rounding = self.o.abs().max_element() + d * f64::max(t[0].abs(), t[1].abs());
        let local = f64::max(largest_coordinate(self.o, self.d, t), rounding / HUGE);
        magnitude(self.largest[0], local) / d
    }

    /// A bound of the rounding error of the ends of parts of a piece.
    fn slack(&self, t: [f64; 2]) -> f64 {
        magnitude(self.largest[1], f64::max(t[0].abs(), t[1].abs())) * (16.0 * f64::EPSILON)
    }

    /// Control points of the formula on a piece; `None` where it has no root there.
    fn evaluate(&mut self, t: [f64; 2]) -> Option<([f64; N], f64)> {
        let axis = |i: usize| Model::coordinate(self.o[i], self.d[i], t);
        let model = self.program.evaluate([axis(0), axis(1), axis(2)], &mut self.values);
        if !model.range.contains(0.0) {
            return None;
        }
        // On a piece as short as a point, the formula is either defined or not.
        if model.partial && t[1] - t[0] <= self.scale(t) * RESOLUTION && !self.is_defined(0.5 * (t[0] + t[1]))
        {
            return None;
        }
        Some(bernstein(&model))
    }

    fn is_defined(&self, t: f64) -> bool {
        let p = self.o + self.d * t;
        self.program.evaluate(p.to_array(), &mut Vec::new()).is_finite()
    }

    fn found(&mut self, [a, b]: [f64; 2]) -> Option<Root> {
        let continues = a <= self.end;
        self.end = b;
        (!continues).then_some(Root { t: 0.5 * (a + b), error: 0.5 * (b - a) })
    }
}

impl<const N: usize> Iterator for Roots<'_, N> {
    type Item = Root;

    fn next(&mut self) -> Option<Root> {
        while let Some(Piece { t, control }) = self.pieces.pop() {
            let width = t[1] - t[0];
            let is_fresh = control.is_none();
            let Some((b, r)) = control.or_else(|| self.evaluate(t)) else { continue };
            self.budget = self.budget.saturating_sub(1);
            let size = largest(&b);
            let touches = is_fresh && r.is_finite() && size <= 2.0 * r;
            let scale = self.scale(t);
            if width <= scale * RESOLUTION || (touches && width <= scale * TOUCH) || self.budget == 0 {
                match r.is_finite().then(|| self.found(t)).flatten() {
                    Some(root) => return Some(root),
                    None => continue,
                }
            }
            let Some([low, high]) = clip(&b, r) else { continue };
            let (at, slack) = (|u: f64| t[0] + width * u, self.slack(t));
            let part = |[low, high]: [f64; 2]| {
                let (control, r) = restricted(&b, r, [low, high]);
                if r < largest(&control) * WORN {
                    Piece { t: [at(low), at(high)], control: Some((control, r)) }
                } else {
                    Piece { t: [at(low) - slack, at(high) + slack], control: None }
                }
            };
            if high - low <= 0.7 {
                self.pieces.push(part([low, high]));
            } else {
                let middle = 0.5 * (low + high);
                self.pieces.push(part([middle, high]));
                self.pieces.push(part([low, middle]));
            }
        }
        None
    }
}

/// The largest coordinate on a piece of a ray.
fn largest_coordinate(o: DVec3, d: DVec3, t: [f64; 2]) -> f64 {
    f64::max((o + d * t[0]).abs().max_element(), (o + d * t[1]).abs().max_element())
}

/// The magnitude of numbers on a piece: that of the whole ray, unless this is huge beside it.
fn magnitude(whole: f64, piece: f64) -> f64 {
    if piece * HUGE < whole { piece } else { whole }
}

/// For polynomials of degree N − 1: the control points bⱼ of sᵏ, by row j and column k. The blossom
/// of sᵏ at −1 (n − j times) and 1 (j times).
const fn basis<const N: usize>() -> [[f64; N]; N] {
    let mut rows = [[0.0; N]; N];
    let mut j = 0;
    while j < N {
        // (1 − x)^(n−j)·(1 + x)^j: its coefficients are the elementary symmetric sums.
        let mut sums = [0.0; N];
        sums[0] = 1.0;
        let mut i = 0;
        while i < N - 1 {
            let sign = if i < N - 1 - j { -1.0 } else { 1.0 };
            let mut k = N - 1;
            while k > 0 {
                sums[k] += sign * sums[k - 1];
                k -= 1;
            }
            i += 1;
        }
        let mut binomial = 1.0;
        let mut k = 0;
        while k < N {
            rows[j][k] = sums[k] / binomial;
            binomial = binomial * (N - 1 - k) as f64 / (k + 1) as f64;
            k += 1;
        }
        j += 1;
    }
    rows
}

struct Basis<const N: usize>;

impl<const N: usize> Basis<N> {
    const ROWS: [[f64; N]; N] = basis();
}

/// The model's polynomial by control points, and their error.
fn bernstein<const N: usize>(model: &Model<N>) -> ([f64; N], f64) {
    let mut norm = 0.0;
    for c in model.c {
        norm += c.abs();
    }
    let control = Basis::<N>::ROWS.map(|row| {
        let mut sum = 0.0;
        for (basis, c) in row.iter().zip(model.c) {
            sum += basis * c;
        }
        sum
    });
    (control, model.r + norm * ((N + 2) as f64 * f64::EPSILON))
}

fn largest<const N: usize>(b: &[f64; N]) -> f64 {
    b.iter().fold(0.0, |largest, b| f64::max(largest, b.abs()))
}

/// The part of [0, 1] outside of which the polynomial is further than `r` from zero; `None` where
/// it is on all of [0, 1].
fn clip<const N: usize>(b: &[f64; N], r: f64) -> Option<[f64; 2]> {
    let reach = |from: usize, other: fn(usize) -> usize| {
        let first = b[from];
        let height = first.abs() - r;
        if height.is_nan() || height <= 0.0 {
            return Some(0.0);
        }
        // The steepest descent towards zero.
        let sign = first.signum();
        let mut steepest = 0.0;
        for j in 1..N {
            let drop = (first - b[other(j)]) * sign * ((N - 1) as f64 / j as f64);
            steepest = f64::max(steepest, drop);
        }
        // Rounded down, so that no root is clipped.
        let reach = height / steepest * (1.0 - 16.0 * f64::EPSILON);
        (reach <= 1.0).then_some(reach)
    };
    let low = reach(0, |j| j)?;
    let high = 1.0 - reach(N - 1, |j| N - 1 - j)?;
    (low <= high).then_some([low, high])
}

/// The control points on a part of [0, 1], by de Casteljau's construction.
fn restricted<const N: usize>(b: &[f64; N], r: f64, [low, high]: [f64; 2]) -> ([f64; N], f64) {
    let mut b = *b;
    let size = largest(&b);
    if high < 1.0 {
        for i in 1..N {
            for k in (i..N).rev() {
                b[k] = b[k - 1] + (b[k] - b[k - 1]) * high;
            }
        }
    }
    if low > 0.0 {
        let u = low / high;
        for i in 1..N {
            for k in 0..N - i {
                b[k] += (b[k + 1] - b[k]) * u;
            }
        }
    }
    (b, r + size * (8 * N) as f64 * f64::EPSILON)
}
