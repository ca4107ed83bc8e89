//! Two meshes of about a million triangles, made from formulas in doubles and rounded once.
//!
//! Both are made of *blobs*: the unit sphere over m meridians and k bands of latitude, whose radius
//! in direction d is
//!
//! r(d) = 1 + Σ_{j<6} 0.18·2⁻ʲ · sin(f·d_x + 1.7j + s) · sin(f·d_y + 2.3j + 0.5 + s) · sin(f·d_z +
//! 3.1j + 1 + s), f = 3·2ʲ
//!
//! with a shift s. `blob` is one of 1,046,528 triangles, seen from outside: even, finely
//! tessellated, nothing hidden. `room` is a closed box with 6 × 6 × 6 of them, 1,028,172 triangles
//! in all, seen from a corner: large and tiny triangles, much that is hidden. And [`spheres`], at
//! random.

use geometry::{MeshAttributes, MeshError, SphereSet, SphereSetError, TriangleMesh};
use math::{DVec3, Point3, Transform, Vec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A mesh, and the camera and light that its rays are made with.
pub struct BenchMesh {
    /// Name.
    pub name: &'static str,
    /// Vertices.
    pub positions: Arc<[Point3]>,
    /// Triangles.
    pub indices: Arc<[[u32; 3]]>,
    /// Camera.
    pub view: View,
    /// A corner of a parallelogram light, and its two edges.
    pub light: [Vec3; 3],
}

/// A perspective camera with a square image.
pub struct View {
    /// Position.
    pub eye: Point3,
    /// Target.
    pub target: Point3,
    /// Up direction.
    pub up: Vec3,
    /// Field of view in degrees.
    pub fov: f32,
}

impl BenchMesh {
    /// Names of all meshes.
    pub const NAMES: [&str; 2] = ["blob", "room"];

    /// A mesh by its name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "blob" => Some(blob()),
            "room" => Some(room()),
            _ => None,
        }
    }

    /// The same mesh for our engine; shares the arrays.
    pub fn triangles(&self) -> Result<TriangleMesh, MeshError> {
        let (positions, indices) = (self.positions.clone(), self.indices.clone());
        TriangleMesh::new(positions, indices, MeshAttributes::default(), &Transform::IDENTITY, false)
    }
}

/// One blob of 1,046,528 triangles.
pub fn blob() -> BenchMesh {
    let mut arrays = Arrays::default();
    arrays.push_blob(1024, 512, 0.0, |p| p);
    arrays.finish(
        "blob",
        View { eye: Vec3::new(1.2, 0.9, 2.6), target: Vec3::ZERO, up: Vec3::Y, fov: 45.0 },
        [Vec3::new(-1.0, 3.0, -1.0), Vec3::X * 2.0, Vec3::Z * 2.0],
    )
}

/// A closed box with 216 blobs, 1,028,172 triangles.
pub fn room() -> BenchMesh {
    const SIDES: [[u32; 4]; 6] =
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6]];
    let mut arrays = Arrays::default();
    for corner in 0..8 {
        let side = |axis: u32| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
        arrays.positions.push(Vec3::new(side(0), side(1), side(2)));
    }
    arrays.indices.extend(SIDES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]));
    for n in 0..216 {
        let random = &mut SplitMix64(1000 + n);
        let cell = DVec3::new((n % 6) as f64, (n / 6 % 6) as f64, (n / 36) as f64);
        let jitter = DVec3::from_array([0; 3].map(|_| random.uniform()));
        let center = cell / 3.0 - 5.0 / 6.0 + (jitter - 0.5) * 0.1;
        let radius = 0.07 + 0.05 * random.uniform();
        arrays.push_blob(70, 35, 0.37 * n as f64, |p| center + p * radius);
    }
    arrays.finish(
        "room",
        View {
            eye: Vec3::new(0.97, 0.93, 0.99),
            target: Vec3::new(-0.3, -0.4, -0.5),
            up: Vec3::Y,
            fov: 70.0,
        },
        [Vec3::new(-0.5, 0.99, -0.5), Vec3::X, Vec3::Z],
    )
}

#[derive(Default)]
struct Arrays {
    positions: Vec<Point3>,
    indices: Vec<[u32; 3]>,
}

impl Arrays {
    /// Adds a blob of 2·meridians·(bands − 1) triangles: north pole, rings from north to south,
    /// south pole.
    fn push_blob(&mut self, meridians: u32, bands: u32, shift: f64, place: impl Fn(DVec3) -> DVec3) {
        let north = self.positions.len() as u32;
        self.positions.push(place(DVec3::Y * radius(DVec3::Y, shift)).as_vec3().into());
        for band in 1..bands {
            let (sin_theta, cos_theta) = (PI * band as f64 / bands as f64).sin_cos();
            for meridian in 0..meridians {
                let (sin_phi, cos_phi) = (TAU * meridian as f64 / meridians as f64).sin_cos();
                let d = DVec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi);
                self.positions.push(place(d * radius(d, shift)).as_vec3().into());
            }
        }
        let south = self.positions.len() as u32;
        self.positions.push(place(DVec3::NEG_Y * radius(DVec3::NEG_Y, shift)).as_vec3().into());
        let at = |band: u32, meridian: u32| north + 1 + (band - 1) * meridians + meridian % meridians;
        for i in 0..meridians {
            self.indices.push([north, at(1, i + 1), at(1, i)]);
        }
        for band in 1..bands - 1 {
            for i in 0..meridians {
                let [a, b] = [at(band, i), at(band, i + 1)];
                self.indices.extend([[a, b, a + meridians], [b, b + meridians, a + meridians]]);
            }
        }
        for i in 0..meridians {
            self.indices.push([south, at(bands - 1, i), at(bands - 1, i + 1)]);
        }
    }

    fn finish(self, name: &'static str, view: View, light: [Vec3; 3]) -> BenchMesh {
        BenchMesh { name, positions: self.positions.into(), indices: self.indices.into(), view, light }
    }
}

/// Random spheres in the unit cube, which fill a hundredth of its volume.
pub fn spheres(count: usize) -> Result<SphereSet, SphereSetError> {
    let random = &mut SplitMix64(7);
    let point = |_| DVec3::from_array([0; 3].map(|_| random.uniform())).as_vec3().into();
    let centers = (0..count).map(point).collect();
    let radius = (0.01 * 3.0 / (4.0 * PI * count as f64)).cbrt() as f32;
    SphereSet::new(centers, [radius].into(), &Transform::IDENTITY, false)
}

/// The radius of a blob in direction `d`.
fn radius(d: DVec3, shift: f64) -> f64 {
    let bump = |j: i32| {
        let (f, k) = (3.0 * 2f64.powi(j), j as f64);
        0.18 * 2f64.powi(-j)
            * (f * d.x + 1.7 * k + shift).sin()
            * (f * d.y + 2.3 * k + 0.5 + shift).sin()
            * (f * d.z + 3.1 * k + 1.0 + shift).sin()
    };
    1.0 + (0..6).map(bump).sum::<f64>()
}

/// The generator SplitMix64 ([Steele et al. 2014]): the same numbers wherever the meshes and rays
/// are made.
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = self.0;
        let z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    /// In [0, 1), in steps of 2⁻²⁴: exact as a float, too.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 40) as f64 / (1 << 24) as f64
    }
}
