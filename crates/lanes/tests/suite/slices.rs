//! Slices and tables that numbers are read from and written to, and masks as bits.

use crate::numbers::{available, hash};
use alhazen_lanes::*;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The numbers of a table at random indices, and those of the table's bits.
struct Gather<'a> {
    reals: &'a [f32],
    ints: &'a [u32],
    indices: [u32; MAX_LANES],
}

impl Kernel for Gather<'_> {
    type Output = Vec<(f32, u32)>;

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let indices = R::Int::load(&self.indices);
        let reals = R::gather(self.reals, indices).to_array();
        let ints = R::Int::gather(self.ints, indices).to_array();
        (0..R::LANES).map(|lane| (reals[lane], ints[lane])).collect()
    }
}

/// Reads some numbers from each index on.
#[derive(Clone, Copy)]
struct GatherRows<'a, const K: usize> {
    reals: &'a [f32],
    ints: &'a [u32],
    indices: [u32; MAX_LANES],
}

impl<const K: usize> Kernel for GatherRows<'_, K> {
    type Output = Vec<([f32; K], [u32; K])>;

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let indices = R::Int::load(&self.indices);
        let reals = R::gather_rows::<K>(self.reals, indices).map(R::to_array);
        let ints = R::Int::gather_rows::<K>(self.ints, indices).map(R::Int::to_array);
        let row = |lane: usize| (reals.map(|column| column[lane]), ints.map(|column| column[lane]));
        (0..R::LANES).map(row).collect()
    }
}

#[test]
fn rows_of_numbers_are_read() {
    rows_are_read::<1>();
    rows_are_read::<2>();
    rows_are_read::<3>();
    rows_are_read::<4>();
}

fn rows_are_read<const K: usize>() {
    for round in 0..1000 {
        let length = K as u32 + hash(round) % 40;
        let ints: Vec<u32> = (0..length).map(hash).collect();
        let reals: Vec<f32> = ints.iter().map(|&int| int as f32).collect();
        let starts = length + 1 - K as u32;
        let indices = std::array::from_fn(|lane| hash(16 * round + lane as u32) % starts);
        for set in available() {
            let gather = GatherRows::<K> { reals: &reals, ints: &ints, indices };
            for (lane, (reals, found)) in set.dispatch(gather).into_iter().enumerate() {
                let expected = &ints[indices[lane] as usize..][..K];
                assert_eq!(found, expected, "{set:?}");
                assert_eq!(reals, found.map(|int| int as f32), "{set:?}");
            }
            let outside = GatherRows { indices: [starts; MAX_LANES], ..gather };
            assert!(catch_unwind(AssertUnwindSafe(|| set.dispatch(outside))).is_err());
            let outside = GatherRows { reals: &[0.0; 100], ..outside };
            assert!(catch_unwind(AssertUnwindSafe(|| set.dispatch(outside))).is_err());
        }
    }
}

/// Writes four numbers of some lanes.
#[derive(Clone, Copy)]
struct CompressFour {
    mask: u32,
}

impl Kernel for CompressFour {
    type Output = (usize, Vec<f32>);

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let columns = [0, 1, 2, 3].each(|i| R::from_fn(|lane| (4 * lane + i) as f32));
        let mut rows = vec![0.0; 4 * R::LANES];
        let mask = R::Mask::from_bits(self.mask & (u32::MAX >> (32 - R::LANES)));
        let count = R::compress_four(columns, mask, &mut rows);
        rows.truncate(4 * count);
        (R::LANES, rows)
    }
}

#[test]
fn rows_of_four_numbers_are_written_one_after_another() {
    for mask in (0..16).map(|bit| 1 << bit).chain((0..1000).map(hash)).chain([0, u32::MAX]) {
        for set in available() {
            let (lanes, rows) = set.dispatch(CompressFour { mask });
            let is_kept = |i: &usize| mask >> (i / 4) & 1 == 1;
            let expected: Vec<f32> = (0..4 * lanes).filter(is_kept).map(|i| i as f32).collect();
            assert_eq!(rows, expected, "{set:?}");
        }
    }
}

