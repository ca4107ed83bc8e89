//! What is fixed to the body: mirrors, handles, lamps, grille, exhausts, wipers, badges.

use std::f32::consts::PI;

use math::{Vec2, Vec3};

use super::body::Panel;
use super::panels::Surface;
use crate::cage::Cage;
use crate::mesh::Mesh;

/// A rounded block about a point, with half its sizes along three axes.
fn pebble(cage: &mut Cage<()>, at: Vec3, axes: [Vec3; 3], sharpness: f32) {
    let first = cage.faces.len();
    cage.block([2; 3], (), |i| {
        let [a, b, c] = i.map(|i| i as f32 - 1.0);
        at + axes[0] * a + axes[1] * b + axes[2] * c
    });
    cage.sharpen(first, sharpness);
}

/// A mesh with its twin on the other side.
fn mirrored(mesh: &Mesh) -> Mesh {
    let mut both = Mesh::default();
    both.add(mesh, |p| p, |n| n);
    let flip = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
    both.add(mesh, flip, flip);
    both
}

/// The housings of the door mirrors on their arms.
pub fn mirrors(steps: u32) -> Mesh {
    let mut cage = Cage::default();
    // A section that gets smaller to the front and to the outside.
    cage.block([3, 3, 2], (), |[i, j, k]| {
        let (s, t, u) = (i as f32 / 3.0, j as f32 / 3.0, k as f32 - 1.0);
        let round = 1.0 - 0.45 * (1.0 - t) * (1.0 - t);
        let x = 0.865 + 0.215 * s - 0.03 * (1.0 - t) * s;
        let y = 0.50 - 0.125 * t - 0.035 * s * (1.0 - t) - 0.03 * s * t;
        Vec3::new(x, y, 0.955 + 0.012 * s + 0.068 * u * round * (1.0 - 0.18 * s))
    });
    pebble(
        &mut cage,
        Vec3::new(0.835, 0.425, 0.905),
        [Vec3::new(0.075, 0.0, 0.028), Vec3::new(0.0, 0.028, 0.0), Vec3::new(0.0, 0.0, 0.011)],
        0.3,
    );
    mirrored(&cage.subdivided(steps).mesh())
}

/// The glass of the mirrors, in their backs.
pub fn mirror_glass(steps: u32) -> Mesh {
    let mut cage = Cage::default();
    pebble(
        &mut cage,
        Vec3::new(0.972, 0.352, 0.962),
        [Vec3::new(0.088, -0.026, 0.004), Vec3::new(0.001, 0.004, 0.0), Vec3::new(0.0, 0.0, 0.05)],
        0.9,
    );
    mirrored(&cage.subdivided(steps).mesh())
}

/// Door handles.
pub fn handles(body: &Surface, steps: u32) -> Mesh {
    let mut cage = Cage::default();
    let door = |p: Panel| p == Panel::Door;
    if let Some([p, n]) = body.project(door, 0, 1.0, Vec2::new(-0.50, 0.735)) {
        let along = (Vec3::Y - n * n.y).normalize();
        let up = n.cross(along);
        pebble(&mut cage, p + n * 0.010, [along * 0.095, up * 0.0125, n * 0.011], 0.55);
    }
    mirrored(&cage.subdivided(steps).mesh())
}

/// Slats of the grille.
pub fn grille(body: &Surface) -> Mesh {
    let mut mesh = Mesh::default();
    let grille = |p: Panel| p == Panel::Grille;
    for row in 0..11 {
        let z = 0.378 + 0.022 * row as f32;
        let mut points = Vec::new();
        for i in 0..=64 {
            let x = 0.56 * (i as f32 / 32.0 - 1.0);
            if let Some([p, _]) = body.project(grille, 1, 1.0, Vec2::new(x, z)) {
                points.push((p - Vec3::Y * 0.022, 0.0036));
            }
        }
        if points.len() > 1 {
            mesh.tube(&points, 12);
        }
    }
    mesh
}

/// Ends of the exhausts.
pub fn exhausts(sides: u32) -> Mesh {
    let mut pipe = Mesh::default();
    pipe.lathe(
        &[[-0.16, 0.044], [0.0, 0.046], [0.006, 0.0455], [0.008, 0.043], [0.005, 0.0405], [-0.14, 0.040]],
        sides,
    );
    let mut mesh = Mesh::default();
    let to_rear = |v: Vec3| Vec3::new(v.y, -v.x, v.z);
    for x in [0.36, 0.475] {
        mesh.add(&pipe, |p| to_rear(p) + Vec3::new(x, -2.125, 0.275), to_rear);
    }
    mirrored(&mesh)
}

