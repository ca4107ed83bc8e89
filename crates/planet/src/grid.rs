//! A grid of cells in space, in which spheres near a point are found.
//!
//! Space repeats after a number of cells along each axis, which is a table of cells. The spheres of
//! a range of cells along z lie side by side in columns of memory, in the order of cells and
//! numbers, so that as many are tested at once as there are lanes; neighbouring ranges are not far
//! from there.

use lanes::{Each, Int, Kernel, MAX_LANES, Mask, Real};
use math::{Point3, Vec3};

/// The side of a cell in metres.
const CELL: f32 = 2.0;

/// The numbers of lanes.
const LANES: [u32; MAX_LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

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
    /// The centres, and the reach; more than spheres, so that the last ones can be loaded at once.
    columns: [Vec<f32>; 4],
    radius: Vec<f32>,
    bodies: Vec<u32>,
    /// The largest reach.
    largest: f32,
}

/// A point, and the distance within which spheres are looked for.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    pub point: Point3,
    pub distance: f32,
}

/// The spheres of a grid whose reach is within the distance of each of some points.
pub struct Near<'a> {
    pub grid: &'a Grid,
    pub queries: &'a [Query],
}

/// The places of spheres in a grid, those of each query one after another.
#[derive(Debug)]
pub struct Found {
    places: Vec<u32>,
    ends: Vec<u32>,
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
        let places: Vec<u32> =
            spheres.iter().map(|entry| place(cell(entry.center), self.bits) as u32).collect();
        for &place in &places {
            self.starts[place as usize + 1] += 1;
        }
        for i in 0..cells {
            self.starts[i + 1] += self.starts[i];
        }
        self.columns.iter_mut().for_each(|column| column.resize(spheres.len() + MAX_LANES, 0.0));
        self.radius.resize(spheres.len(), 0.0);
        self.bodies.resize(spheres.len(), 0);
        // Each row's begin counts up to its end, which is the begin of the next one.
        for (entry, &place) in spheres.iter().zip(&places) {
            let next = &mut self.starts[place as usize];
            let (at, [x, y, z]) = (*next as usize, entry.center.to_array());
            for (column, number) in self.columns.iter_mut().zip([x, y, z, entry.reach]) {
                column[at] = number;
            }
            (self.radius[at], self.bodies[at]) = (entry.radius, entry.body);
            *next += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
        self.largest = spheres.iter().map(|entry| entry.reach).fold(0.0, f32::max);
    }

    /// The sphere at a place.
    #[inline]
    pub fn entry(&self, place: u32) -> Entry {
        let place = place as usize;
        let [x, y, z, reach] = [0, 1, 2, 3].each(|axis: usize| self.columns[axis][place]);
        Entry { center: Vec3::new(x, y, z), radius: self.radius[place], reach, body: self.bodies[place] }
    }

    /// Calls `visit` with each sphere whose reach is within a distance of a point.
    pub fn around(&self, point: Point3, distance: f32, visit: impl FnMut(Entry)) {
        let mut places = Vec::new();
        self.append_near::<f32>(Query { point, distance }, &mut places);
        places.into_iter().map(|place| self.entry(place)).for_each(visit);
    }

    #[inline(always)]
    fn append_near<R: Real>(&self, query: Query, places: &mut Vec<u32>) {
        if self.bodies.is_empty() {
            return;
        }
        let Query { point, distance } = query;
        let reach = Vec3::splat(distance + self.largest);
        let (low, high) = (cell(point - reach), cell(point + reach));
        let end = (1 << self.bits[2]) - 1;
        let (center, distance) = (Vec3::from_array(point.to_array().each(R::splat)), R::splat(distance));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                let column = place([x, y, 0], self.bits);
                let first = low[2] as usize & end;
                let last = first + ((high[2] - low[2]) as usize).min(end);
                let again = (last + 1).saturating_sub(end + 1);
                for [first, last] in [[first, last.min(end) + 1], [0, again]] {
                    let [begin, end] = [first, last].each(|cell| self.starts[column + cell] as usize);
                    for i in (begin..end).step_by(R::LANES) {
                        let [px, py, pz, reach] =
                            [0, 1, 2, 3].each(|axis: usize| R::load(&self.columns[axis][i..]));
                        let limit = distance + reach;
                        let is_near = Vec3::new(px, py, pz).distance_squared(center).le(limit * limit);
                        let remaining = (1u64 << (end - i).min(MAX_LANES)) - 1;
                        // Cells far away have the same place.
                        let is_here = (px * R::splat(1.0 / CELL)).floor().eq(R::splat(x as f32))
                            & (py * R::splat(1.0 / CELL)).floor().eq(R::splat(y as f32));
                        let is_found = is_near & is_here & R::Mask::from_bits(remaining as u32);
                        if is_found.any() {
                            let place = R::Int::splat(i as u32).wrapping_add(R::Int::load(&LANES));
                            place.append(is_found, places);
                        }
                    }
                }
            }
        }
    }
}

impl Kernel for Near<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<R: Real>(self) -> Found {
        let count = self.queries.len();
        let (places, ends) = (Vec::with_capacity(8 * count), Vec::with_capacity(count));
        let mut found = Found { places, ends };
        for &query in self.queries {
            self.grid.append_near::<R>(query, &mut found.places);
            found.ends.push(found.places.len() as u32);
        }
        found
    }
}

impl Found {
    /// The places of a query.
    pub fn of(&self, query: usize) -> &[u32] {
        let begin = query.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.places[begin as usize..self.ends[query] as usize]
    }
}

/// The place of a cell in a table with this many bits for each axis.
#[inline]
fn place([x, y, z]: [i32; 3], bits: [u32; 3]) -> usize {
    let low = |x: i32, bits: u32| x as usize & ((1 << bits) - 1);
    (low(x, bits[0]) << bits[1] | low(y, bits[1])) << bits[2] | low(z, bits[2])
}
