//! Elementary functions: their errors, their special values, and the same bits on every set.

use crate::numbers::{SPECIAL, available, hash, number};
use alhazen_lanes::*;

/// A function of one or two numbers; those of one number ignore the second.
#[derive(Clone, Copy, Debug)]
enum Function {
    Sin,
    Cos,
    Asin,
    Acos,
    Atan,
    Atan2,
    Exp,
    ExpM1,
    Ln,
    Log2,
    Ln1p,
    Pow,
    Cube,
    Reciprocal,
    Cbrt,
    Hypot,
    CoarseInverseSqrt,
}

use Function::*;

/// Functions of one number with the bounds of their errors, in ulp.
const OF_ONE: [(Function, f64); 13] = [
    (Sin, 1.6),
    (Cos, 1.6),
    (Asin, 1.4),
    (Acos, 1.2),
    (Atan, 1.6),
    (Exp, 1.1),
    (ExpM1, 1.7),
    (Ln, 0.9),
    (Log2, 2.0),
    (Ln1p, 1.0),
    (Cbrt, 0.6),
    (Cube, 3.0),
    (Reciprocal, 1.0),
];

const OF_TWO: [(Function, f64); 3] = [(Atan2, 2.0), (Pow, 2.0), (Hypot, 1.5)];

impl Function {
    #[inline(always)]
    fn apply<R: Real>(self, x: R, y: R) -> R {
        match self {
            Sin => sin(x),
            Cos => cos(x),
            Asin => asin(x),
            Acos => acos(x),
            Atan => atan(x),
            Atan2 => atan2(x, y),
            Exp => exp(x),
            ExpM1 => exp_m1(x),
            Ln => ln(x),
            Log2 => log2(x),
            Ln1p => ln_1p(x),
            Pow => pow(x, y),
            Cube => powi(x, 3),
            Reciprocal => powi(x, -1),
            Cbrt => cbrt(x),
            Hypot => hypot(x, y),
            CoarseInverseSqrt => coarse_inverse_sqrt(x),
        }
    }

    /// In double precision.
    fn exact(self, x: f32, y: f32) -> f64 {
        let (x, y) = (f64::from(x), f64::from(y));
        match self {
            Sin => x.sin(),
            Cos => x.cos(),
            Asin => x.asin(),
            Acos => x.acos(),
            Atan => x.atan(),
            Atan2 => x.atan2(y),
            Exp => x.exp(),
            ExpM1 => x.exp_m1(),
            Ln => x.ln(),
            Log2 => x.log2(),
            Ln1p => x.ln_1p(),
            Pow => x.powf(y),
            Cube => x * x * x,
            Reciprocal => 1.0 / x,
            Cbrt => x.cbrt(),
            Hypot => x.hypot(y),
            CoarseInverseSqrt => x.sqrt().recip(),
        }
    }

    /// In single precision, with the special values of `std`.
    fn special(self, x: f32, y: f32) -> f32 {
        match self {
            Sin => x.sin(),
            Cos => x.cos(),
            Asin => x.asin(),
            Acos => x.acos(),
            Atan => x.atan(),
            Atan2 => x.atan2(y),
            Exp => x.exp(),
            ExpM1 => x.exp_m1(),
            Ln => x.ln(),
            Log2 => x.log2(),
            Ln1p => x.ln_1p(),
            Pow => x.powf(y),
            Cube => x.powi(3),
            Reciprocal => x.powi(-1),
            Cbrt => x.cbrt(),
            Hypot => x.hypot(y),
            CoarseInverseSqrt => x.sqrt().recip(),
        }
    }
}

const BLOCK: usize = 1024;

/// A function of many numbers.
struct Apply<'a>(Function, &'a [f32; BLOCK], &'a [f32; BLOCK]);

impl Kernel for Apply<'_> {
    type Output = [f32; BLOCK];

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let mut results = [0.0; BLOCK];
        // Above the loop, so that it has no branches.
        macro_rules! apply {
            ($($function:ident)*) => {
                match self.0 {
                    $($function => {
                        for first in (0..BLOCK).step_by(R::LANES) {
                            let [x, y] = [self.1, self.2].map(|from| R::load(&from[first..]));
                            $function.apply(x, y).store(&mut results[first..]);
                        }
                    })*
                }
            };
        }
        apply! {
            Sin Cos Asin Acos Atan Atan2 Exp ExpM1 Ln Log2 Ln1p Pow Cube Reciprocal Cbrt Hypot
            CoarseInverseSqrt
        }
        results
    }
}

/// The error of a result in units in the last place of the exact one.
fn error(found: f32, exact: f64) -> f64 {
    let rounded = exact as f32;
    if found.is_nan() || exact.is_nan() {
        return if found.is_nan() && exact.is_nan() { 0.0 } else { f64::INFINITY };
    }
    if found == rounded {
        return 0.5_f64.min(ulps(f64::from(found) - exact, exact));
    }
    // An infinite result is the power of two that follows the largest number.
    let finite = |x: f64| x.clamp(-2_f64.powi(128), 2_f64.powi(128));
    ulps(finite(f64::from(found)) - finite(exact), exact)
}

fn ulps(difference: f64, exact: f64) -> f64 {
    let exponent = (exact.abs().to_bits() >> 52) as i32 - 1023;
    difference.abs() * 2_f64.powi(23 - exponent.clamp(-126, 127))
}

