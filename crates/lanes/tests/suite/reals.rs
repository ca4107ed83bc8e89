//! Every operation of numbers with lanes gives the bits of the same operation on single numbers.

use crate::numbers::{SPECIAL, available, hash, integer, number};
use alhazen_lanes::*;

/// An operation's name and what it gives for sixteen lanes.
type Results = Vec<(&'static str, [u32; MAX_LANES])>;

/// All operations on three floats and three integers per lane.
#[derive(Clone, Copy)]
struct Operations {
    reals: [[f32; MAX_LANES]; 3],
    ints: [[u32; MAX_LANES]; 3],
    shift: u32,
}

impl Operations {
    /// Those with these floats, and the integers with this number.
    fn new(reals: [[f32; MAX_LANES]; 3], round: u32) -> Self {
        let ints = [0, 1, 2].map(|i| lanes(|lane| integer(48 * round + 16 * i + lane as u32)));
        Self { reals, ints, shift: round % 32 }
    }
}

impl Kernel for Operations {
    type Output = Results;

    #[inline(always)]
    fn run<R: Real>(self) -> Results {
        let mut results = Vec::new();
        for first in (0..MAX_LANES).step_by(R::LANES) {
            let [a, b, c] = self.reals.map(|from| R::load(&from[first..]));
            let [i, j, k] = self.ints.map(|from| R::Int::load(&from[first..]));
            let mut ints = Vec::new();
            ints.extend(arithmetic(a, b, c));
            ints.extend(exact(a, b, c));
            ints.extend(integers::<R>(i, j, k, self.shift));
            ints.extend(comparisons(a, b, i, j));
            results.resize(ints.len(), ("", [0; MAX_LANES]));
            for ((name, lanes), (found, result)) in results.iter_mut().zip(ints) {
                *name = found;
                result.store(&mut lanes[first..]);
            }
        }
        results
    }
}

/// What is rounded. All NaNs become the same one.
#[inline(always)]
fn arithmetic<R: Real>(a: R, b: R, c: R) -> [(&'static str, R::Int); 13] {
    let [mut sum, mut difference, mut product, mut quotient] = [a; 4];
    sum += b;
    difference -= b;
    product *= b;
    quotient /= b;
    [
        ("a + b", a + b),
        ("a − b", a - b),
        ("a·b", a * b),
        ("a / b", a / b),
        ("a += b", sum),
        ("a −= b", difference),
        ("a *= b", product),
        ("a /= b", quotient),
        ("a·b + c", a.mul_add(b, c)),
        ("√a", a.sqrt()),
        ("floor of a", a.floor()),
        ("product and sum", a * b + c),
        ("from integers", a.to_bits().to_real()),
    ]
    .map(|(name, x)| (name, R::select(x.eq(x), x, R::splat(f32::NAN)).to_bits()))
}

/// What is not rounded: even a NaN keeps its bits.
#[inline(always)]
fn exact<R: Real>(a: R, b: R, c: R) -> [(&'static str, R::Int); 12] {
    let fits = a.abs().lt(R::splat(2_147_483_648.0));
    [
        ("−a", (-a).to_bits()),
        ("|a|", a.abs().to_bits()),
        ("min", a.min(b).to_bits()),
        ("max", a.max(b).to_bits()),
        ("clamp", a.clamp(b, c).to_bits()),
        ("copysign", a.copysign(b).to_bits()),
        ("select", R::select(a.lt(b), b, c).to_bits()),
        ("from_bits", R::from_bits(a.to_bits()).to_bits()),
        ("to_int", R::select(fits, a, R::one()).to_int()),
        ("to_array", R::load(&a.to_array()).to_bits()),
        ("from_fn", R::from_fn(|lane| b.to_array()[lane]).to_bits()),
        ("default", (R::default() + R::zero()).to_bits()),
    ]
}

#[inline(always)]
fn integers<R: Real>(i: R::Int, j: R::Int, k: R::Int, bits: u32) -> [(&'static str, R::Int); 18] {
    [
        ("i·j, low half", i.mul_wide(j).0),
        ("i·j, high half", i.mul_wide(j).1),
        ("i + j", i.wrapping_add(j)),
        ("i − j", i.wrapping_sub(j)),
        ("i·j", i.wrapping_mul(j)),
        ("i << bits", i.shl(bits)),
        ("i >> bits", i.shr(bits)),
        ("i << 5", i.shl(5)),
        ("i >> 5", i.shr(5)),
        ("i & j", i & j),
        ("i | j", i | j),
        ("i ^ j", i ^ j),
        ("!i", !i),
        ("select", R::Int::select(i.lt(j), j, k)),
        ("as floats", i.to_real().to_bits()),
        ("to_array", R::Int::load(&i.to_array())),
        ("from_fn", R::Int::from_fn(|lane| j.to_array()[lane])),
        ("default", R::Int::default()),
    ]
}

/// Masks as the integers 1 and 0.
#[inline(always)]
fn comparisons<R: Real>(a: R, b: R, i: R::Int, j: R::Int) -> [(&'static str, R::Int); 14] {
    let (less, greater) = (a.le(b), a.ge(b));
    [
        ("a < b", a.lt(b)),
        ("a ≤ b", a.le(b)),
        ("a > b", a.gt(b)),
        ("a ≥ b", a.ge(b)),
        ("a = b", a.eq(b)),
        ("a ≠ b", a.ne(b)),
        ("i < j", i.lt(j)),
        ("i = j", i.eq(j)),
        ("i = i", i.eq(i)),
        ("≤ & ≥", less & greater),
        ("≤ | ≥", less | greater),
        ("≤ ^ ≥", less ^ greater),
        ("!≤", !less),
        ("true", R::Mask::splat(true)),
    ]
    .map(|(name, mask)| (name, R::Int::select(mask, R::Int::splat(1), R::Int::splat(0))))
}

fn lanes<T>(lane: impl FnMut(usize) -> T) -> [T; MAX_LANES] {
    std::array::from_fn(lane)
}

fn check(operations: Operations) {
    let expected = InstructionSet::Scalar.dispatch(operations);
    for set in available() {
        for ((name, found), (_, expected)) in set.dispatch(operations).into_iter().zip(&expected) {
            if let Some(lane) = (0..MAX_LANES).find(|&lane| found[lane] != expected[lane]) {
                let reals = operations.reals.map(|numbers| numbers[lane]);
                let ints = operations.ints.map(|numbers| numbers[lane]);
                let [found, expected] = [found, *expected].map(|bits| bits[lane]);
                panic!("{set:?}: {name} of {reals:?} and {ints:x?} is {found:x}, not {expected:x}");
            }
        }
    }
}

#[test]
fn special_numbers_give_the_bits_of_single_numbers() {
    let triples = SPECIAL.len().pow(3);
    for round in 0..triples / MAX_LANES {
        let digit = |place| lanes(|lane| SPECIAL[(16 * round + lane) / place % SPECIAL.len()]);
        let reals = [1, SPECIAL.len(), SPECIAL.len() * SPECIAL.len()].map(digit);
        check(Operations::new(reals, round as u32));
    }
}

#[test]
fn random_numbers_give_the_bits_of_single_numbers() {
    for round in 0..20_000 {
        let reals = [0, 1, 2].map(|i| lanes(|lane| number(48 * round + 16 * i + lane as u32)));
        check(Operations::new(reals, round));
    }
}

#[test]
fn numbers_are_rounded_to_integers_as_single_numbers_are() {
    for bits in (0..1 << 22).map(|i| 1024 * i + hash(i) % 1024).step_by(MAX_LANES) {
        let numbers = lanes(|lane| f32::from_bits(bits.wrapping_add(64 * lane as u32)));
        let floors = lanes(|lane| numbers[lane].floor().to_bits());
        for set in available() {
            let found = set.dispatch(Floor(numbers)).map(f32::to_bits);
            let is_same = (0..MAX_LANES).all(|i| found[i] == floors[i] || numbers[i].is_nan());
            assert!(is_same, "{set:?}: {numbers:?}");
        }
    }
}

struct Floor([f32; MAX_LANES]);

impl Kernel for Floor {
    type Output = [f32; MAX_LANES];

    #[inline(always)]
    fn run<R: Real>(mut self) -> Self::Output {
        for numbers in self.0.chunks_mut(R::LANES) {
            R::load(numbers).floor().store(numbers);
        }
        self.0
    }
}

/// The contract in numbers, by the implementation that is the reference for the others.
#[test]
fn single_numbers_do_what_is_documented() {
    let is = |found: f32, expected: f32| assert_eq!(found.to_bits(), expected.to_bits(), "{found}");
    is(Real::floor(-0.0_f32), -0.0);
    is(Real::floor(-0.5_f32), -1.0);
    is(Real::floor(0.5_f32), 0.0);
    is(Real::floor(f32::NEG_INFINITY), f32::NEG_INFINITY);
    is(Real::min(0.0_f32, -0.0), -0.0);
    is(Real::min(-0.0_f32, 0.0), 0.0);
    is(Real::max(-0.0_f32, 0.0), 0.0);
    is(Real::max(0.0_f32, -0.0), -0.0);
    is(Real::min(f32::NAN, 1.0), 1.0);
    is(Real::max(1.0, f32::NAN), f32::NAN);
    is(Real::clamp(f32::NAN, 1.0, 2.0), 1.0);
    is(Real::clamp(3.0_f32, 1.0, 2.0), 2.0);
    is(Real::sqrt(-0.0_f32), -0.0);
    is(Real::copysign(1.0_f32, -0.0), -1.0);
    is(Real::copysign(-1.0_f32, f32::NAN), 1.0);
    assert!(Real::sqrt(-1.0_f32).is_nan());
    assert_eq!(Real::to_int(-1.9_f32), -1_i32 as u32);
    is(u32::MAX.to_real(), -1.0);
    is(0x7fff_ffbf_u32.to_real(), 2_147_483_500.0);
    assert!(Int::lt(1, u32::MAX));
    assert!(Real::ne(f32::NAN, f32::NAN) && !Real::ge(f32::NAN, 0.0));
}