/// Reads tables of small integers.
#[derive(Clone, Copy)]
struct GatherSmall<'a> {
    bytes: &'a [u8],
    halves: &'a [u16],
    indices: [u32; MAX_LANES],
}

impl Kernel for GatherSmall<'_> {
    type Output = Vec<(u32, u32)>;

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let indices = R::Int::load(&self.indices);
        let bytes = R::Int::gather_bytes(self.bytes, indices).to_array();
        let halves = R::Int::gather_halves(self.halves, indices).to_array();
        (0..R::LANES).map(|lane| (bytes[lane], halves[lane])).collect()
    }
}

#[test]
fn tables_of_small_integers_are_read_at_indices() {
    for round in 0..1000 {
        let length = 1 + hash(round) % 40;
        let halves: Vec<u16> = (0..length).map(|i| hash(i) as u16).collect();
        let bytes: Vec<u8> = halves.iter().map(|&half| half as u8).collect();
        let indices = std::array::from_fn(|lane| hash(16 * round + lane as u32) % length);
        for set in available() {
            let gather = GatherSmall { bytes: &bytes, halves: &halves, indices };
            for (lane, found) in set.dispatch(gather).into_iter().enumerate() {
                let index = indices[lane] as usize;
                let byte = |i: usize| bytes.get(index + i).map_or(0, |&b| u32::from(b) << (8 * i));
                let expected = ((0..4).map(byte).sum(), u32::from(halves[index]));
                assert_eq!(found, expected, "{set:?}: {index} of {length}");
            }
            let outside = GatherSmall { indices: [length; MAX_LANES], ..gather };
            assert!(catch_unwind(AssertUnwindSafe(|| set.dispatch(outside))).is_err());
            let outside = GatherSmall { bytes: &[0; 100], ..outside };
            assert!(catch_unwind(AssertUnwindSafe(|| set.dispatch(outside))).is_err());
        }
    }
}

/// Calls another kernel.
struct Caller(f32);

/// Squares a number in all lanes.
struct Square(f32);

impl Kernel for Caller {
    type Output = (f32, bool);

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let (square, lanes) = R::call(Square(self.0));
        (square, lanes == R::LANES)
    }
}

impl Kernel for Square {
    type Output = (f32, usize);

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let x = R::splat(self.0);
        ((x * x).lane(R::LANES - 1), R::LANES)
    }
}

#[test]
fn a_kernel_calls_another_with_as_many_lanes() {
    for set in available() {
        assert_eq!(set.dispatch(Caller(3.0)), (9.0, true), "{set:?}");
    }
}

#[test]
fn tables_are_read_at_indices() {
    for round in 0..1000 {
        let length = 1 + hash(round) % 100;
        let ints: Vec<u32> = (0..length).map(hash).collect();
        let reals: Vec<f32> = (0..length).map(|i| hash(i) as f32).collect();
        let indices = std::array::from_fn(|lane| hash(16 * round + lane as u32) % length);
        for set in available() {
            let found = set.dispatch(Gather { reals: &reals, ints: &ints, indices });
            for (lane, (real, int)) in found.into_iter().enumerate() {
                let index = indices[lane] as usize;
                assert_eq!((real, int), (reals[index], ints[index]), "{set:?}: {index} of {length}");
            }
        }
    }
}

/// Numbers written to random places of tables of zeros.
struct Scatter {
    mask: u32,
    indices: [u32; MAX_LANES],
    length: usize,
}

impl Kernel for Scatter {
    type Output = (usize, Vec<f32>, Vec<u32>);

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let (mask, indices) = (R::Mask::from_bits(self.mask), R::Int::load(&self.indices));
        let lanes = R::Int::from_fn(|lane| lane as u32 + 1);
        let (mut reals, mut ints) = (vec![0.0; self.length], vec![0; self.length]);
        lanes.to_real().scatter(mask, &mut reals, indices);
        lanes.scatter(mask, &mut ints, indices);
        (R::LANES, reals, ints)
    }
}

