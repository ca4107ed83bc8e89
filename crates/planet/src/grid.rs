//! A grid of cells in space, in which spheres near a point are found.
//!
//! Columns of cells are hashed into a table, where their cells follow each other; so the spheres of
//! a range of cells of a column lie side by side in memory, in the order of cells and numbers.

use math::{Point3, Vec3};

/// The side of a cell in metres.
const CELL: f32 = 1.0;

/// A sphere in a grid.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub center: Point3,
    pub radius: f32,
    pub body: u32,
}

/// Spheres by the cells of their centres.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// Where the spheres of each row of the table begin; one more than rows.
    starts: Vec<u32>,
    entries: Vec<Entry>,
    /// The largest radius.
    largest: f32,
}

fn cell(p: Point3) -> [i32; 3] {
    (p * (1.0 / CELL)).to_array().map(|x| x.floor() as i32)
}

impl Grid {
    /// Replaces all spheres.
    pub fn rebuild(&mut self, spheres: &[Entry]) {
        let rows = (2 * spheres.len()).next_power_of_two().max(64);
        self.starts.clear();
        self.starts.resize(rows + 1, 0);
        let row = |entry: &Entry| row(cell(entry.center), rows);
        for entry in spheres {
            self.starts[row(entry) + 1] += 1;
        }
        for i in 0..rows {
            self.starts[i + 1] += self.starts[i];
        }
        self.entries.clear();
        self.entries.resize(spheres.len(), Entry { center: Vec3::ZERO, radius: 0.0, body: 0 });
        // Each row's begin counts up to its end, which is the begin of the next one.
        for entry in spheres {
            let next = &mut self.starts[row(entry)];
            self.entries[*next as usize] = *entry;
            *next += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
        self.largest = spheres.iter().map(|entry| entry.radius).fold(0.0, f32::max);
    }

    /// Calls `visit` with each sphere that may be within a distance of a point.
    #[inline]
    pub fn around(&self, p: Point3, distance: f32, mut visit: impl FnMut(&Entry)) {
        if self.entries.is_empty() {
            return;
        }
        let rows = self.starts.len() - 1;
        let reach = Vec3::splat(distance + self.largest);
        let (low, high) = (cell(p - reach), cell(p + reach));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                let first = row([x, y, low[2]], rows);
                // The first row of the table follows its last one.
                let last = first + ((high[2] - low[2]) as usize).min(rows - 1);
                let mut visit_rows = |first: usize, last: usize| {
                    let range = self.starts[first] as usize..self.starts[last + 1] as usize;
                    for entry in &self.entries[range] {
                        let limit = distance + entry.radius;
                        // Other columns may have the same rows.
                        if entry.center.distance_squared(p) <= limit * limit
                            && cell(entry.center)[..2] == [x, y]
                        {
                            visit(entry);
                        }
                    }
                };
                visit_rows(first, last.min(rows - 1));
                if last >= rows {
                    visit_rows(0, last - rows);
                }
            }
        }
    }
}

/// The row of a cell in a table whose size is a power of two.
#[inline]
fn row([x, y, z]: [i32; 3], rows: usize) -> usize {
    let mixed = (x as u32).wrapping_mul(0x8da6_b343) ^ (y as u32).wrapping_mul(0xd816_3841);
    (mixed ^ mixed >> 15).wrapping_add(z as u32) as usize & (rows - 1)
}
