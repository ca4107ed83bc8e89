//! The lie of the land about the pond of the forest.

use math::Vec3;

use super::noise::fbm;

/// The pond: half its extent.
pub const POND: [f32; 2] = [15.0, 10.5];

/// How far a point is outside the shore of the pond: 0 in its middle, 1 at the shore.
pub fn shore(x: f32, y: f32) -> f32 {
    let round = (x / POND[0]).hypot(y / POND[1]);
    round + 0.22 * fbm(0.16 * x + 40.0, 0.16 * y, 3)
}

/// Height of the ground in metres over the water.
pub fn height(x: f32, y: f32) -> f32 {
    let s = shore(x, y);
    let bed = -1.5 * (1.0 - s * s).max(0.0);
    let bank = (s - 1.0).clamp(0.0, 1.0);
    let hills = 0.5 + 0.9 * fbm(0.07 * x, 0.07 * y, 4) + 0.05 * fbm(1.3 * x, 1.3 * y, 3);
    bed + bank * (hills + 0.3 * (s - 1.0) * (s - 1.0)).max(0.08)
}

/// The normal of the ground.
pub fn slope(x: f32, y: f32) -> Vec3 {
    const STEP: f32 = 0.05;
    let dx = (height(x + STEP, y) - height(x - STEP, y)) / (2.0 * STEP);
    let dy = (height(x, y + STEP) - height(x, y - STEP)) / (2.0 * STEP);
    Vec3::new(-dx, -dy, 1.0).normalize()
}
