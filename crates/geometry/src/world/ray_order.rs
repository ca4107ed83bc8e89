//! The order in which to trace many scattered rays, so that rays that visit the same nodes are
//! traced one after another while these are in the cache.
//!
//! Rays are sorted along a Z-order curve through their origins [Morton 1966] by a radix sort.
//! Sorted by direction first, consecutive rays would share fewer nodes.

use super::columns::RayColumns;
use math::{Bounds3, Vec3};

/// Fewer rays share too few nodes to make up for the sort.
const MIN_RAYS: usize = 1 << 14;

/// Rays are coherent as given where the mean distance between consecutive origins is below this
/// fraction of the extent of all origins.
const COHERENT: f32 = 1.0 / 32.0;

/// Bits of a cell of the curve along each axis.
const BITS: u32 = 7;
/// Bits of a digit of the sort; a cell's code has two.
const DIGIT: u32 = 11;
/// The lowest bit of the code in a key; the index of the ray is below.
const CODE: u32 = 64 - 2 * DIGIT;

/// The indices of all rays in the order of the curve; `None` where rays are few, or coherent as
/// given.
pub(super) fn coherent_order(rays: &RayColumns) -> Option<Vec<usize>> {
    if rays.len() < MIN_RAYS {
        return None;
    }
    let mut bounds = Bounds3::EMPTY;
    let mut path_length = 0.0;
    let origins = || (0..rays.len()).map(|place| rays.ray(place).o);
    let mut last = rays.ray(0).o;
    for o in origins().filter(|o| o.is_finite()) {
        bounds = bounds.union(Bounds3::around([o]));
        path_length += o.distance(last);
        last = o;
    }
    let size = (bounds.max - bounds.min).max_element();
    if path_length <= rays.len() as f32 * COHERENT * size {
        return None;
    }
    let most = (1 << BITS) - 1;
    let scale = most as f32 / size;
    let key = |(index, o): (u64, Vec3)| {
        // The cast makes NaN zero.
        let [x, y, z] = ((o - bounds.min) * scale).to_array().map(|x| spread((x as u32).min(most)));
        u64::from(x | y << 1 | z << 2) << CODE | index
    };
    let mut keys: Vec<u64> = (0..).zip(origins()).map(key).collect();
    let mut sorted = vec![0; keys.len()];
    for digit in 0..2 {
        sort_by_digit(&keys, CODE + digit * DIGIT, &mut sorted);
        std::mem::swap(&mut keys, &mut sorted);
    }
    Some(keys.into_iter().map(|key| (key % (1 << CODE)) as usize).collect())
}

/// Sorts by the bits from `shift` on.
fn sort_by_digit(keys: &[u64], shift: u32, sorted: &mut [u64]) {
    let digit = |key: u64| (key >> shift) as usize % (1 << DIGIT);
    let mut offsets = [0; 1 << DIGIT];
    for &key in keys {
        offsets[digit(key)] += 1;
    }
    let mut before = 0;
    for offset in &mut offsets {
        before += std::mem::replace(offset, before);
    }
    for &key in keys {
        let offset = &mut offsets[digit(key)];
        sorted[*offset] = key;
        *offset += 1;
    }
}

/// Spreads the low ten bits to every third bit.
fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x030000ff;
    let x = (x | x << 8) & 0x0300f00f;
    let x = (x | x << 4) & 0x030c30c3;
    (x | x << 2) & 0x09249249
}

#[cfg(test)]
mod tests {
    use super::super::columns::RayBuffer;
    use super::*;
    use math::Ray;

    fn rays(n: usize, origin: impl Fn(usize) -> Vec3) -> RayBuffer {
        (0..n).map(|i| (Ray::new(origin(i), Vec3::X, 0.0), f32::INFINITY)).collect()
    }

    /// Quasi-random points, far from one to the next.
    fn scattered(i: usize) -> Vec3 {
        let i = i as f32;
        Vec3::new((0.618_034 * i).fract(), (0.754_878 * i).fract(), (0.569_84 * i).fract())
    }

    #[test]
    fn scattered_rays_are_reordered_once_each_with_neighbours_nearby() {
        let rays = rays(MIN_RAYS, scattered);
        let rays = rays.columns();
        let order = coherent_order(&rays).expect("an order");
        let way = |order: &[usize]| -> f32 {
            order.windows(2).map(|pair| rays.ray(pair[0]).o.distance(rays.ray(pair[1]).o)).sum()
        };
        let as_given: Vec<usize> = (0..MIN_RAYS).collect();
        assert!(way(&order) < 0.2 * way(&as_given));
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, as_given);
    }

    #[test]
    fn few_rays_and_coherent_rays_keep_their_order() {
        assert!(coherent_order(&rays(0, scattered).columns()).is_none());
        assert!(coherent_order(&rays(MIN_RAYS - 1, scattered).columns()).is_none());
        assert!(coherent_order(&rays(MIN_RAYS, |i| Vec3::splat(i as f32)).columns()).is_none());
        assert!(coherent_order(&rays(MIN_RAYS, |_| Vec3::ONE).columns()).is_none());
    }

    #[test]
    fn origins_that_are_not_finite_are_kept() {
        let odd = |i: usize| {
            if i.is_multiple_of(3) { Vec3::NAN } else { scattered(i) * [1.0, f32::INFINITY][i % 2] }
        };
        let mut order = coherent_order(&rays(MIN_RAYS, odd).columns()).expect("an order");
        order.sort_unstable();
        assert!(order.into_iter().eq(0..MIN_RAYS));
    }
}
