//! Round dots in squares of a grid, about two of five, at random places.
//!
//! The grid's squares are centred at integers. One has a dot where the noise at its corner is
//! positive. The dot's radius is 0.35, and its centre deviates along each axis from that of the
//! square by 0.15 times another value of the noise, so that it stays within the square. Edges are
//! sharp, whatever the footprint.
//!
//! pbrt-v4 exchanges the textures `inside` and `outside`, so that the former is seen between the
//! dots. Pictures of the format depend on it, hence so does alhazen.
//!
//! Source: [Pharr 2016 §10.6.2].

use super::noise::noise;
use lanes::Real;
use math::{Point2, Vec2, Vec3};

/// The radius of a dot.
const RADIUS: f32 = 0.35;

/// 1 in a dot and 0 elsewhere.
#[inline(always)]
pub(super) fn coverage<R: Real>(st: Point2<R>) -> R {
    let half = R::splat(0.5);
    let cell = Vec2::new((st.x + half).floor(), (st.y + half).floor());
    // A loop, so that the code of the noise is there once.
    let mut random = [R::zero(); 3];
    for (value, [dx, dy]) in random.iter_mut().zip([[0.5, 0.5], [1.5, 2.8], [4.5, 9.8]]) {
        *value = noise(Vec3::new(cell.x + R::splat(dx), cell.y + R::splat(dy), half));
    }
    let [choice, x, y] = random;
    let center = cell + Vec2::new(x, y) * R::splat(0.5 - RADIUS);
    let is_inside = (st - center).length_squared().lt(R::splat(RADIUS * RADIUS));
    R::select(choice.gt(R::zero()) & is_inside, R::one(), R::zero())
}
