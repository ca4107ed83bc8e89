//! Sums that do not depend on the order of addition.
//!
//! Floating-point addition rounds after each term, so its result depends on the order. Here each
//! term is rounded once, to a multiple of 2⁻⁶⁴, and terms are added as integers, which is exact:
//! any order, any grouping and any number of threads give the same bits. A term is off by 2⁻⁶⁵ ≈
//! 3·10⁻²⁰ at most, and may be as large as [`MAX_TERM`] = 2⁴⁰ ≈ 10¹².
//!
//! An array keeps the low 96 bits of each sum, 12 bytes, which reach to ±2³¹. What goes beyond is
//! rare (bright light sources of many samples) and kept in a map for each tile. The low bits are
//! those in [−2⁹⁵, 2⁹⁵), so that each sum has one form only.

use lanes::Each;
use std::collections::BTreeMap;
use std::ops::Range;

use image::ImageError;
use rayon::prelude::*;

use crate::grid::Grid;

/// The largest magnitude that a term may have.
pub(crate) const MAX_TERM: f64 = (1_u64 << 40) as f64;

/// The bytes of a sum in the array.
pub(crate) const SUM_BYTES: usize = size_of::<Low>();

const UNITS_PER_ONE: f64 = 18_446_744_073_709_551_616.0;

/// The low 96 bits of a sum in two's complement, the lowest first.
type Low = [u32; 3];

/// The rest of the sums of a tile, in units of 2⁹⁶, by their index in the tile; none is 0.
type High = BTreeMap<u32, i64>;

/// Whether `term` can be added: it is a number and not larger than [`MAX_TERM`].
#[inline]
pub(crate) fn can_add(term: f64) -> bool {
    term.abs() <= MAX_TERM
}

/// A sum's units as the nearest number.
#[inline]
pub(crate) fn value(units: i128) -> f64 {
    units as f64 / UNITS_PER_ONE
}

/// The same of the low bits of a sum.
#[inline]
fn low_value([a, b, c]: Low) -> f64 {
    let upper = (u64::from(b) | u64::from(c) << 32) as i64;
    if upper.unsigned_abs() < 1 << 53 {
        // Both parts are exact, so that only their sum is rounded.
        return upper as f64 / HALF + f64::from(a) / UNITS_PER_ONE;
    }
    value(extended([a, b, c]))
}

/// A term's units.
#[inline]
pub(crate) fn units(term: f64) -> i128 {
    debug_assert!(can_add(term));
    if term.abs() < INTEGER_LIMIT / HALF {
        // Two halves of 32 bits and more, the upper one rounded, so that the rest is exact.
        let scaled = term * HALF;
        let high = scaled + INTEGERS;
        let low = (scaled - (high - INTEGERS)) * HALF + INTEGERS;
        return (i128::from(integer(high)) << 32) + i128::from(integer(low));
    }
    // Whole and fraction are exact, and a large term has no digits below the units.
    let whole = term.abs().trunc();
    let fraction = (term.abs() - whole) * UNITS_PER_ONE;
    let units = i128::from(whole as u64) << 64 | i128::from(fraction as u64);
    if term < 0.0 { -units } else { units }
}

/// 2³².
const HALF: f64 = 4_294_967_296.0;
/// 2⁵² + 2⁵¹: a sum with a magnitude below [`INTEGER_LIMIT`] is rounded to an integer, which is in
/// the low bits. Conversions to integers have more cases, which take longer.
const INTEGERS: f64 = 6_755_399_441_055_744.0;
/// 2⁵¹.
const INTEGER_LIMIT: f64 = 2_251_799_813_685_248.0;

/// The integer of a sum with [`INTEGERS`].
#[inline]
fn integer(sum: f64) -> i64 {
    sum.to_bits().wrapping_sub(INTEGERS.to_bits()) as i64
}

#[inline]
fn extended([a, b, c]: Low) -> i128 {
    i128::from(u64::from(a) | u64::from(b) << 32) | i128::from(c as i32) << 64
}

/// The number in [−2⁹⁵, 2⁹⁵) that has the same low 96 bits.
#[inline]
fn low_bits(units: i128) -> i128 {
    units << 32 >> 32
}

/// Sums for each pixel of a film, tile after tile.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sums {
    /// The number of sums per pixel.
    components: usize,
    low: Vec<Low>,
    high: Vec<High>,
    /// Whether pages of `low` may not have been written to.
    is_fresh: bool,
}

