//! Colours of the skin.

use math::{Vec2, Vec3, smooth_step};

use super::hair::hairline;
use super::pores::lip;
use crate::noise::fbm;
use crate::picture;

/// The part of the front that the picture of colours shows: the extent of x and z.
const EXTENT: f32 = 260.0;

/// Coordinates of a point in the picture.
pub fn coordinates(p: Vec3) -> Vec2 {
    Vec2::new(p.x, p.z) / EXTENT + Vec2::new(0.5, 0.5)
}

/// The picture, in the format PFM.
pub fn colours(size: u32) -> Vec<u8> {
    picture::square(size, |uv| colour(EXTENT * (uv.x - 0.5), EXTENT * (uv.y - 0.5)))
}

fn colour(x: f32, z: f32) -> Vec3 {
    let side = x.abs();
    let spot = |at: [f32; 2], radii: [f32; 2]| {
        let distance = ((side - at[0]) / radii[0]).hypot((z - at[1]) / radii[1]);
        1.0 - smooth_step(distance, 0.0, 1.0)
    };
    let blotches = 1.0 + 0.07 * fbm(0.09 * x + 3.0, 0.09 * z, 3) + 0.04 * fbm(0.8 * x, 0.8 * z + 50.0, 2);
    let mut colour = Vec3::new(0.76, 0.53, 0.42) * blotches;
    // Blood under the cheeks, the tip of the nose and the chin; thin skin under the eyes.
    let blood = 0.75 * spot([40.0, -34.0], [30.0, 28.0])
        + 0.8 * spot([0.0, -41.0], [20.0, 20.0])
        + 0.35 * spot([0.0, -104.0], [24.0, 18.0])
        + 0.5 * spot([78.0, -18.0], [12.0, 42.0]);
    colour *= Vec3::ONE - Vec3::new(0.02, 0.17, 0.16) * (blood * (1.0 + 0.8 * (blotches - 1.0)));
    colour *= Vec3::ONE - Vec3::new(0.12, 0.17, 0.13) * spot([31.0, -8.0], [20.0, 13.0]);
    colour *= Vec3::ONE - Vec3::new(0.09, 0.14, 0.12) * spot([31.0, 7.0], [20.0, 11.0]);
    let lips = lip(Vec3::new(x, 90.0, z));
    colour = colour.lerp(Vec3::new(0.62, 0.27, 0.24) * blotches, 0.8 * lips);
    // Roots of hair show through.
    colour * (1.0 - 0.35 * smooth_step(z - hairline(0.0) - 0.01 * side * side, -4.0, 10.0))
}
