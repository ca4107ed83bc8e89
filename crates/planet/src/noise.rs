//! Noise in space, of which the land is made.

use math::Vec3;

/// A number in [−1, 1] for a point of the lattice.
fn lattice(x: i32, y: i32, z: i32) -> f32 {
    let hashed = sampling::hash(&[x as u32, y as u32, z as u32]);
    (hashed >> 40) as f32 / (1 << 23) as f32 - 1.0
}

/// Numbers of the lattice, interpolated smoothly.
fn value(p: Vec3) -> f32 {
    let corner = p.map(f32::floor);
    let [u, v, w] = (p - corner).map(|t| t * t * t * (t * (6.0 * t - 15.0) + 10.0)).to_array();
    let [i, j, k] = corner.to_array().map(|x| x as i32);
    let along = |b: i32, c: i32| {
        let (low, high) = (lattice(i, j + b, k + c), lattice(i + 1, j + b, k + c));
        low + u * (high - low)
    };
    let plane = |c: i32| {
        let (low, high) = (along(0, c), along(1, c));
        low + v * (high - low)
    };
    let (low, high) = (plane(0), plane(1));
    low + w * (high - low)
}

/// A sum of octaves of noise, about in [−1, 1].
pub fn fbm(p: Vec3, octaves: u32) -> f32 {
    let sum = |(sum, scale): (f32, f32), octave: u32| {
        let shift = Vec3::splat(17.3 * octave as f32);
        (sum + value(p * scale + shift) / scale, 2.0 * scale)
    };
    0.8 * (0..octaves).fold((0.0, 1.0), sum).0
}