/// Up to so many bytes of sums are written by all threads when they are made. The pages of more are
/// allocated where samples are added.
const WRITTEN_AT_ONCE: usize = 64 << 20;

impl Sums {
    /// `components` sums for each pixel, all 0; refused where there is no memory for them.
    pub(crate) fn new(grid: Grid, components: usize) -> Result<Self, ImageError> {
        if components == 0 {
            return Ok(Self::default());
        }
        let count = grid.0.area().saturating_mul(components);
        let is_fresh = count.saturating_mul(SUM_BYTES) > WRITTEN_AT_ONCE;
        let low = if is_fresh {
            zeros(count)?
        } else {
            let mut low = reserved(count)?;
            (0..count).into_par_iter().map(|_| Low::default()).collect_into_vec(&mut low);
            low
        };
        Ok(Self { components, low, high: maps(grid.tile_count())?, is_fresh })
    }

    /// The number of sums per pixel.
    pub(crate) fn components(&self) -> usize {
        self.components
    }

    /// The sums of each tile, of as many pixels as its range says.
    pub(crate) fn tiles(&mut self, grid: Grid) -> impl Iterator<Item = TileSums<'_>> {
        let (components, is_fresh, mut rest) = (self.components, self.is_fresh, &mut self.low[..]);
        self.high.iter_mut().enumerate().map(move |(tile, high)| {
            let count = grid.bounds(tile).area() * components;
            let (low, others) = std::mem::take(&mut rest).split_at_mut(count);
            rest = others;
            TileSums { components, low, high, is_fresh }
        })
    }

    /// The sums of one tile, whose pixels are in this range.
    pub(crate) fn tile(&mut self, tile: usize, pixels: Range<usize>) -> TileSums<'_> {
        let components = self.components;
        let low = &mut self.low[pixels.start * components..pixels.end * components];
        TileSums { components, low, high: &mut self.high[tile], is_fresh: self.is_fresh }
    }

    /// A sum in units of 2⁻⁶⁴, as far as 128 bits hold it. `first` is the index of the tile's first
    /// pixel.
    pub(crate) fn units(&self, [tile, first, pixel]: [usize; 3], component: usize) -> i128 {
        let index = pixel * self.components + component;
        let low = extended(self.low[first * self.components + index]);
        whole(low, &self.high[tile], index)
    }

    /// The same as the nearest number.
    #[inline]
    pub(crate) fn value(&self, place: [usize; 3], component: usize) -> f64 {
        let [tile, first, pixel] = place;
        if self.high[tile].is_empty() {
            return low_value(self.low[(first + pixel) * self.components + component]);
        }
        value(self.units(place, component))
    }

    /// The values of the `N` sums that each of these pixels of a tile has; `None` if the tile has
    /// sums with high bits.
    pub(crate) fn values<const N: usize>(
        &self,
        tile: usize,
        pixels: Range<usize>,
    ) -> Option<impl Iterator<Item = [f64; N]>> {
        debug_assert_eq!(self.components, N);
        let (low, _) = self.low[pixels.start * N..pixels.end * N].as_chunks::<N>();
        self.high[tile].is_empty().then(|| low.iter().map(|low| low.map(low_value)))
    }

    /// Adds the sums of another film of the same pixels.
    pub(crate) fn merge(&mut self, other: &Self, grid: Grid) {
        for (tile, mut sums) in self.tiles(grid).enumerate() {
            let start = grid.range(tile).start * other.components;
            sums.merge(&other.low[start..start + sums.low.len()], &other.high[tile]);
        }
    }
}

/// The sum that low and high bits make, as far as 128 bits hold it.
#[inline]
fn whole(low: i128, high: &High, index: usize) -> i128 {
    match high.get(&(index as u32)) {
        None => low,
        Some(&high) => {
            // With low bits that are not negative only sums beyond 128 bits saturate.
            let (high, low) = if low < 0 { (high - 1, low + (1 << 96)) } else { (high, low) };
            i128::from(high).saturating_mul(1 << 96).saturating_add(low)
        }
    }
}

/// The sums of one tile.
#[derive(Debug)]
pub(crate) struct TileSums<'film> {
    components: usize,
    low: &'film mut [Low],
    high: &'film mut High,
    is_fresh: bool,
}

