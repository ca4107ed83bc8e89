//! A wheel: tyre with its profile, rim with spokes, brake disc and caliper. Its axis is x, and its
//! outside looks to +x.

use std::f32::consts::TAU;

use math::Vec3;

use super::body::WHEEL;
use crate::cage::Cage;
use crate::mesh::Mesh;

/// Half the width of the tyre.
const HALF: f32 = 0.122;
/// Where the tread begins.
const TREAD: f32 = WHEEL - 0.017;
/// Pairs of spokes.
const PAIRS: u32 = 5;

/// The cross-section of the tyre from bead to bead: x over half the width, and the radius.
const SECTION: [[f32; 2]; 17] = [
    [-0.80, 0.238],
    [-0.86, 0.250],
    [-0.94, 0.262],
    [-1.0, 0.280],
    [-1.0, 0.298],
    [-0.965, 0.315],
    [-0.88, 0.328],
    [-0.50, 0.3335],
    [0.0, 0.335],
    [0.50, 0.3335],
    [0.88, 0.328],
    [0.965, 0.315],
    [1.0, 0.298],
    [1.0, 0.280],
    [0.94, 0.262],
    [0.86, 0.250],
    [0.80, 0.238],
];

/// 1 within `half` of 0, and 0 outside of it but for a soft edge.
fn groove(distance: f32, half: f32, soft: f32) -> f32 {
    let t = ((half + soft - distance.abs()) / soft).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The tyre of so many points around and across.
pub fn tyre(columns: u32, rows: u32) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.ring([columns, rows], |i, j| {
        let t = (SECTION.len() - 1) as f32 * j as f32 / (rows - 1) as f32;
        let k = (t as usize).min(SECTION.len() - 2);
        let u = t - k as f32;
        // A uniform cubic B-spline through the section.
        let at = |i: usize| SECTION[i.clamp(1, SECTION.len()) - 1];
        let weights = [
            (1.0 - u) * (1.0 - u) * (1.0 - u),
            3.0 * u * u * u - 6.0 * u * u + 4.0,
            3.0 * u * (1.0 + u - u * u) + 1.0,
            u * u * u,
        ];
        let sum = |axis: usize| (0..4).map(|m| weights[m] * at(k + m)[axis]).sum::<f32>() / 6.0;
        let (x, mut radius) = (HALF * sum(0), sum(1));
        let turn = i as f32 / columns as f32;
        if radius > TREAD {
            // Grooves around, and slanted ones across the shoulders.
            let mut depth: f32 = 0.0;
            for at in [-0.062, -0.021, 0.021, 0.062] {
                depth = depth.max(groove(x - at, 0.0042, 0.0012));
            }
            let way = 64.0 * turn + 9.0 * x.abs() + if x > 0.0 { 0.5 } else { 0.0 };
            let across = (way - way.floor() - 0.5) * TAU * WHEEL / 64.0;
            if x.abs() > 0.068 {
                depth = depth.max(groove(across, 0.0026, 0.001));
            } else if x.abs() > 0.027 {
                depth = depth.max(0.6 * groove(across - 0.004, 0.0011, 0.0008));
            }
            radius -= 0.0075 * depth * ((radius - TREAD) / 0.008).min(1.0);
        }
        // Rings on the side walls.
        let ring = groove(radius - 0.2585, 0.0012, 0.001) + groove(radius - 0.305, 0.001, 0.001);
        let x = x + 0.0016 * ring * x.signum();
        let (sin, cos) = lanes::sin_cos(TAU * turn);
        Vec3::new(x, radius * cos, radius * sin)
    });
    mesh
}

/// The rim with spokes, hub and nuts; spokes are subdivided in so many steps.
pub fn rim(sides: u32, steps: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let barrel = [
        [0.098, 0.2440],
        [0.106, 0.2475],
        [0.1115, 0.2465],
        [0.113, 0.2435],
        [0.1115, 0.2400],
        [0.104, 0.2365],
        [0.097, 0.2335],
        [0.093, 0.2280],
        [0.088, 0.2240],
        [0.060, 0.2190],
        [-0.070, 0.2140],
        [-0.100, 0.2300],
        [-0.106, 0.2460],
    ];
    mesh.lathe(&barrel.map(|[x, r]| [x, r + 0.003]), sides);
    let hub = [
        [0.028, 0.078],
        [0.043, 0.076],
        [0.047, 0.070],
        [0.048, 0.064],
        [0.045, 0.060],
        [0.036, 0.058],
        [0.034, 0.054],
        [0.034, 0.036],
        [0.036, 0.034],
        [0.052, 0.033],
        [0.055, 0.030],
        [0.057, 0.020],
        [0.058, 0.001],
    ];
    mesh.lathe(&hub, sides / 2);
    for pair in 0..PAIRS {
        let turn = TAU * pair as f32 / PAIRS as f32;
        for hand in [-1.0, 1.0] {
            spoke(turn, hand, steps, &mut mesh);
        }
        let mut nut = Mesh::default();
        nut.lathe(&[[0.03, 0.0095], [0.043, 0.0095], [0.043, 0.0095], [0.046, 0.007], [0.046, 0.0005]], 6);
        let (sin, cos) = lanes::sin_cos(turn + 0.5 * TAU / PAIRS as f32);
        let at = Vec3::new(0.0, 0.045 * cos, 0.045 * sin);
        mesh.add(&nut, |p| p + at, |n| n);
    }
    mesh
}

