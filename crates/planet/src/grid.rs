//! A grid of cells in space, in which spheres near a point are found.
//!
//! Space repeats after a number of cells along each axis, which is a table of cells. The spheres of
//! a range of cells along z lie side by side in memory, in the order of cells and numbers, and
//! neighbouring ranges are not far from there.

use math::{Point3, Vec3};

/// The side of a cell in metres.
const CELL: f32 = 1.0;

/// A sphere in a grid.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub center: Point3,
    pub radius: f32,
    /// The distance from its centre within which it is found: its radius, or more where it moves.
    pub reach: f32,
    pub body: u32,
}

/// Spheres by the cells of their centres.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// How many cells there are along each axis before they repeat, as powers of two.
    bits: [u32; 3],
    /// Where the spheres of each cell of the table begin; one more than cells.
    starts: Vec<u32>,
    entries: Vec<Entry>,
    /// The largest reach.
    largest: f32,
}

fn cell(p: Point3) -> [i32; 3] {
    (p * (1.0 / CELL)).to_array().map(|x| x.floor() as i32)
}

impl Grid {
    /// Replaces all spheres.
    pub fn rebuild(&mut self, spheres: &[Entry]) {
        let cells = (2 * spheres.len()).next_power_of_two().max(64);
        self.bits = [0, 1, 2].map(|axis| (cells.ilog2() + axis) / 3);
        self.starts.clear();
        self.starts.resize(cells + 1, 0);
        let bits = self.bits;
        let place_of = |entry: &Entry| place(cell(entry.center), bits);
        for entry in spheres {
            self.starts[place_of(entry) + 1] += 1;
        }
        for i in 0..cells {
            self.starts[i + 1] += self.starts[i];
        }
        self.entries.clear();
        self.entries.resize(spheres.len(), Entry { center: Vec3::ZERO, radius: 0.0, reach: 0.0, body: 0 });
        // Each row's begin counts up to its end, which is the begin of the next one.
        for entry in spheres {
            let next = &mut self.starts[place_of(entry)];
            self.entries[*next as usize] = *entry;
            *next += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
        self.largest = spheres.iter().map(|entry| entry.reach).fold(0.0, f32::max);
    }

    /// Calls `visit` with each sphere whose reach is within a distance of a point.
    #[inline]
    pub fn around(&self, p: Point3, distance: f32, mut visit: impl FnMut(&Entry)) {
        if self.entries.is_empty() {
            return;
        }
        let reach = Vec3::splat(distance + self.largest);
        let (low, high) = (cell(p - reach), cell(p + reach));
        let end = (1 << self.bits[2]) - 1;
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                let column = place([x, y, 0], self.bits);
                let first = low[2] as usize & end;
                let last = first + ((high[2] - low[2]) as usize).min(end);
                let mut visit_cells = |first: usize, last: usize| {
                    let range = self.starts[column + first] as usize..self.starts[column + last + 1] as usize;
                    for entry in &self.entries[range] {
                        let limit = distance + entry.reach;
                        // Cells far away have the same place.
                        if entry.center.distance_squared(p) <= limit * limit
                            && cell(entry.center)[..2] == [x, y]
                        {
                            visit(entry);
                        }
                    }
                };
                visit_cells(first, last.min(end));
                if last > end {
                    visit_cells(0, last - end - 1);
                }
            }
        }
    }
}

/// The place of a cell in a table with this many bits for each axis.
#[inline]
fn place([x, y, z]: [i32; 3], bits: [u32; 3]) -> usize {
    let low = |x: i32, bits: u32| x as usize & ((1 << bits) - 1);
    (low(x, bits[0]) << bits[1] | low(y, bits[1])) << bits[2] | low(z, bits[2])
}
