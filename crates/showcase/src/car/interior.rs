//! What is seen through the windows: seats, dashboard, steering wheel, tunnel.

use std::f32::consts::{PI, TAU};

use math::Vec3;

use crate::cage::Cage;
use crate::mesh::Mesh;

/// The middle of the driver's seat; the other one is its mirror image.
const SEAT: f32 = 0.365;

/// Both seats: cushions and backs with bolsters, and head rests.
pub fn seats(steps: u32) -> Mesh {
    let mut cage = Cage::default();
    // Across: two bolsters and the middle; across x in half widths, and how far bolsters stand out.
    let across = [-0.265, -0.215, -0.15, -0.05, 0.05, 0.15, 0.215, 0.265];
    let bolster = [0.02, 0.075, 0.012, 0.0, 0.0, 0.012, 0.075, 0.02];
    // Cushion, from the knees to the back.
    cage.block([7, 5, 1], (), |[i, j, up]| {
        let t = j as f32 / 5.0;
        let (x, y) = (across[i as usize] * (0.92 + 0.08 * t), 0.20 - 0.56 * t);
        let top = 0.435 - 0.075 * t - 0.02 * (1.0 - t) * (1.0 - t) + bolster[i as usize];
        Vec3::new(SEAT + x, y, if up == 1 { top } else { 0.25 })
    });
    // Back, from below to the shoulders.
    cage.block([7, 1, 7], (), |[i, front, j]| {
        let t = j as f32 / 7.0;
        let narrow = 1.0 - 0.10 * t - 0.22 * (t - 0.72).max(0.0) / 0.28;
        let lean = -0.36 - 0.30 * t;
        let curve = 0.035 * lanes::sin(PI * t);
        let stand = bolster[i as usize] * (1.15 - 0.75 * t);
        let y = lean + if front == 1 { curve + stand + 0.05 } else { -0.07 };
        Vec3::new(SEAT + across[i as usize] * narrow, y, 0.34 + 0.56 * t)
    });
    // Head rest.
    cage.block([3, 1, 3], (), |[i, front, j]| {
        let (s, t) = (i as f32 / 3.0 - 0.5, j as f32 / 3.0);
        let y = -0.665 - 0.05 * t + if front == 1 { 0.055 - 0.05 * s * s } else { -0.045 };
        Vec3::new(SEAT + 0.27 * s, y, 0.925 + 0.155 * t)
    });
    cage.mirror();
    cage.subdivided(steps).mesh()
}

/// Dashboard with the hood over the instruments, tunnel, door sills and rear shelf.
pub fn board(steps: u32) -> Mesh {
    let mut cage = Cage::default();
    // A section from the windscreen over the edge to the knees, drawn across the car.
    let section = [[0.66, 0.86], [0.48, 0.875], [0.34, 0.86], [0.29, 0.81], [0.33, 0.72], [0.40, 0.60]];
    cage.block([12, 5, 1], (), |[i, j, up]| {
        let x = 1.42 * (i as f32 / 12.0 - 0.5);
        let [y, z] = section[j as usize];
        let driver = (1.0 - ((x - SEAT) / 0.22).abs()).clamp(0.0, 1.0);
        let hood = 0.055 * driver * driver * (3.0 - 2.0 * driver) * f32::from(j == 2 || j == 3);
        let curve = -0.10 * x * x;
        let [y, z] = if up == 1 { [y, z + hood] } else { [y + 0.12, z - 0.10] };
        Vec3::new(x, y + curve, z)
    });
    // Tunnel.
    cage.block([2, 6, 1], (), |[i, j, up]| {
        let y = 0.42 - 0.20 * j as f32;
        let z = 0.50 - 0.10 * (j as f32 / 6.0);
        let x = [-0.105, 0.0, 0.105][i as usize];
        Vec3::new(x, y, if up == 1 { z + 0.012 * f32::from(i == 1) } else { 0.20 })
    });
    // Behind the seats a shelf.
    cage.block([4, 3, 1], (), |[i, j, up]| {
        let (x, y) = (1.16 * (i as f32 / 4.0 - 0.5), -0.80 - 0.24 * j as f32);
        Vec3::new(x, y, if up == 1 { 0.83 } else { 0.70 })
    });
    cage.sharpen(0, 0.5);
    cage.subdivided(steps).mesh()
}

/// The steering wheel: rim, spokes and hub.
pub fn steering(sides: u32) -> Mesh {
    const RADIUS: f32 = 0.178;
    let mut wheel = Mesh::default();
    let around = |i: u32, n: u32| lanes::sin_cos(TAU * i as f32 / n as f32);
    wheel.ring([2 * sides, sides], |i, j| {
        let ((s, c), (sin, cos)) = (around(i, 2 * sides), around(j % (sides - 1), sides - 1));
        let r = RADIUS + 0.0155 * cos;
        Vec3::new(r * c, 0.0155 * sin, r * s)
    });
    for turn in [0.08, PI - 0.08, 1.5 * PI - 0.16, 1.5 * PI + 0.16] {
        let (sin, cos) = lanes::sin_cos(turn);
        let points: Vec<_> = (0..=6)
            .map(|i| 0.03 + (RADIUS - 0.03) * i as f32 / 6.0)
            .map(|r| (Vec3::new(r * cos, -0.018 * (1.0 - r / RADIUS), r * sin), 0.011))
            .collect();
        wheel.tube(&points, sides / 2);
    }
    let mut hub = Mesh::default();
    hub.lathe(&[[-0.03, 0.04], [-0.01, 0.062], [0.012, 0.06], [0.022, 0.045], [0.026, 0.0005]], sides);
    let to_y = |v: Vec3| Vec3::new(v.y, -v.x, v.z);
    wheel.add(&hub, to_y, to_y);
    // Tilted towards the driver.
    let (sin, cos) = lanes::sin_cos(0.42);
    let tilt = |v: Vec3| Vec3::new(v.x, v.y * cos + v.z * sin, v.z * cos - v.y * sin);
    let mut placed = Mesh::default();
    placed.add(&wheel, |p| tilt(p) + Vec3::new(SEAT, 0.13, 0.765), tilt);
    placed
}