/// The largest error of a function over blocks of numbers.
fn check(function: Function, bound: f64, blocks: impl Iterator<Item = ([f32; BLOCK], [f32; BLOCK])>) {
    let set = InstructionSet::detect();
    let mut worst = (0.0, 0.0, 0.0);
    for (xs, ys) in blocks {
        for ((found, x), y) in set.dispatch(Apply(function, &xs, &ys)).into_iter().zip(xs).zip(ys) {
            let error = error(found, function.exact(x, y));
            if error > worst.0 {
                worst = (error, x, y);
            }
        }
    }
    assert!(worst.0 < bound, "{function:?}: {} ulp at {:e} {:e}", worst.0, worst.1, worst.2);
}

/// All floats, or every few.
fn every(step: u32) -> impl Iterator<Item = ([f32; BLOCK], [f32; BLOCK])> {
    (0..=u32::MAX / step / BLOCK as u32).map(move |block| {
        let bits = |i| (block * BLOCK as u32 + i as u32).saturating_mul(step);
        (std::array::from_fn(|i| f32::from_bits(bits(i))), [0.0; BLOCK])
    })
}

#[test]
fn functions_of_one_number_are_within_their_bounds() {
    for (function, bound) in OF_ONE {
        check(function, bound, every(997));
    }
}

#[test]
fn coarse_inverse_roots_are_within_their_bound() {
    // 5·10⁻⁶ in units of at least 2⁻²⁴.
    let bound = 5e-6 * 2_f64.powi(24);
    let is_positive = |&x: &f32| x > 0.0 && x.is_normal();
    let positive = |xs: [f32; BLOCK]| xs.map(|x| Some(x).filter(is_positive).unwrap_or(1.0));
    check(CoarseInverseSqrt, bound, every(997).map(|(xs, ys)| (positive(xs), ys)));
}

#[test]
#[ignore = "takes minutes: every float"]
fn functions_of_every_number_are_within_their_bounds() {
    for (function, bound) in OF_ONE {
        check(function, bound, every(1));
    }
}

#[test]
fn functions_of_two_numbers_are_within_their_bounds() {
    for (function, bound) in OF_TWO {
        let blocks = |numbers: fn(u32) -> [f32; 2]| {
            (0..1000).map(move |block| {
                let pairs: [_; BLOCK] = std::array::from_fn(|i| numbers(block * BLOCK as u32 + i as u32));
                (pairs.map(|pair| pair[0]), pairs.map(|pair| pair[1]))
            })
        };
        let any = |i| [f32::from_bits(hash(2 * i)), f32::from_bits(hash(2 * i + 1))];
        let common = |i| [hash(2 * i) as f32 * 1e-9, (hash(2 * i + 1) as i32) as f32 * 1e-8];
        let near_one = |i| {
            let x = 0.5 + hash(2 * i) as f32 * 2f32.powi(-32);
            [x, (hash(2 * i + 1) as f32 * 2f32.powi(-25) - 64.0) / (x - 0.99).abs()]
        };
        check(function, bound, blocks(any).chain(blocks(common)).chain(blocks(near_one)));
    }
}

#[test]
fn special_values_are_those_of_std() {
    for (function, _) in OF_ONE.into_iter().chain(OF_TWO) {
        for &x in &SPECIAL {
            let (xs, ys) = ([x; BLOCK], std::array::from_fn(|i| SPECIAL[i % SPECIAL.len()]));
            let found = InstructionSet::Scalar.dispatch(Apply(function, &xs, &ys));
            for (found, y) in found.into_iter().zip(ys).take(SPECIAL.len()) {
                // Signalling NaNs are as good as quiet ones.
                let [x, y] = [x, y].map(|x| if x.is_nan() { f32::NAN } else { x });
                let expected = function.special(x, y);
                let is_special = !expected.is_normal() && expected.abs() < 1e-44 || !expected.is_finite();
                let is_same = match is_special {
                    true => found == expected && found.is_sign_negative() == expected.is_sign_negative(),
                    false => (found - expected).abs() <= 4e-7 * expected.abs() + 1e-44,
                };
                let is_same = is_same || found.is_nan() && expected.is_nan();
                assert!(is_same, "{function:?} of {x} and {y}: {found}, not {expected}");
            }
        }
    }
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    for round in 0..200 {
        let [xs, ys] =
            [0, 1].map(|odd| std::array::from_fn(|i| number(2 * (BLOCK as u32 * round + i as u32) + odd)));
        let moderate = xs.map(|x: f32| f32::from_bits(x.to_bits() & 0xc3ff_ffff));
        for xs in [&xs, &moderate] {
            for (function, _) in OF_ONE.into_iter().chain(OF_TWO).chain([(CoarseInverseSqrt, 0.0)]) {
                let expected = InstructionSet::Scalar.dispatch(Apply(function, xs, &ys));
                for set in available() {
                    let found = set.dispatch(Apply(function, xs, &ys));
                    for (i, (a, b)) in found.into_iter().zip(expected).enumerate() {
                        let is_same = a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
                        assert!(is_same, "{set:?}: {function:?} of {} {}: {a}, not {b}", xs[i], ys[i]);
                    }
                }
            }
        }
    }
}

#[test]
fn both_sine_and_cosine_are_those_alone() {
    for x in (0..10_000).map(number) {
        assert_eq!(sin_cos(x).0.to_bits(), sin(x).to_bits());
        assert_eq!(sin_cos(x).1.to_bits(), cos(x).to_bits());
    }
}