impl TileSums<'_> {
    /// The number of sums per pixel.
    pub(crate) fn components(&self) -> usize {
        self.components
    }

    /// Writes zeros to all sums, which are zero, where that has not been done.
    pub(crate) fn touch(&mut self) {
        debug_assert!(self.low.iter().all(|low| *low == [0; 3]) && self.high.is_empty());
        if self.is_fresh {
            self.low.fill([0; 3]);
        }
    }

    /// Adds a term that [`can_add`].
    #[inline]
    pub(crate) fn add(&mut self, pixel: usize, component: usize, term: f64) {
        self.add_low(pixel * self.components + component, units(term));
    }

    /// Adds units of 2⁻⁶⁴.
    pub(crate) fn add_units(&mut self, pixel: usize, component: usize, units: i128) {
        let (index, low) = (pixel * self.components + component, low_bits(units));
        self.add_low(index, low);
        // `units` − `low` is a multiple of 2⁹⁶ that may take more than 128 bits.
        let high = (units >> 96) as i64 + i64::from(low < 0);
        if high != 0 {
            self.add_high(index, high);
        }
    }

    /// Adds units that take less than 127 bits.
    #[inline]
    fn add_low(&mut self, index: usize, units: i128) {
        let sum = extended(self.low[index]) + units;
        self.low[index] = [0, 32, 64].each(|shift| (sum >> shift) as u32);
        let high = (sum >> 64) as i64;
        if high != i64::from(high as i32) {
            self.add_high(index, ((sum - low_bits(sum)) >> 96) as i64);
        }
    }

    #[cold]
    fn add_high(&mut self, index: usize, units: i64) {
        let high = self.high.entry(index as u32).or_insert(0);
        *high = high.saturating_add(units);
        if *high == 0 {
            self.high.remove(&(index as u32));
        }
    }

    fn merge(&mut self, low: &[Low], high: &High) {
        for (index, &low) in low.iter().enumerate() {
            self.add_low(index, extended(low));
        }
        high.iter().for_each(|(&index, &high)| self.add_high(index as usize, high));
    }
}

/// The sums of one tile, with memory of its own.
#[derive(Clone, Debug)]
pub(crate) struct OwnTileSums {
    components: usize,
    low: Vec<Low>,
    high: High,
}

impl OwnTileSums {
    /// `components` sums for each of `pixels`, all 0; refused where there is no memory for them.
    pub(crate) fn new(pixels: usize, components: usize) -> Result<Self, ImageError> {
        Ok(Self { components, low: zeros(pixels * components)?, high: High::new() })
    }

    /// The number of sums per pixel.
    pub(crate) fn components(&self) -> usize {
        self.components
    }

    /// The sums, to be added to.
    pub(crate) fn open(&mut self) -> TileSums<'_> {
        TileSums { components: self.components, low: &mut self.low, high: &mut self.high, is_fresh: false }
    }

    /// A sum in units of 2⁻⁶⁴, as far as 128 bits hold it.
    pub(crate) fn units(&self, pixel: usize, component: usize) -> i128 {
        let index = pixel * self.components + component;
        whole(extended(self.low[index]), &self.high, index)
    }

    /// Adds the sums of another film's tile.
    pub(crate) fn merge(&mut self, other: &Self) {
        self.open().merge(&other.low, &other.high);
    }
}

/// `count` zeros. The operating system allocates their pages when they are first written to.
pub(crate) fn zeros<T: bytemuck::Zeroable>(count: usize) -> Result<Vec<T>, ImageError> {
    bytemuck::allocation::try_zeroed_vec(count).map_err(|()| no_memory(count.saturating_mul(size_of::<T>())))
}

/// `count` empty maps.
pub(crate) fn maps<K, V>(count: usize) -> Result<Vec<BTreeMap<K, V>>, ImageError> {
    let mut maps = reserved(count)?;
    maps.resize_with(count, BTreeMap::new);
    Ok(maps)
}

/// An empty array with a capacity of `count` values.
pub(crate) fn reserved<T>(count: usize) -> Result<Vec<T>, ImageError> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| no_memory(count.saturating_mul(size_of::<T>())))?;
    Ok(values)
}

