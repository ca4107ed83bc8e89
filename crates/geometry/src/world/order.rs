//! In which order to trace many rays, so that those which pass the same nodes follow each other
//! while these are at hand.
//!
//! Rays are sorted along a Z-order curve through their origins [Morton 1966], digit by digit, the
//! last one first. Sorted by direction first, they would have fewer nodes in common.

use math::{Bounds3, Ray};

/// Fewer rays have too few nodes in common to make up for the sorting.
const ENOUGH: usize = 1 << 14;

/// Rays follow each other closely when the mean distance from one origin to the next is below this
/// part of the size of all.
const CLOSE: f32 = 1.0 / 32.0;

/// Cells of the curve along each axis, as a power of two.
const BITS: u32 = 7;
/// Bits of a digit, two of which hold a cell's place on the curve.
const DIGIT: u32 = 11;
/// Where that place begins in a key; the index of the ray lies below.
const CURVE: u32 = 64 - 2 * DIGIT;

/// The indices of all rays, those first that come first on the curve; nothing where rays are few,
/// or follow each other closely as they are.
pub(super) fn order(rays: &[(Ray, f32)]) -> Option<Vec<usize>> {
    if rays.len() < ENOUGH {
        return None;
    }
    let mut bounds = Bounds3::EMPTY;
    let mut way = 0.0;
    let mut last = rays[0].0.o;
    for (ray, _) in rays.iter().filter(|(ray, _)| ray.o.is_finite()) {
        bounds = bounds.union(Bounds3::around([ray.o]));
        way += ray.o.distance(last);
        last = ray.o;
    }
    let size = (bounds.max - bounds.min).max_element();
    if way <= rays.len() as f32 * CLOSE * size {
        return None;
    }
    let most = (1 << BITS) - 1;
    let scale = most as f32 / size;
    let key = |(index, (ray, _)): (u64, &(Ray, f32))| {
        // What is no number becomes nothing.
        let [x, y, z] = ((ray.o - bounds.min) * scale).to_array().map(|x| spread((x as u32).min(most)));
        u64::from(x | y << 1 | z << 2) << CURVE | index
    };
    let mut keys: Vec<u64> = (0..).zip(rays).map(key).collect();
    let mut sorted = vec![0; keys.len()];
    for digit in 0..2 {
        sort_by_digit(&keys, CURVE + digit * DIGIT, &mut sorted);
        std::mem::swap(&mut keys, &mut sorted);
    }
    Some(keys.into_iter().map(|key| (key % (1 << CURVE)) as usize).collect())
}

/// Sorts by the bits from `shift` on.
fn sort_by_digit(keys: &[u64], shift: u32, sorted: &mut [u64]) {
    let digit = |key: u64| (key >> shift) as usize % (1 << DIGIT);
    let mut places = [0; 1 << DIGIT];
    for &key in keys {
        places[digit(key)] += 1;
    }
    let mut before = 0;
    for place in &mut places {
        before += std::mem::replace(place, before);
    }
    for &key in keys {
        let place = &mut places[digit(key)];
        sorted[*place] = key;
        *place += 1;
    }
}

/// Puts two zeros before each of the last ten bits.
fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x030000ff;
    let x = (x | x << 8) & 0x0300f00f;
    let x = (x | x << 4) & 0x030c30c3;
    (x | x << 2) & 0x09249249
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Vec3;

    fn rays(n: usize, origin: impl Fn(usize) -> Vec3) -> Vec<(Ray, f32)> {
        (0..n).map(|i| (Ray::new(origin(i), Vec3::X, 0.0), f32::INFINITY)).collect()
    }

    /// Golden angles and ratios jump about.
    fn scattered(i: usize) -> Vec3 {
        let i = i as f32;
        Vec3::new((0.618_034 * i).fract(), (0.754_878 * i).fract(), (0.569_84 * i).fract())
    }

    #[test]
    fn scattered_rays_come_once_each_and_nearer_to_the_next() {
        let rays = rays(ENOUGH, scattered);
        let order = order(&rays).expect("an order");
        let way = |order: &[usize]| -> f32 {
            order.windows(2).map(|pair| rays[pair[0]].0.o.distance(rays[pair[1]].0.o)).sum()
        };
        let as_given: Vec<usize> = (0..ENOUGH).collect();
        assert!(way(&order) < 0.2 * way(&as_given));
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, as_given);
    }

    #[test]
    fn few_rays_and_rays_that_follow_each_other_stay_as_they_are() {
        assert!(order(&[]).is_none());
        assert!(order(&rays(ENOUGH - 1, scattered)).is_none());
        assert!(order(&rays(ENOUGH, |i| Vec3::splat(i as f32))).is_none());
        assert!(order(&rays(ENOUGH, |_| Vec3::ONE)).is_none());
    }

    #[test]
    fn origins_that_are_no_numbers_have_a_place() {
        let odd = |i: usize| {
            if i.is_multiple_of(3) { Vec3::NAN } else { scattered(i) * [1.0, f32::INFINITY][i % 2] }
        };
        let mut order = order(&rays(ENOUGH, odd)).expect("an order");
        order.sort_unstable();
        assert!(order.into_iter().eq(0..ENOUGH));
    }
}
