//! Functions of each lane by one for a single float.

use lanes::Real;

/// `f` of each lane.
#[inline(always)]
pub fn map_lanes<R: Real>(x: R, f: impl Fn(f32) -> f32) -> R {
    let lanes = x.to_array();
    R::from_fn(|lane| f(lanes[lane]))
}