/// One of the two spokes of a pair, from the hub to the rim.
fn spoke(turn: f32, hand: f32, steps: u32, mesh: &mut Mesh) {
    const CELLS: u32 = 6;
    let mut cage = Cage::default();
    cage.block([1, 2, CELLS], (), |[out, across, along]| {
        let t = along as f32 / CELLS as f32;
        let radius = 0.055 + 0.178 * t;
        // Pairs part from each other towards the rim.
        let angle = turn + hand * (0.10 + 0.16 * t);
        let width = 0.017 - 0.006 * t;
        let face = 0.046 + 0.034 * t * t + 0.012 * t;
        let thick = 0.030 - 0.006 * t;
        let side = (across as f32 - 1.0) * width;
        // A ridge along the middle.
        let ridge = if across == 1 { 0.004 } else { 0.0 };
        let x = if out == 1 { face + ridge } else { face - thick };
        let (sin, cos) = lanes::sin_cos(angle);
        Vec3::new(x, radius * cos - side * sin, radius * sin + side * cos)
    });
    // Edges along the spoke are sharper than what subdivision makes of them.
    let mut edges = Vec::new();
    for face in &cage.faces {
        for i in 0..4 {
            let [a, b] = [face[i], face[(i + 1) % 4]];
            let way = cage.points[b as usize] - cage.points[a as usize];
            if way.length() > 0.022 && way.x.abs() < 0.015 {
                edges.push([a, b]);
            }
        }
    }
    edges.into_iter().for_each(|[a, b]| cage.crease(a, b, 1.6));
    mesh.add(&cage.subdivided(steps).mesh(), |p| p, |n| n);
}

/// The brake disc: two plates with slots, and its bell.
pub fn disc(sides: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let plate = |x: f32, thick: f32| {
        [
            [x, 0.095],
            [x + thick, 0.095],
            [x + thick, 0.095],
            [x + thick, 0.178],
            [x + thick, 0.178],
            [x, 0.178],
            [x, 0.178],
            [x, 0.095],
        ]
    };
    for x in [-0.036, -0.018] {
        let mut points = plate(x, 0.010);
        points.reverse();
        mesh.lathe(&points, sides);
    }
    mesh.lathe(&[[-0.03, 0.096], [0.018, 0.092], [0.018, 0.092], [0.022, 0.088], [0.022, 0.03]], sides);
    mesh
}

/// The brake caliper about an angle.
pub fn caliper(steps: u32) -> Mesh {
    const CELLS: u32 = 5;
    let mut cage = Cage::default();
    cage.block([2, 2, CELLS], (), |[out, up, along]| {
        let t = along as f32 / CELLS as f32;
        let angle = (t - 0.5) * 1.15;
        let radius = [0.112, 0.155, 0.196][up as usize];
        let x = [-0.062, -0.018, 0.030][out as usize];
        let (sin, cos) = lanes::sin_cos(angle);
        Vec3::new(x, -radius * cos, radius * sin)
    });
    cage.sharpen(0, 0.6);
    cage.subdivided(steps).mesh()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn radii(mesh: &Mesh) -> impl Iterator<Item = f32> {
        mesh.positions.iter().map(|p| p.y.hypot(p.z))
    }

    #[test]
    fn a_tyre_has_grooves_and_stands_on_the_ground() {
        let tyre = tyre(640, 128);
        let highest = radii(&tyre).fold(0.0, f32::max);
        assert!((highest - WHEEL).abs() < 0.002, "{highest}");
        let tread = tyre.positions.iter().filter(|p| p.x.abs() < 0.08).map(|p| p.y.hypot(p.z));
        assert!(tread.fold(9.0, f32::min) < WHEEL - 0.006);
        assert_eq!(tyre.triangles.len(), 2 * 640 * 127);
        // Normals are outside.
        let outside = tyre.positions.iter().zip(&tyre.normals);
        assert!(outside.filter(|(p, _)| p.y.hypot(p.z) > 0.334).all(|(p, n)| p.y * n.y + p.z * n.z > 0.0));
    }

    #[test]
    fn the_rim_is_within_the_tyre() {
        let rim = rim(128, 2);
        assert!(radii(&rim).all(|radius| radius < 0.255));
        let tyre = tyre(64, 64);
        assert!(rim.positions.iter().all(|p| p.x.abs() < 0.122) && tyre.positions.len() == 64 * 64);
        assert!(
            radii(&disc(64)).all(|radius| radius < 0.2) && radii(&caliper(2)).all(|radius| radius < 0.215)
        );
    }
}
