//! Eyeballs with iris and cornea.

use std::f32::consts::PI;

use math::{Vec2, Vec3, smooth_step};

use super::face::{CORNEA, EYE, EYEBALL};
use crate::mesh::Mesh;
use crate::noise::fbm;
use crate::picture;

/// Radii of the iris and the pupil.
const IRIS: f32 = 6.0;
const PUPIL: f32 = 1.9;

/// Rings of points about the axis of both eyes, of a profile of distances from the axis and
/// distances ahead, with the outside on its right.
fn turn(profile: &[[f32; 2]]) -> Mesh {
    const SIDES: u32 = 96;
    let mut mesh = Mesh::default();
    for side in [-1.0, 1.0] {
        let centre = Vec3::new(side * EYE[0], EYE[1], EYE[2]);
        let rows = profile.len() as u32;
        mesh.ring([SIDES, rows], |i, j| {
            let [radius, ahead] = profile[j as usize];
            let (sin, cos) = lanes::sin_cos(2.0 * PI * i as f32 / SIDES as f32);
            centre + Vec3::new(radius * cos, ahead, radius * sin)
        });
    }
    let eye = |p: &Vec3| {
        let q = Vec2::new(p.x.abs() - EYE[0], p.z) / (2.0 * EYEBALL);
        q + Vec2::new(0.5, 0.5)
    };
    mesh.uvs = mesh.positions.iter().map(eye).collect();
    mesh
}

/// The opaque part: iris and pupil in the front, and the white.
pub fn balls() -> Mesh {
    let limbus = (EYEBALL * EYEBALL - IRIS * IRIS).sqrt();
    let mut profile = vec![[0.03, limbus - 1.1]];
    // The iris is a shallow funnel.
    profile.extend((1..=24).map(|i| {
        let t = i as f32 / 24.0;
        [t * (IRIS + 0.1), limbus - 1.1 + 0.45 * smooth_step(t, 0.25, 0.5) - 0.3 * t * t]
    }));
    let start = (IRIS / EYEBALL).asin();
    // Twice where it has an edge.
    profile.push([IRIS, limbus]);
    profile.extend((0..=96).map(|i| {
        let (sin, cos) = lanes::sin_cos(start + (PI - start) * i as f32 / 96.0);
        [(EYEBALL * sin).max(0.03), EYEBALL * cos]
    }));
    turn(&profile)
}

/// The cornea, a bulge of what refracts, which ends inside of the white.
pub fn corneas() -> Mesh {
    let profile: Vec<[f32; 2]> = (0..=48)
        .map(|i| {
            let (sin, cos) = lanes::sin_cos(0.98 * i as f32 / 48.0);
            [(CORNEA[1] * sin).max(0.03), CORNEA[0] + CORNEA[1] * cos]
        })
        .collect();
    turn(&profile)
}

/// Colours of an eye as seen from the front, in the format PFM.
pub fn colours(size: u32) -> Vec<u8> {
    picture::square(size, |uv| colour(EYEBALL * (2.0 * uv.x - 1.0), EYEBALL * (2.0 * uv.y - 1.0)))
}

fn colour(x: f32, z: f32) -> Vec3 {
    let radius = x.hypot(z);
    let way = Vec2::new(x, z) / radius.max(1e-3);
    // Fibres of the iris: noise about the axis that hardly changes outwards.
    let fibres = fbm(9.0 * way.x + 0.16 * radius, 9.0 * way.y + 40.0, 4);
    let outer = Vec3::new(0.09, 0.15, 0.19) * (1.0 + 0.9 * fibres);
    let inner = Vec3::new(0.2, 0.13, 0.06) * (1.0 + 0.6 * fibres);
    let collar = smooth_step(radius + 0.8 * fibres, 2.4, 3.7);
    let mut iris = inner.lerp(outer, collar);
    iris *= 1.0 - 0.85 * smooth_step(radius, 4.9, 6.0);
    iris *= smooth_step(radius, PUPIL, PUPIL + 0.25);
    // The white has fine vessels towards its corners.
    let vessels =
        (1.0 - 9.0 * fbm(0.5 * x + 7.0, 1.3 * z, 4).abs()).max(0.0) * smooth_step(x.abs(), 8.0, 13.0);
    let red = Vec3::new(0.78, 0.6, 0.56);
    let white = Vec3::new(0.76, 0.73, 0.7).lerp(red, 0.25 * smooth_step(x.abs(), 9.0, 13.0) + 0.4 * vessels);
    iris.lerp(white, smooth_step(radius, IRIS - 0.35, IRIS + 0.55))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corneas_bulge_out_of_the_eyes_and_face_outwards() {
        for mesh in [balls(), corneas()] {
            let middle = |p: Vec3| Vec3::new(EYE[0] * p.x.signum(), EYE[1], EYE[2]);
            let inwards = mesh.positions.iter().zip(&mesh.normals).filter(|(p, n)| {
                let out = **p - middle(**p);
                // Not in the groove between iris and white, which the cornea covers.
                let is_outside = out.length() > EYEBALL - 0.01 && out.y < 11.0;
                (is_outside || out.length() > EYEBALL + 0.01) && out.dot(**n) < 0.0
            });
            assert_eq!(inwards.count(), 0);
        }
        let front = |mesh: &Mesh| mesh.positions.iter().fold(0.0, |y: f32, p| y.max(p.y));
        assert!(front(&corneas()) > front(&balls()) + 1.0);
        assert!(colour(0.0, 0.5).max_element() < 0.01 && colour(7.5, 0.0).min_element() > 0.5);
    }
}
