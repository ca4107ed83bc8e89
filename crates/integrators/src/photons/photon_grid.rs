//! A hash grid of photons, for queries within a fixed radius.
//!
//! Space is divided into cubic cells a little more than twice as wide as the radius r, so that the
//! photons near a point lie in two cells along each axis, eight in all. The grid is unbounded:
//! cells are hashed to as many buckets as there are photons. The photons are sorted by bucket, and
//! a table holds the start of each bucket; a query reads a few short ranges of these two arrays.
//! Photons of other cells in the same bucket are rejected by distance, and a bucket that two of the
//! eight cells share is read once.
//!
//! Within a bucket the order of the photons is kept, so that the sums of a query do not depend on
//! threads.

use math::Point3;
use rayon::prelude::*;

use crate::bidirectional::LightVertex;

/// Photons in the order of the grid's buckets.
#[derive(Clone, Debug)]
pub(crate) struct PhotonGrid {
    radius: f32,
    cells_per_length: f32,
    photons: Vec<LightVertex>,
    /// The index of each bucket's first photon, and at the end the number of photons.
    starts: Vec<u32>,
}

/// A little more than 1, to cover rounding errors.
const MARGIN: f32 = 1.000_001;

impl PhotonGrid {
    /// Builds the grid for queries within `radius`, above 0.
    pub fn new(photons: Vec<LightVertex>, radius: f32) -> Self {
        let buckets = photons.len().next_power_of_two();
        let cells_per_length = 0.5 / (radius * MARGIN * MARGIN);
        let grid = Self { radius, cells_per_length, photons: Vec::new(), starts: vec![0; buckets + 1] };
        let key = |(i, photon): (usize, &LightVertex)| {
            (grid.bucket(photon.p.to_array().map(|x| grid.cell(x))) as u64) << 32 | i as u64
        };
        let mut keys: Vec<u64> = photons.par_iter().enumerate().map(key).collect();
        keys.par_sort_unstable();
        let mut starts = grid.starts;
        let mut begun = 0;
        for (place, key) in keys.iter().enumerate() {
            let bucket = (key >> 32) as usize;
            while begun <= bucket {
                starts[begun] = place as u32;
                begun += 1;
            }
        }
        starts[begun..].fill(keys.len() as u32);
        let photons = keys.par_iter().map(|&key| photons[key as u32 as usize]).collect();
        Self { radius, cells_per_length, photons, starts }
    }

    /// The number of photons.
    pub fn len(&self) -> usize {
        self.photons.len()
    }

    /// Memory taken, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.photons) + size_of_val(&*self.starts)
    }

    /// Visits the photons whose distance from `p` is at most the radius.
    #[inline]
    pub fn within(&self, p: Point3, mut visit: impl FnMut(&LightVertex)) {
        let range = p.to_array().map(|x| {
            let reach = self.radius * MARGIN;
            (self.cell(x - reach), self.cell(x + reach))
        });
        let [(x0, x1), (y0, y1), (z0, z1)] = range;
        // Two cells along an axis; three only by rounding.
        let mut seen = [u32::MAX; 27];
        let mut count = 0;
        for z in z0..=z1 {
            for y in y0..=y1 {
                for x in x0..=x1 {
                    let bucket = self.bucket([x, y, z]);
                    if count == seen.len() || seen[..count].contains(&bucket) {
                        continue;
                    }
                    seen[count] = bucket;
                    count += 1;
                    let bucket = bucket as usize;
                    let (start, end) = (self.starts[bucket] as usize, self.starts[bucket + 1] as usize);
                    for photon in &self.photons[start..end] {
                        if photon.p.distance_squared(p) <= self.radius * self.radius {
                            visit(photon);
                        }
                    }
                }
            }
        }
    }

    /// The cell of a coordinate, clamped to the range of `i32`.
    fn cell(&self, x: f32) -> i32 {
        (x * self.cells_per_length).floor() as i32
    }

    fn bucket(&self, [x, y, z]: [i32; 3]) -> u32 {
        let mixed = (x as u32).wrapping_mul(0x8da6_b343)
            ^ (y as u32).wrapping_mul(0xd816_3841)
            ^ (z as u32).wrapping_mul(0xcb1a_b31f);
        let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d);
        (mixed ^ mixed >> 16) & (self.starts.len() as u32 - 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bidirectional::Partial;
    use math::Vector3;
    use spectrum::SampledSpectrum;
    use testkit::Random;

    /// Photons at these positions, identified by their depth.
    fn photons(places: &[Point3]) -> Vec<LightVertex> {
        let photon = |(i, &p): (usize, &Point3)| LightVertex {
            p,
            wo: Vector3::Z,
            cos_theta: 1.0,
            beta: SampledSpectrum::ONE,
            partial: Partial::default(),
            light: 0,
            depth: i as u16,
            hero_only: false,
            is_in_medium: false,
        };
        places.iter().enumerate().map(photon).collect()
    }

    /// Asserts that all queries find the same photons as brute force, each once.
    fn assert_all_are_found(places: &[Point3], queries: &[Point3], radius: f32) {
        let grid = PhotonGrid::new(photons(places), radius);
        assert_eq!(grid.len(), places.len());
        for &p in queries {
            let mut found = Vec::new();
            grid.within(p, |photon| found.push(usize::from(photon.depth)));
            found.sort_unstable();
            let near = |i: &usize| places[*i].distance_squared(p) <= radius * radius;
            let expected: Vec<_> = (0..places.len()).filter(near).collect();
            assert_eq!(found, expected, "around {p} within {radius}");
        }
    }

    #[test]
    fn queries_find_the_same_photons_as_brute_force() {
        let mut random = Random::new(1);
        for (count, size, offset) in [
            (0, 1.0, 0.0),
            (1, 1.0, 0.0),
            (500, 1.0, 0.0),
            (3000, 10.0, -3.0),
            (500, 2.0, 1e4),
            (300, 9.0, 3e7),
        ] {
            let mut place = |_| Point3::from_array([0; 3].map(|_| size * random.get_1d() + offset));
            let places: Vec<_> = (0..count).map(&mut place).collect();
            let queries: Vec<_> = (0..200).map(place).chain(places.iter().copied().take(200)).collect();
            for radius in [1e-3, 0.1, 1.0, 30.0] {
                assert_all_are_found(&places, &queries, radius);
            }
        }
    }

    #[test]
    fn positions_on_cell_borders_and_out_of_range_are_found() {
        let odd = [0.0, -0.0, 1.0, -1.0, 2.0, 4.0, 1e-40, 1e9, -1e30, f32::MAX, f32::INFINITY, f32::NAN];
        let places: Vec<_> = odd.iter().flat_map(|&x| odd.map(|y| Point3::new(x, y, 1.0))).collect();
        for radius in [f32::MIN_POSITIVE, 1e-20, 0.5, 1.0, 2.0, 1e18] {
            assert_all_are_found(&places, &places, radius);
        }
    }

    #[test]
    fn photons_at_one_position_keep_their_order() {
        let grid = PhotonGrid::new(photons(&[Point3::ONE; 100]), 0.1);
        let mut found = Vec::new();
        grid.within(Point3::ONE, |photon| found.push(photon.depth));
        assert!(found.len() == 100 && found.is_sorted());
        assert_eq!(size_of::<LightVertex>(), 64);
        assert_eq!(grid.bytes(), 100 * 64 + 129 * 4);
    }
}