#[test]
fn tables_are_written_at_indices() {
    for round in 0..1000 {
        let length = 1 + hash(round) % 100;
        let indices: [u32; MAX_LANES] = std::array::from_fn(|lane| hash(16 * round + lane as u32) % length);
        let mask = hash(round + 77) & 0xffff;
        for set in available() {
            let (lanes, reals, ints) = set.dispatch(Scatter { mask, indices, length: length as usize });
            let mut expected = vec![0; length as usize];
            for lane in (0..lanes).filter(|lane| mask >> lane & 1 == 1) {
                expected[indices[lane] as usize] = lane as u32 + 1;
            }
            assert_eq!(ints, expected, "{set:?}");
            assert!(reals.iter().zip(&expected).all(|(real, int)| *real == *int as f32), "{set:?}");
        }
    }
    for set in available() {
        let scatter = || set.dispatch(Scatter { mask: 0, indices: [5; MAX_LANES], length: 5 });
        assert!(catch_unwind(AssertUnwindSafe(scatter)).is_err(), "{set:?}");
    }
}

#[test]
fn indices_outside_of_a_table_panic() {
    for length in [0, 1, 5] {
        let (reals, ints) = (vec![1.0; length], vec![1; length]);
        for wrong in [length as u32, 7, 1 << 30, (1 << 31) - 1, 1 << 31, u32::MAX - 1, u32::MAX] {
            for set in available() {
                for lane in 0..LaneCount::of(set) {
                    let mut indices = [0; MAX_LANES];
                    indices[lane] = wrong;
                    for (reals, ints) in [(&reals[..], &[1][..]), (&[1.0], &ints)] {
                        let gather = || set.dispatch(Gather { reals, ints, indices });
                        let is_panic = catch_unwind(AssertUnwindSafe(gather)).is_err();
                        assert!(is_panic, "{set:?}: {wrong} in lane {lane}, table of {length}");
                    }
                }
            }
        }
    }
}

#[test]
#[ignore = "takes 16 GiB of address space"]
fn tables_may_have_more_numbers_than_signed_indices_reach() {
    let length = (1 << 31) + 100;
    let (mut reals, mut ints) = (vec![0.0; length], vec![0; length]);
    let indices = std::array::from_fn(|lane| [0, 1 << 20, (1 << 31) + 7][lane % 3]);
    for &index in &indices {
        (reals[index as usize], ints[index as usize]) = (index as f32, index);
    }
    for set in available() {
        for (lane, found) in
            set.dispatch(Gather { reals: &reals, ints: &ints, indices }).into_iter().enumerate()
        {
            assert_eq!(found, (indices[lane] as f32, indices[lane]), "{set:?}");
        }
    }
}

struct LaneCount;

impl LaneCount {
    fn of(set: InstructionSet) -> usize {
        set.dispatch(Self)
    }
}

impl Kernel for LaneCount {
    type Output = usize;

    #[inline(always)]
    fn run<R: Real>(self) -> usize {
        R::LANES
    }
}

/// The lanes of a mask of integers, and how many.
struct Compress([u32; MAX_LANES], u32);

const UNTOUCHED: u32 = 0xdead_beef;

impl Kernel for Compress {
    type Output = ([u32; MAX_LANES + 1], usize);

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let mut to = [UNTOUCHED; MAX_LANES + 1];
        let count = R::Int::load(&self.0).compress(Mask::from_bits(self.1), &mut to);
        (to, count)
    }
}

#[test]
fn the_lanes_of_a_mask_are_written_one_after_another() {
    for set in available() {
        let lanes = LaneCount::of(set);
        for bits in 0..1 << lanes {
            let integers = std::array::from_fn(|lane| hash(16 * bits + lane as u32));
            let (to, count) = set.dispatch(Compress(integers, bits));
            let kept: Vec<u32> = (0..lanes).filter(|i| bits >> i & 1 == 1).map(|i| integers[i]).collect();
            assert_eq!(to[..count], kept, "{set:?}: {bits:b}");
            assert!(to[lanes..].iter().all(|&x| x == UNTOUCHED), "{set:?}: {bits:b}");
        }
    }
}

/// The lanes of a mask, appended twice to one number.
struct Append([u32; MAX_LANES], u32);

