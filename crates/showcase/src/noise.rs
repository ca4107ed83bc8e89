//! Noise over the plane for the shapes of ground and clouds.

/// A number in [−1, 1] for a point of the lattice.
fn lattice(x: i32, y: i32) -> f32 {
    let hashed = sampling::hash(&[x as u32, y as u32]);
    (hashed >> 40) as f32 / (1 << 23) as f32 - 1.0
}

/// Numbers of the lattice, interpolated smoothly.
fn value(x: f32, y: f32) -> f32 {
    let (i, j) = (x.floor(), y.floor());
    let [u, v] = [x - i, y - j].map(|t| t * t * t * (t * (6.0 * t - 15.0) + 10.0));
    let at = |a: i32, b: i32| lattice(i as i32 + a, j as i32 + b);
    let (low, high) = (at(0, 0) + u * (at(1, 0) - at(0, 0)), at(0, 1) + u * (at(1, 1) - at(0, 1)));
    low + v * (high - low)
}

/// A sum of octaves of noise, about in [−1, 1].
pub fn fbm(x: f32, y: f32, octaves: u32) -> f32 {
    let sum = |(sum, scale): (f32, f32), octave: u32| {
        let shift = 17.3 * octave as f32;
        (sum + value(x * scale + shift, y * scale) / scale, 2.0 * scale)
    };
    0.6 * (0..octaves).fold((0.0, 1.0), sum).0
}
