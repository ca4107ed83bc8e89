//! Sets of passes: the part of a render that is done.

use std::fmt;
use std::ops::Range;

/// A set of passes, kept as sorted ranges that neither overlap nor touch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PassSet {
    ranges: Vec<Range<u32>>,
}

impl PassSet {
    /// The empty set.
    pub fn new() -> Self {
        Self::default()
    }

    /// The set of these ranges; `None` if they are not sorted, or if some are empty, overlap or
    /// touch.
    pub(crate) fn from_sorted(ranges: Vec<Range<u32>>) -> Option<Self> {
        let apart = ranges.windows(2).all(|pair| pair[0].end < pair[1].start);
        (apart && ranges.iter().all(|range| range.start < range.end)).then_some(Self { ranges })
    }

    /// The ranges, in order.
    pub fn ranges(&self) -> &[Range<u32>] {
        &self.ranges
    }

    /// The number of passes in the set.
    pub fn count(&self) -> u32 {
        self.ranges.iter().map(|range| range.end - range.start).sum()
    }

    /// Whether the set has no pass.
    pub fn is_empty(&self) -> bool {
        self.ranges.is_empty()
    }

    /// Whether the set has this pass.
    pub fn contains(&self, pass: u32) -> bool {
        self.ranges.iter().any(|range| range.contains(&pass))
    }

    /// Adds the passes of a range.
    pub fn insert(&mut self, range: Range<u32>) {
        if range.is_empty() {
            return;
        }
        let first = self.ranges.partition_point(|other| other.end < range.start);
        let last = self.ranges.partition_point(|other| other.start <= range.end);
        let merged = self.ranges[first..last]
            .iter()
            .fold(range, |sum, other| sum.start.min(other.start)..sum.end.max(other.end));
        self.ranges.splice(first..last, [merged]);
    }

    /// The passes that are in either set.
    pub fn union(&self, other: &Self) -> Self {
        let mut union = self.clone();
        other.ranges.iter().for_each(|range| union.insert(range.clone()));
        union
    }

    /// The passes that are in both sets.
    pub fn intersection(&self, other: &Self) -> Self {
        let mut both = Self::new();
        for a in &self.ranges {
            for b in &other.ranges {
                both.insert(a.start.max(b.start)..a.end.min(b.end));
            }
        }
        both
    }

    /// The passes below `planned` that are not in the set.
    pub fn missing(&self, planned: u32) -> Self {
        let mut missing = Self::new();
        let mut next = 0;
        for range in &self.ranges {
            missing.insert(next..range.start.min(planned));
            next = range.end;
        }
        missing.insert(next..planned);
        missing
    }
}

impl From<Range<u32>> for PassSet {
    fn from(range: Range<u32>) -> Self {
        let mut set = Self::new();
        set.insert(range);
        set
    }
}

/// First and last pass of each range: "0-31, 40".
impl fmt::Display for PassSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, range) in self.ranges.iter().enumerate() {
            let comma = if index > 0 { ", " } else { "" };
            match range.end - 1 {
                last if last == range.start => write!(f, "{comma}{last}")?,
                last => write!(f, "{comma}{}-{last}", range.start)?,
            }
        }
        if self.is_empty() { f.write_str("none") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Random;

    #[test]
    fn agrees_with_a_bit_set() {
        const PASSES: u32 = 64;
        let mut random = Random::new(3);
        let mut number = |below: u32| (random.get_1d() * below as f32) as u32;
        for _ in 0..200 {
            let mut pair = [(); 2].map(|()| (PassSet::new(), 0u64));
            for (set, bits) in &mut pair {
                for _ in 0..number(8) {
                    let start = number(PASSES);
                    let end = start + number(8.min(PASSES - start + 1));
                    set.insert(start..end);
                    (start..end).for_each(|pass| *bits |= 1 << pass);
                }
            }
            let [(a, a_bits), (b, b_bits)] = pair;
            for (set, bits) in [
                (a.clone(), a_bits),
                (a.union(&b), a_bits | b_bits),
                (a.intersection(&b), a_bits & b_bits),
                (a.missing(PASSES), !a_bits),
                (a.missing(16), !a_bits & 0xffff),
            ] {
                assert!((0..PASSES).all(|pass| set.contains(pass) == (bits >> pass & 1 == 1)));
                assert_eq!(set.count(), bits.count_ones());
                assert_eq!(set.is_empty(), bits == 0);
                assert_eq!(PassSet::from_sorted(set.ranges.clone()), Some(set), "one form for each set");
            }
        }
    }

    #[test]
    fn ranges_that_are_out_of_order_touch_or_are_empty_are_no_set() {
        for ranges in [[4..5, 0..1], [0..2, 2..3], [0..3, 1..4], [1..2, 3..3]] {
            assert_eq!(PassSet::from_sorted(ranges.to_vec()), None);
        }
    }

    #[test]
    fn is_shown_as_first_and_last_passes() {
        let mut set = PassSet::from(0..32);
        set.insert(40..41);
        assert_eq!(set.to_string(), "0-31, 40");
        assert_eq!(PassSet::new().to_string(), "none");
    }
}