/// Wipers at rest on the foot of the windscreen.
pub fn wipers(body: &Surface) -> Mesh {
    let mut mesh = Mesh::default();
    let screen = |p: Panel| matches!(p, Panel::Windscreen | Panel::Cowl | Panel::Bonnet);
    for (from, to) in [(-0.12, 0.47), (-0.56, 0.02)] {
        let mut points = Vec::new();
        for i in 0..=24 {
            let t = i as f32 / 24.0;
            let (x, y) =
                (from + t * (to - from), 0.668 - 0.10 * (from + t * (to - from)).powi(2) - 0.045 * t);
            if let Some([p, n]) = body.project(screen, 2, 1.0, Vec2::new(x, y)) {
                points.push((p + n * 0.012, 0.0055));
            }
        }
        if points.len() > 1 {
            mesh.tube(&points, 10);
        }
    }
    mesh
}

/// A round badge on nose and tail.
pub fn badges(body: &Surface, sides: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut disc = Mesh::default();
    disc.lathe(
        &[
            [0.0, 0.036],
            [0.004, 0.0355],
            [0.006, 0.033],
            [0.005, 0.030],
            [0.003, 0.029],
            [0.0045, 0.015],
            [0.005, 0.0003],
        ],
        sides,
    );
    let any = |p: Panel| matches!(p, Panel::Bonnet | Panel::Boot | Panel::FrontBumper | Panel::RearBumper);
    for (sign, z) in [(1.0, 0.672), (-1.0, 0.885)] {
        if let Some([p, n]) = body.project(any, 1, sign, Vec2::new(0.0, z)) {
            let frame = math::Frame::from_z_and_x(n, Vec3::X);
            let turn = |v: Vec3| frame.z * v.x + frame.x * v.y + frame.y * v.z;
            mesh.add(&disc, |q| p + turn(q), turn);
        }
    }
    mesh
}

/// A projector of a headlamp, which looks to +x: bezel and bowl as metal.
pub fn projector(sides: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut points = vec![[-0.05, 0.046], [0.0, 0.046], [0.004, 0.044], [0.004, 0.041], [0.0, 0.039]];
    // The bowl is a paraboloid.
    points.extend((0..12).map(|i| {
        let t = 1.0 - i as f32 / 12.0;
        [-0.05 * (1.0 - t * t), 0.038 * t.max(0.02)]
    }));
    mesh.lathe(&points, sides);
    mesh
}

/// Where the projectors of the right headlamp are.
pub fn projectors(body: &Surface) -> Vec<Vec3> {
    let lamp = |p: Panel| p == Panel::Headlamp;
    [(0.63, 0.62), (0.725, 0.604)]
        .into_iter()
        .filter_map(|(x, z)| body.project(lamp, 1, 1.0, Vec2::new(x, z)))
        .map(|[p, _]| p - Vec3::Y * 0.055)
        .collect()
}

/// The line of light along the lower edge of the headlamps.
pub fn daylight(body: &Surface) -> Mesh {
    let mut mesh = Mesh::default();
    let lamp = |p: Panel| p == Panel::Headlamp;
    let mut points = Vec::new();
    for i in 0..=40 {
        let t = i as f32 / 40.0;
        let (x, z) = (0.60 + 0.215 * t, 0.594 - 0.022 * t - 0.006 * lanes::sin(PI * t));
        if let Some([p, n]) = body.project(lamp, 1, 1.0, Vec2::new(x, z)) {
            points.push((p - n * 0.016, 0.0045));
        }
    }
    if points.len() > 1 {
        mesh.tube(&points, 12);
    }
    mirrored(&mesh)
}

/// The tubes of light in the tail lamps.
pub fn taillight(body: &Surface) -> Mesh {
    let mut mesh = Mesh::default();
    let lamp = |p: Panel| p == Panel::TailLamp;
    for lift in [-0.018, 0.018] {
        let mut points = Vec::new();
        for i in 0..=48 {
            let x = 0.26 + 0.5 * i as f32 / 48.0;
            let t = (x - 0.2) / 0.6;
            let z = 0.848 - 0.042 * t * t + lift;
            if let Some([p, n]) = body.project(lamp, 1, -1.0, Vec2::new(x, z)) {
                points.push((p - n * 0.014, 0.0055));
            }
        }
        if points.len() > 1 {
            mesh.tube(&points, 12);
        }
    }
    mirrored(&mesh)
}

/// The well of a wheel about the axis x: a drum that is open towards the outside.
pub fn well(sides: u32) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.lathe(&[[0.135, 0.392], [-0.22, 0.392], [-0.22, 0.392], [-0.22, 0.001]], sides);
    mesh
}
