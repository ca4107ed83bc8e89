//! Trees made of spheres.

use std::f32::consts::TAU;

use math::{Frame, Point3, Vec3};
use sampling::Rng;

use crate::Substance;

/// The golden angle, by which successive directions differ.
const GOLDEN: f32 = 2.399_963;

/// Spheres of a tree at a place, whose z axis is up, in the coordinates of that place.
fn place(frame: &Frame, foot: Point3, at: Vec3) -> Point3 {
    foot + frame.from_local(at)
}

/// A broadleaved tree: a trunk, and balls of leaves all over an ellipsoid.
pub fn broadleaf(
    frame: &Frame,
    foot: Point3,
    leaves: Substance,
    rng: &mut Rng,
    mut put: impl FnMut(Substance, Point3, f32),
) {
    let size = 0.75 + 0.5 * rng.uniform_f32();
    let (height, crown) = (1.5 * size, 1.25 * size);
    for i in 0..7 {
        let share = i as f32 / 6.0;
        let radius = (0.24 - 0.1 * share) * size;
        put(Substance::Wood, place(frame, foot, Vec3::new(0.0, 0.0, share * (height + 0.4 * crown))), radius);
    }
    const BALLS: u32 = 52;
    let turn = TAU * rng.uniform_f32();
    for i in 0..BALLS {
        let z = 1.0 - 2.0 * (i as f32 + 0.5) / BALLS as f32;
        let across = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = lanes::sin_cos(GOLDEN * i as f32 % TAU + turn);
        let out = crown * (0.82 + 0.26 * rng.uniform_f32());
        let at = Vec3::new(across * cos * out, across * sin * out, height + 0.9 * crown + 0.85 * z * out);
        put(leaves, place(frame, foot, at), (0.2 + 0.12 * rng.uniform_f32()) * crown);
    }
}

/// A spruce: a trunk, and rings of needles that narrow upwards.
pub fn spruce(frame: &Frame, foot: Point3, rng: &mut Rng, mut put: impl FnMut(Substance, Point3, f32)) {
    let size = 0.75 + 0.55 * rng.uniform_f32();
    for i in 0..4 {
        put(Substance::Wood, place(frame, foot, Vec3::new(0.0, 0.0, 0.22 * i as f32 * size)), 0.15 * size);
    }
    for ring in 0..8 {
        let share = ring as f32 / 7.0;
        let (reach, count) = (1.05 * (1.0 - share) * size, 12 - (11 * ring) / 7);
        let turn = TAU * rng.uniform_f32();
        for i in 0..count {
            let (sin, cos) = lanes::sin_cos(TAU * i as f32 / count as f32 + turn);
            let z = (0.85 + 2.9 * share + 0.08 * rng.uniform_f32()) * size;
            let radius = (0.33 - 0.17 * share) * size;
            put(Substance::Needles, place(frame, foot, Vec3::new(reach * cos, reach * sin, z)), radius);
        }
    }
}
