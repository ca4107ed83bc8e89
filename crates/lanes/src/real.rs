//! Numbers that are one `f32`, `u32` or `bool`, or one for each lane of a vector.
//!
//! Physics is written once for any [`Real`]. With `f32` it reads and runs as scalar code; with the
//! vectors of an instruction set it computes as many samples at once as there are lanes. No
//! operation combines lanes, except for the explicit tests of a [`Mask`], and all have the same
//! bits on every instruction set, so that the number of lanes never changes a result.

use crate::Each;
use std::fmt::Debug;
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, BitXor, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};

/// A float for each lane.
///
/// Arithmetic is that of IEEE 754, rounded to nearest. There is no contraction: a fused
/// multiply-add is made by [`mul_add`](Self::mul_add) alone, which is slow on processors without
/// the instruction.
pub trait Real:
    Copy
    + Debug
    + Default
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// The number of lanes.
    const LANES: usize;

    /// A bool for each lane.
    type Mask: Mask;

    /// A 32-bit integer for each lane.
    type Int: Int<Real = Self, Mask = Self::Mask>;

    /// The same number in all lanes.
    fn splat(x: f32) -> Self;

    /// The first numbers of a slice, which must have one for each lane.
    fn load(from: &[f32]) -> Self;

    /// Writes the lanes to the start of a slice, which must have a place for each.
    fn store(self, to: &mut [f32]);

    /// Calls a function of these lanes, which is not compiled into each caller.
    fn call<C: Callee<Self>>(callee: C) -> C::Output;

    /// The numbers of a table at these indices.
    ///
    /// # Panics
    /// If any index lies outside of the table.
    #[inline(always)]
    fn gather(table: &[f32], indices: Self::Int) -> Self {
        let indices = indices.to_array();
        Self::from_fn(|lane| table[indices[lane] as usize])
    }

    /// `K` ≤ 4 numbers of a table from each of these indices on: the first ones, the second ones,
    /// and so on. Takes little longer than to gather one.
    ///
    /// # Panics
    /// If any of the numbers lies outside of the table.
    #[inline(always)]
    fn gather_rows<const K: usize>(table: &[f32], indices: Self::Int) -> [Self; K] {
        let indices = indices.to_array();
        let mut columns = [[0.0; MAX_LANES]; K];
        for lane in 0..Self::LANES {
            let row = &table[indices[lane] as usize..][..K];
            for (column, &number) in columns.iter_mut().zip(row) {
                column[lane] = number;
            }
        }
        let mut rows = [Self::zero(); K];
        for (row, column) in rows.iter_mut().zip(&columns) {
            *row = Self::load(column);
        }
        rows
    }

    /// Writes the lanes where the mask is true to places of a table. Of lanes with the same index
    /// the last one counts.
    ///
    /// # Panics
    /// If any index lies outside of the table.
    #[inline(always)]
    fn scatter(self, mask: Self::Mask, table: &mut [f32], indices: Self::Int) {
        let (lanes, indices, bits) = (self.to_array(), indices.to_array(), mask.bits());
        for lane in 0..Self::LANES {
            let place = &mut table[indices[lane] as usize];
            if bits >> lane & 1 == 1 {
                *place = lanes[lane];
            }
        }
    }

    /// `a` where the mask is true, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    /// As [`Int::compress`].
    #[inline(always)]
    fn compress(self, mask: Self::Mask, to: &mut [f32]) -> usize {
        let mut bits = [0; MAX_LANES];
        let count = self.to_bits().compress(mask, &mut bits);
        Self::from_bits(Self::Int::load(&bits)).store(to);
        count
    }

    /// Appends the lanes where the mask is true.
    #[inline(always)]
    fn append(self, mask: Self::Mask, to: &mut Vec<f32>) {
        let (len, mut kept) = (to.len(), [0.0; MAX_LANES]);
        let count = self.compress(mask, &mut kept);
        // All lanes, as their number is known when this is compiled.
        to.extend_from_slice(&kept[..Self::LANES]);
        to.truncate(len + count);
    }

    /// Writes four numbers of each lane where the mask is true, the first ones of `columns`, the
    /// second ones, and so on, one lane after another to the start of a slice, which must have
    /// place for four numbers of every lane; gives the number of lanes written. Places after them
    /// may be overwritten.
    #[inline(always)]
    fn compress_four(columns: [Self; 4], mask: Self::Mask, to: &mut [f32]) -> usize {
        let columns = columns.each(Self::to_array);
        compress_rows(mask.bits(), Self::LANES, to, |lane| {
            let [a, b, c, d] = &columns;
            [a[lane], b[lane], c[lane], d[lane]]
        })
    }

    /// |`self`|.
    fn abs(self) -> Self;

    /// √`self`, correctly rounded; NaN below zero.
    fn sqrt(self) -> Self;

    /// The greatest integer that is at most `self`.
    fn floor(self) -> Self;

    /// The smaller of the two; `b` where either is NaN or both are zeros.
    fn min(self, b: Self) -> Self;

    /// The larger of the two; `b` where either is NaN or both are zeros.
    fn max(self, b: Self) -> Self;

    /// The magnitude of `self` with the sign of `sign`.
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        let mask = Self::Int::splat(1 << 31);
        Self::from_bits(self.to_bits() & !mask | sign.to_bits() & mask)
    }

    /// `self`·b + c, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;

    /// `self` < b; false where either is NaN, as in all comparisons but `ne`.
    fn lt(self, b: Self) -> Self::Mask;

    /// `self` ≤ b.
    fn le(self, b: Self) -> Self::Mask;

    /// `self` > b.
    #[inline(always)]
    fn gt(self, b: Self) -> Self::Mask {
        b.lt(self)
    }

    /// `self` ≥ b.
    #[inline(always)]
    fn ge(self, b: Self) -> Self::Mask {
        b.le(self)
    }

    /// `self` = b.
    fn eq(self, b: Self) -> Self::Mask;

    /// `self` ≠ b; true where either is NaN.
    #[inline(always)]
    fn ne(self, b: Self) -> Self::Mask {
        !self.eq(b)
    }

    /// The bits of the floats.
    fn to_bits(self) -> Self::Int;

    /// The floats that have these bits.
    fn from_bits(bits: Self::Int) -> Self;

    /// Rounded towards zero; a negative number is its two's complement. Only for numbers above −2³¹
    /// and below 2³¹: what others give depends on the instruction set.
    fn to_int(self) -> Self::Int;

    /// A number for each lane.
    #[inline(always)]
    fn from_fn(mut lane: impl FnMut(usize) -> f32) -> Self {
        let mut values = [0.0; MAX_LANES];
        for (i, value) in values[..Self::LANES].iter_mut().enumerate() {
            *value = lane(i);
        }
        Self::load(&values)
    }

    /// The number of each lane, in the first places of an array.
    #[inline(always)]
    fn to_array(self) -> [f32; MAX_LANES] {
        let mut values = [0.0; MAX_LANES];
        self.store(&mut values);
        values
    }

    /// The number of a lane.
    #[inline(always)]
    fn lane(self, lane: usize) -> f32 {
        self.to_array()[lane]
    }

    /// Zero in all lanes.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    /// One in all lanes.
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }

    /// Limited to the range from `low` to `high`; `low` for NaN.
    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
}

