//! Square pictures of formulas, in the format PFM.

use math::{Vec2, Vec3, equal_area_square_to_sphere};

/// A picture of the colours at positions in [0, 1]², where v goes up.
pub fn square(size: u32, colour: impl Fn(Vec2) -> Vec3) -> Vec<u8> {
    pfm(size, 0..size, colour)
}

/// A picture over the sphere, of the colours in directions.
pub fn sphere(size: u32, colour: impl Fn(Vec3) -> Vec3) -> Vec<u8> {
    pfm(size, (0..size).rev(), |uv| colour(equal_area_square_to_sphere(uv)))
}

fn pfm(size: u32, rows: impl Iterator<Item = u32>, colour: impl Fn(Vec2) -> Vec3) -> Vec<u8> {
    let mut file = format!("PF\n{size} {size}\n-1.0\n").into_bytes();
    for y in rows {
        for x in 0..size {
            let uv = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / size as f32;
            colour(uv).to_array().into_iter().for_each(|v| file.extend(v.to_le_bytes()));
        }
    }
    file
}
