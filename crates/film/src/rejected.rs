//! Samples that a film refuses.

use std::collections::BTreeSet;
use std::fmt;

/// The most pixels that [`Rejected`] lists.
pub const MAX_REJECTED_PIXELS: usize = 16;

/// The samples that a film refused.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rejected {
    /// Their number.
    pub count: u64,
    /// The pixels, as (row, column), of at most [`MAX_REJECTED_PIXELS`] of them: the first ones in
    /// reading order.
    pixels: BTreeSet<(i32, i32)>,
}

impl Rejected {
    /// `count` refused samples, some of them at these pixels.
    pub(crate) fn new(count: u64, pixels: impl IntoIterator<Item = [i32; 2]>) -> Self {
        let mut rejected = Self { count, ..Self::default() };
        pixels.into_iter().for_each(|[x, y]| rejected.remember(y, x));
        rejected
    }

    pub(crate) fn add(&mut self, [x, y]: [i32; 2]) {
        self.count += 1;
        self.remember(y, x);
    }

    fn remember(&mut self, row: i32, column: i32) {
        self.pixels.insert((row, column));
        if self.pixels.len() > MAX_REJECTED_PIXELS {
            self.pixels.pop_last();
        }
    }

    /// Adds those of another film.
    pub fn merge(&mut self, other: &Self) {
        self.count = self.count.saturating_add(other.count);
        other.pixels.iter().for_each(|&(row, column)| self.remember(row, column));
    }

    /// Their pixels in reading order, at most [`MAX_REJECTED_PIXELS`].
    pub fn pixels(&self) -> impl Iterator<Item = [i32; 2]> + '_ {
        self.pixels.iter().map(|&(y, x)| [x, y])
    }
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pixels: Vec<_> = self.pixels().map(|[x, y]| format!("{x},{y}")).collect();
        let first = if pixels.len() as u64 == self.count { "at" } else { "among them at" };
        let (count, pixels) = (self.count, pixels.join(" "));
        write!(f, "{count} samples were not finite and are left out, {first} {pixels}")
    }
}