/// A 32-bit integer for each lane, unsigned where that matters. Arithmetic wraps.
pub trait Int:
    Copy
    + Debug
    + Default
    + Send
    + Sync
    + 'static
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Not<Output = Self>
{
    /// Floats of as many lanes.
    type Real: Real<Int = Self, Mask = Self::Mask>;

    /// A bool for each lane.
    type Mask: Mask;

    /// The same integer in all lanes.
    fn splat(x: u32) -> Self;

    /// The first integers of a slice, which must have one for each lane.
    fn load(from: &[u32]) -> Self;

    /// Writes the lanes to the start of a slice, which must have a place for each.
    fn store(self, to: &mut [u32]);

    /// The integers of a table at these indices.
    ///
    /// # Panics
    /// If any index lies outside of the table.
    #[inline(always)]
    fn gather(table: &[u32], indices: Self) -> Self {
        let indices = indices.to_array();
        Self::from_fn(|lane| table[indices[lane] as usize])
    }

    /// As [`Real::gather_rows`].
    ///
    /// # Panics
    /// If any of the integers lies outside of the table.
    #[inline(always)]
    fn gather_rows<const K: usize>(table: &[u32], indices: Self) -> [Self; K] {
        // SAFETY: an integer has the size and alignment of a float, which may have any bits.
        let floats = unsafe { std::slice::from_raw_parts(table.as_ptr().cast(), table.len()) };
        let columns = Self::Real::gather_rows::<K>(floats, indices);
        let mut rows = [Self::splat(0); K];
        for (row, column) in rows.iter_mut().zip(columns) {
            *row = column.to_bits();
        }
        rows
    }

    /// Four bytes from each of these indices on, the first one lowest; those beyond the end of the
    /// table are 0.
    ///
    /// # Panics
    /// If any index lies outside of the table.
    #[inline(always)]
    fn gather_bytes(table: &[u8], indices: Self) -> Self {
        Self::load(&gather_bytes(table, &indices.to_array()[..Self::Real::LANES]))
    }

    /// The integers of a table of 16 bits each at these indices.
    ///
    /// # Panics
    /// If any index lies outside of the table.
    #[inline(always)]
    fn gather_halves(table: &[u16], indices: Self) -> Self {
        let indices = indices.to_array();
        Self::from_fn(|lane| table[indices[lane] as usize].into())
    }

    /// Writes the lanes where the mask is true to places of a table. Of lanes with the same index
    /// the last one counts.
    ///
    /// # Panics
    /// If any index lies outside of the table.
    #[inline(always)]
    fn scatter(self, mask: Self::Mask, table: &mut [u32], indices: Self) {
        let (lanes, indices, bits) = (self.to_array(), indices.to_array(), mask.bits());
        for lane in 0..Self::Real::LANES {
            let place = &mut table[indices[lane] as usize];
            if bits >> lane & 1 == 1 {
                *place = lanes[lane];
            }
        }
    }

    /// `a` where the mask is true, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    /// Writes the lanes where the mask is true one after another to the start of a slice, which
    /// must have a place for every lane of the vector; gives their number. Places after them may
    /// be overwritten.
    #[inline(always)]
    fn compress(self, mask: Self::Mask, to: &mut [u32]) -> usize {
        let to = &mut to[..Self::Real::LANES];
        let (lanes, bits) = (self.to_array(), mask.bits());
        let mut count = 0;
        for (lane, &integer) in lanes[..Self::Real::LANES].iter().enumerate() {
            to[count] = integer;
            count += (bits >> lane & 1) as usize;
        }
        count
    }

    /// Appends the lanes where the mask is true.
    #[inline(always)]
    fn append(self, mask: Self::Mask, to: &mut Vec<u32>) {
        let (len, mut kept) = (to.len(), [0; MAX_LANES]);
        let count = self.compress(mask, &mut kept);
        to.extend_from_slice(&kept[..Self::Real::LANES]);
        to.truncate(len + count);
    }

    /// The sum modulo 2³².
    fn wrapping_add(self, b: Self) -> Self;

    /// The difference modulo 2³².
    fn wrapping_sub(self, b: Self) -> Self;

    /// The product modulo 2³².
    fn wrapping_mul(self, b: Self) -> Self;

    /// The low and the high halves of the products of 64 bits.
    fn mul_wide(self, b: Self) -> (Self, Self);

    /// Shifted left by `bits` < 32.
    fn shl(self, bits: u32) -> Self;

    /// Shifted right by `bits` < 32; zeros come in.
    fn shr(self, bits: u32) -> Self;

    /// `self` = b.
    fn eq(self, b: Self) -> Self::Mask;

    /// `self` < b, as unsigned integers.
    fn lt(self, b: Self) -> Self::Mask;

    /// As floats, of signed integers in two's complement: rounded to nearest.
    fn to_real(self) -> Self::Real;

    /// An integer for each lane.
    #[inline(always)]
    fn from_fn(mut lane: impl FnMut(usize) -> u32) -> Self {
        let mut values = [0; MAX_LANES];
        for (i, value) in values[..Self::Real::LANES].iter_mut().enumerate() {
            *value = lane(i);
        }
        Self::load(&values)
    }

    /// The integer of each lane, in the first places of an array.
    #[inline(always)]
    fn to_array(self) -> [u32; MAX_LANES] {
        let mut values = [0; MAX_LANES];
        self.store(&mut values);
        values
    }
}

