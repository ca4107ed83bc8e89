//! Every operation gives the bits of the same operation on single floats, on every instruction set
//! that this processor has.

use crate::numbers::{available, hash, number};
use alhazen_lanes::*;

/// All operations on three vectors: results, then bits of comparisons.
fn results<const N: usize, V: Vector<N>>(a: V, b: V, c: V) -> (Vec<[f32; N]>, [u32; 2]) {
    let vectors = [
        a.add(b),
        a.sub(b),
        a.mul(b),
        a.div(b),
        a.abs(),
        a.min(b),
        a.max(b),
        a.min_int(b),
        a.max_int(b),
        a.min_uint(b),
        a.max_uint(b),
        a.mul_add(b, c),
        a.neg_mul_add(b, c),
        a.mul_sub(b, c),
    ];
    (vectors.map(V::store).to_vec(), [a.le(b), a.lt(b)])
}

fn expected<const N: usize>([a, b, c]: [[f32; N]; 3]) -> (Vec<[f32; N]>, [u32; 2]) {
    let each = |f: fn(f32, f32, f32) -> f32| std::array::from_fn(|i| f(a[i], b[i], c[i]));
    let bits = |f: fn(&f32, &f32) -> bool| (0..N).map(|i| (f(&a[i], &b[i]) as u32) << i).sum();
    let vectors = [
        each(|a, b, _| a + b),
        each(|a, b, _| a - b),
        each(|a, b, _| a * b),
        each(|a, b, _| a / b),
        each(|a, _, _| a.abs()),
        each(|a, b, _| if a < b { a } else { b }),
        each(|a, b, _| if a > b { a } else { b }),
        each(|a, b, _| f32::from_bits((a.to_bits() as i32).min(b.to_bits() as i32) as u32)),
        each(|a, b, _| f32::from_bits((a.to_bits() as i32).max(b.to_bits() as i32) as u32)),
        each(|a, b, _| f32::from_bits(a.to_bits().min(b.to_bits()))),
        each(|a, b, _| f32::from_bits(a.to_bits().max(b.to_bits()))),
        each(|a, b, c| a.mul_add(b, c)),
        each(|a, b, c| (-a).mul_add(b, c)),
        each(|a, b, c| a.mul_add(b, -c)),
    ];
    (vectors.to_vec(), [bits(|a, b| a <= b), bits(|a, b| a < b)])
}

/// Compares all operations on vectors of `N` floats; the bound of the unfused product separately.
unsafe fn check<const N: usize, V: Vector<N>>(numbers: &[f32; 48], set: &str) {
    let lanes = |from: usize| -> [f32; N] { std::array::from_fn(|i| numbers[from + i]) };
    let arrays = [lanes(0), lanes(16), lanes(32)];
    // SAFETY: the caller promises the instruction set.
    let [a, b, c] = arrays.map(|array| unsafe { V::load(&array) });
    let (vectors, bits) = results(a, b, c);
    let (expected, expected_bits) = expected(arrays);
    assert_eq!(bits, expected_bits, "{set}: comparisons of {arrays:?}");
    for (operation, (found, expected)) in vectors.into_iter().zip(expected).enumerate() {
        for (lane, (x, y)) in found.into_iter().zip(expected).enumerate() {
            let is_same = x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan();
            assert!(is_same, "{set}: operation {operation}, lane {lane} of {arrays:?}: {x}, not {y}");
        }
    }
    let relaxed = a.relaxed_mul_sub(b, c).store();
    for (lane, x) in relaxed.into_iter().enumerate() {
        let [a, b, c] = arrays.map(|array| array[lane]);
        let either = [a.mul_add(b, -c), a * b - c];
        assert!(x.is_nan() || either.contains(&x), "{set}: {a}·{b} − {c} is not {x}");
    }
    let each_lane: [f32; N] = std::array::from_fn(|lane| a.lane(lane));
    assert_eq!(each_lane.map(f32::to_bits), arrays[0].map(f32::to_bits), "{set}");
    // SAFETY: the caller promises the instruction set.
    assert_eq!(unsafe { V::splat(numbers[0]) }.store().map(f32::to_bits), [numbers[0].to_bits(); N]);
}

struct Check<'a>(&'a [f32; 48], &'a str);

impl Task for Check<'_> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        // SAFETY: the caller promises the instruction set.
        unsafe {
            check::<4, S::F32x4>(self.0, self.1);
            check::<8, S::F32x8>(self.0, self.1);
            check::<16, S::F32x16>(self.0, self.1);
        }
    }
}

struct Permute([[u32; 4]; 2]);

impl Task for Permute {
    type Output = [[f32; 8]; 2];

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> Self::Output {
        // SAFETY: the caller promises the instruction set.
        let load = |first: f32| unsafe { S::F32x8::load(&std::array::from_fn(|i| first + i as f32)) };
        let (from, indices) = ([load(0.0), load(8.0)], self.0.each_ref());
        [S::permute_both::<0>(from, indices).store(), S::permute_both::<2>(from, indices).store()]
    }
}

#[test]
fn operations_give_the_bits_of_single_floats() {
    for round in 0..20_000 {
        let numbers = std::array::from_fn(|i| number(48 * round + i as u32));
        for set in available() {
            // SAFETY: the set is available.
            unsafe { set.run(Check(&numbers, &format!("{set:?}"))) };
        }
    }
}

#[test]
fn permutations_take_the_indices_of_a_byte_in_each_half() {
    for bits in (0..1000).map(hash) {
        let indices = [0, 4].map(|first| [0, 1, 2, 3].map(|i| bits >> (first + i) & 0x0707_0707));
        let lanes = |byte: u32| {
            let lane = |i: usize| 8 * (i / 4) as u32 + (indices[i / 4][i % 4] >> (8 * byte) & 7);
            std::array::from_fn(|i| lane(i) as f32)
        };
        for set in available() {
            // SAFETY: the set is available.
            let found = unsafe { set.run(Permute(indices)) };
            assert_eq!(found, [lanes(0), lanes(2)], "{set:?} {bits:x}");
        }
    }
}

#[test]
fn the_best_set_is_available_and_every_processor_has_one() {
    assert!(InstructionSet::detect().is_available());
    assert!(InstructionSet::Scalar.is_available());
    assert_eq!(available().next(), Some(InstructionSet::detect()));
}

#[test]
fn the_first_of_equal_keys_is_found() {
    for round in 0..1000 {
        let keys = std::array::from_fn(|i| hash(16 * round + i as u32) % 9);
        for (of, key) in keys.iter().enumerate() {
            assert_eq!(Some(first_equal(&keys, of)), keys.iter().position(|other| other == key));
        }
    }
}