impl Kernel for Append {
    type Output = (Vec<u32>, Vec<f32>);

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let (mut integers, mut floats) = (vec![7], vec![7.0]);
        let lanes = R::Int::load(&self.0);
        for _ in 0..2 {
            lanes.append(Mask::from_bits(self.1), &mut integers);
            lanes.to_real().append(Mask::from_bits(self.1), &mut floats);
        }
        (integers, floats)
    }
}

#[test]
fn the_lanes_of_a_mask_are_appended() {
    for set in available() {
        let lanes = LaneCount::of(set);
        let numbers = std::array::from_fn(|lane| 100 + lane as u32);
        for bits in [0, 1, 0b1010, 0x8001, 0xffff].map(|bits| bits & ((1 << lanes) - 1)) {
            let (integers, floats) = set.dispatch(Append(numbers, bits));
            let kept: Vec<u32> = (0..lanes).filter(|i| bits >> i & 1 == 1).map(|i| numbers[i]).collect();
            assert_eq!(integers, [&[7], &*kept, &*kept].concat(), "{set:?}: {bits:b}");
            assert!(floats.iter().map(|&x| x as u32).eq(integers), "{set:?}: {bits:b}");
        }
    }
}

/// What a mask says of its bits: them, and whether any or all are set.
struct Bits(u32);

impl Kernel for Bits {
    type Output = [(u32, bool, bool); 4];

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let mask = R::Mask::from_bits(self.0);
        [mask, !mask, R::Mask::splat(true), R::Mask::splat(false)]
            .map(|mask| (mask.bits(), mask.any(), mask.all()))
    }
}

#[test]
fn masks_have_a_bit_for_each_lane() {
    for set in available() {
        let all = u32::MAX >> (32 - LaneCount::of(set));
        for bits in (0..=all).chain([u32::MAX, !all, 1 << 31]) {
            let expected = [bits & all, !bits & all, all, 0].map(|bits| (bits, bits != 0, bits == all));
            assert_eq!(set.dispatch(Bits(bits)), expected, "{set:?}: {bits:b}");
        }
    }
}

/// Reads and writes slices of one number less than there are lanes.
#[derive(Clone, Copy)]
enum Short {
    LoadReals,
    LoadInts,
    StoreReals,
    StoreInts,
    Compress,
}

impl Kernel for Short {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let (mut reals, mut ints) = ([0.0; MAX_LANES], [0; MAX_LANES]);
        let (reals, ints) = (&mut reals[..R::LANES - 1], &mut ints[..R::LANES - 1]);
        match self {
            Self::LoadReals => drop(R::load(reals)),
            Self::LoadInts => drop(R::Int::load(ints)),
            Self::StoreReals => R::one().store(reals),
            Self::StoreInts => R::Int::default().store(ints),
            Self::Compress => drop(R::Int::default().compress(Mask::splat(false), ints)),
        }
    }
}

#[test]
fn slices_shorter_than_the_lanes_panic() {
    use Short::*;
    for set in available() {
        for short in [LoadReals, LoadInts, StoreReals, StoreInts, Compress] {
            assert!(catch_unwind(|| set.dispatch(short)).is_err(), "{set:?}");
        }
    }
}

/// How numbers are printed.
struct Print;

impl Kernel for Print {
    type Output = [String; 3];

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let (real, int) = (R::splat(1.5), R::Int::from_fn(|lane| lane as u32));
        [format!("{real:?}"), format!("{int:?}"), format!("{:?}", int.eq(R::Int::splat(1)))]
    }
}

#[test]
fn numbers_are_printed_lane_by_lane() {
    for set in available().filter(|&set| set != InstructionSet::Scalar) {
        let lanes = LaneCount::of(set) as u32;
        let integers = (0..lanes).collect::<Vec<u32>>();
        let bools = integers.iter().map(|&lane| lane == 1).collect::<Vec<bool>>();
        let reals = vec![1.5; lanes as usize];
        assert_eq!(
            set.dispatch(Print),
            [format!("{reals:?}"), format!("{integers:?}"), format!("{bools:?}")]
        );
    }
}