/// A bool for each lane.
pub trait Mask:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Not<Output = Self>
{
    /// The same bool in all lanes.
    fn splat(x: bool) -> Self;

    /// The lanes whose bits are set, the first lane in the lowest bit.
    fn from_bits(bits: u32) -> Self;

    /// A bit for each lane where the mask is true; no others.
    fn bits(self) -> u32;

    /// Whether any lane is true.
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }

    /// Whether every lane is true.
    #[inline(always)]
    fn all(self) -> bool {
        (!self).bits() == 0
    }
}

/// See [`Real::compress_four`], of rows for lanes.
#[inline(always)]
pub(crate) fn compress_rows(
    mask: u32,
    lanes: usize,
    to: &mut [f32],
    row: impl Fn(usize) -> [f32; 4],
) -> usize {
    let (to, _) = to[..4 * lanes].as_chunks_mut::<4>();
    let mut count = 0;
    for lane in 0..lanes {
        to[count] = row(lane);
        count += (mask >> lane & 1) as usize;
    }
    count
}

/// Four bytes from each index on, those beyond the end of the table 0.
pub(crate) fn gather_bytes(table: &[u8], indices: &[u32]) -> [u32; MAX_LANES] {
    let mut values = [0; MAX_LANES];
    for (value, &index) in values.iter_mut().zip(indices) {
        let from = &table[index as usize..];
        assert!(!from.is_empty(), "an index inside of the table");
        let mut bytes = [0; 4];
        let count = from.len().min(4);
        bytes[..count].copy_from_slice(&from[..count]);
        *value = u32::from_le_bytes(bytes);
    }
    values
}

/// A computation that is written for any number of lanes. This and everything it calls must be
/// `#[inline(always)]`, as for a [`Task`](crate::Task).
pub trait Kernel {
    /// The result.
    type Output;

    /// Computes it with as many lanes as `R` has.
    fn run<R: Real>(self) -> Self::Output;
}

/// The arguments of a function of numbers with lanes. This and everything it calls must be
/// `#[inline(always)]`; [`Real::call`] then makes one function of it.
pub trait Callee<R: Real> {
    /// The result.
    type Output;

    /// Computes it.
    fn run(self) -> Self::Output;
}

impl<R: Real, K: Kernel> Callee<R> for K {
    type Output = K::Output;

    #[inline(always)]
    fn run(self) -> K::Output {
        Kernel::run::<R>(self)
    }
}

/// The most lanes of any vector.
pub const MAX_LANES: usize = 16;
