//! The light of the sky: a picture of all directions for what is seen, and harmonics for what it
//! does to surfaces and to mist.
//!
//! Radiance becomes nine real spherical harmonics of degree 0 to 2, L_lm. The irradiance of a
//! surface of normal n is then Σ A_l L_lm Y_lm(n) with A = π, 2π/3, π/4, which is exact to a few
//! per cent for any sky, as the cosine has hardly more. Source: [Ramamoorthi 2001].

use std::f32::consts::PI;

use half::f16;
use math::{Ray, Vec3};
use rayon::prelude::*;
use scene::Scene;

use super::colors::Colors;

/// Texels of a side of a face of the cube.
pub const SIDE: u32 = 256;

/// The faces of a cube: towards +x, −x, +y, −y, +z, −z.
const FACES: u32 = 6;

/// The radiance of half floats.
const MOST: f32 = 6e4;

/// The sky of a scene.
pub struct Sky {
    /// Texels of a cube map, face by face and row by row.
    pub texels: Vec<[f16; 4]>,
    /// The harmonics of radiance.
    pub radiance: [Vec3; 9],
}

/// What the cosine makes of harmonics of each degree.
const COSINE: [f32; 3] = [PI, 2.0 / 3.0 * PI, 0.25 * PI];

impl Sky {
    /// That of a scene, at its middle.
    pub fn new(scene: &Scene, colors: &Colors) -> Self {
        let center = scene.sphere().center;
        let rows = (0..FACES * SIDE).into_par_iter().map(|row| {
            let (face, y) = (row / SIDE, row % SIDE);
            let mut sum = [Vec3::ZERO; 9];
            let texels = (0..SIDE).map(|x| {
                let [s, t] = [x, y].map(|i| (2.0 * i as f32 + 1.0) / SIDE as f32 - 1.0);
                let d = direction(face, s, t).normalize();
                let light = colors.light(|lambda| scene.escaped(&Ray::new(center, d, 0.5), lambda));
                let solid_angle = 4.0 / (SIDE * SIDE) as f32 * (1.0 + s * s + t * t).powf(-1.5);
                for (sum, y) in sum.iter_mut().zip(harmonics(d)) {
                    *sum += light * (y * solid_angle);
                }
                let light = light.min(Vec3::splat(MOST));
                [light.x, light.y, light.z, 1.0].map(f16::from_f32)
            });
            (texels.collect::<Vec<_>>(), sum)
        });
        let rows: Vec<_> = rows.collect();
        let mut sky = Self { texels: Vec::new(), radiance: [Vec3::ZERO; 9] };
        for (texels, sum) in rows {
            sky.texels.extend(texels);
            sky.radiance.iter_mut().zip(sum).for_each(|(all, part)| *all += part);
        }
        sky
    }

    /// The harmonics of irradiance.
    pub fn irradiance(&self) -> [Vec3; 9] {
        std::array::from_fn(|i| self.radiance[i] * COSINE[degree(i)])
    }

    /// The harmonics of the light that scatters towards who looks along a direction, by a phase
    /// function of asymmetry `g`: that of Henyey and Greenstein keeps gˡ of degree l.
    pub fn scattered(&self, g: f32) -> [Vec3; 9] {
        std::array::from_fn(|i| self.radiance[i] * g.powi(degree(i) as i32))
    }
}

/// The degree of a harmonic.
fn degree(i: usize) -> usize {
    [0, 1, 1, 1, 2, 2, 2, 2, 2][i]
}

/// The direction of a point of a face, whose coordinates run from −1 to 1 to the right and down.
fn direction(face: u32, s: f32, t: f32) -> Vec3 {
    match face {
        0 => Vec3::new(1.0, -t, -s),
        1 => Vec3::new(-1.0, -t, s),
        2 => Vec3::new(s, 1.0, t),
        3 => Vec3::new(s, -1.0, -t),
        4 => Vec3::new(s, -t, 1.0),
        _ => Vec3::new(-s, -t, -1.0),
    }
}

/// The real spherical harmonics of a unit direction, in the order of `harmonics` of
/// `shaders/raster.wgsl`.
fn harmonics(d: Vec3) -> [f32; 9] {
    let Vec3 { x, y, z } = d;
    [
        0.282_094_8,
        0.488_602_5 * y,
        0.488_602_5 * z,
        0.488_602_5 * x,
        1.092_548_4 * x * y,
        1.092_548_4 * y * z,
        0.315_391_57 * (2.0 * z * z - x * x - y * y),
        1.092_548_4 * x * z,
        0.546_274_2 * (x * x - y * y),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_are_orthonormal_over_the_cube() {
        let mut products = [[0.0_f64; 9]; 9];
        let side = 32;
        for face in 0..FACES {
            for i in 0..side * side {
                let [s, t] = [i % side, i / side].map(|i| (2.0 * i as f32 + 1.0) / side as f32 - 1.0);
                let y = harmonics(direction(face, s, t).normalize());
                let weight = 4.0 / (side * side) as f32 * (1.0 + s * s + t * t).powf(-1.5);
                for (row, a) in products.iter_mut().zip(y) {
                    row.iter_mut().zip(y).for_each(|(sum, b)| *sum += f64::from(a * b * weight));
                }
            }
        }
        for (i, row) in products.iter().enumerate() {
            for (j, product) in row.iter().enumerate() {
                let wanted = if i == j { 1.0 } else { 0.0 };
                assert!((product - wanted).abs() < 2e-3, "{i} {j}: {product}");
            }
        }
    }
}
