//! Elementary functions of each lane, by those of the standard library, so that their bits do not
//! depend on the number of lanes.

use lanes::Real;

/// `f` of each lane.
#[inline(always)]
pub fn map_lanes<R: Real>(x: R, f: impl Fn(f32) -> f32) -> R {
    let lanes = x.to_array();
    R::from_fn(|lane| f(lanes[lane]))
}

/// Sine and cosine of an angle in radians.
#[inline(always)]
pub fn sin_cos<R: Real>(x: R) -> (R, R) {
    (map_lanes(x, f32::sin), map_lanes(x, f32::cos))
}

/// eˣ.
#[inline(always)]
pub fn exp<R: Real>(x: R) -> R {
    map_lanes(x, f32::exp)
}

/// The natural logarithm.
#[inline(always)]
pub fn ln<R: Real>(x: R) -> R {
    map_lanes(x, f32::ln)
}