fn no_memory(bytes: usize) -> ImageError {
    ImageError::Limits(format!("no memory for {bytes} bytes of a film"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Random;

    fn sum(terms: &[f64]) -> OwnTileSums {
        let mut sum = OwnTileSums::new(1, 1).unwrap();
        terms.iter().for_each(|&term| sum.open().add(0, 0, term));
        sum
    }

    fn number(sum: &OwnTileSums) -> f64 {
        value(sum.units(0, 0))
    }

    /// Low and high bits.
    fn bits(sum: &OwnTileSums) -> (Low, Option<i64>) {
        (sum.low[0], sum.high.get(&0).copied())
    }

    #[test]
    fn small_terms_survive_large_ones() {
        let tiny = 2f64.powi(-60);
        assert_eq!(number(&sum(&[MAX_TERM, tiny, -MAX_TERM])), tiny);
        assert_eq!(
            number(&sum(&[0.1, 0.2, -0.3])).abs(),
            2f64.powi(-55),
            "the error of the decimal fractions"
        );
        assert_eq!(number(&sum(&[2f64.powi(-66); 100])), 0.0, "below the grid");
    }

    #[test]
    fn values_are_the_nearest_numbers() {
        let mut random = Random::new(2);
        for bits in 0..95 {
            for _ in 0..100 {
                let units = (0..4).fold(0, |units: i128, _| units << 32 | i128::from(random.bits()));
                let units = units >> (127 - bits);
                let low = [0, 32, 64].map(|shift| (units >> shift) as u32);
                assert_eq!(low_value(low), value(units), "{units}");
            }
        }
    }

    #[test]
    fn terms_that_are_not_numbers_or_too_large_cannot_be_added() {
        for term in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 2.0 * MAX_TERM] {
            assert!(!can_add(term));
        }
        assert!(can_add(-MAX_TERM));
    }

    #[test]
    fn sums_beyond_96_bits_are_exact() {
        let limit = 2f64.powi(31);
        let tiny = 2f64.powi(-64);
        for (terms, expected, high) in [
            (vec![limit], limit, Some(1)),
            (vec![limit - tiny * 2f64.powi(60)], limit - tiny * 2f64.powi(60), None),
            (vec![-limit], -limit, None),
            (vec![-limit, -tiny], -limit, Some(-1)),
            (vec![limit, -1.0], limit - 1.0, None),
            (vec![MAX_TERM; 1000], 1000.0 * MAX_TERM, Some(1000 << 8)),
            (vec![-MAX_TERM; 1000], -1000.0 * MAX_TERM, Some(-1000 << 8)),
        ] {
            let sum = sum(&terms);
            assert_eq!((number(&sum), bits(&sum).1), (expected, high));
        }
    }

    #[test]
    fn units_of_any_size_are_added_as_they_are() {
        let limits = [0, 1, -1, (1 << 95) - 1, 1 << 95, -1 << 95, (-1 << 95) - 1, i128::MAX, i128::MIN];
        for units in limits {
            let mut sum = OwnTileSums::new(1, 1).unwrap();
            sum.open().add_units(0, 0, units);
            assert_eq!(sum.units(0, 0), units);
            sum.open().add_units(0, 0, -(units / 2));
            sum.open().add_units(0, 0, -(units - units / 2));
            assert_eq!(bits(&sum), ([0; 3], None));
        }
    }

    #[test]
    fn any_order_and_grouping_gives_the_same_sum() {
        let mut random = Random::new(1);
        for count in 1..200 {
            // Magnitudes over seventy powers of two, where a floating-point sum would depend on the
            // order, and carries beyond 96 bits are frequent.
            let mut term =
                || f64::from(random.get_1d() - 0.5) * 2f64.powi((70.0 * random.get_1d()) as i32 - 30);
            let terms: Vec<f64> = (0..count).map(|_| term()).collect();
            let whole = sum(&terms);
            let reversed: Vec<f64> = terms.iter().rev().copied().collect();
            assert_eq!(bits(&sum(&reversed)), bits(&whole));
            let (first, second) = terms.split_at((random.get_1d() * count as f32) as usize);
            let mut merged = sum(second);
            merged.merge(&sum(first));
            assert_eq!(bits(&merged), bits(&whole));
            assert_eq!(whole.units(0, 0), terms.iter().map(|&term| units(term)).sum::<i128>());
            let magnitude: f64 = terms.iter().map(|x| x.abs()).sum();
            let error = (number(&whole) - terms.iter().sum::<f64>()).abs();
            assert!(error <= 1e-14 * magnitude + count as f64 * 2f64.powi(-65));
        }
    }
}
