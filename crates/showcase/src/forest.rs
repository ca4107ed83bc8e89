//! A forest around a pond under an overcast sky.
//!
//! Eight plants are grown (`tree.rs`) and instanced all over a hilly ground; the pond has a bed,
//! and ripples as geometry. Light comes from the sky alone, whose luminance is that of a sky wholly
//! covered by clouds, L(γ) ∝ 1 + 2 sin γ for the elevation γ. Mist fills a dome over all, water
//! absorbs red first. Source of the sky: [Moon 1942].
//!
//! The trees stand in an order that does not depend on their number, so that smaller forests, of
//! 10⁶, 10⁷ and 10⁸ triangles, are parts of the whole.

use std::f32::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use math::{Vec2, Vec3};
use sampling::Rng;

use super::land::{POND, height, shore, slope};
use super::mesh::Mesh;
use super::noise::fbm;
use super::picture;
use super::pond;
use super::tree::{Broadleaf, grass, spruce};

/// Trees stand within this radius, in metres.
const RADIUS: f32 = 75.0;
/// Half the extent of the ground.
const GROUND: f32 = 110.0;
/// Plants by name, with what part of all trees they are.
const TREES: [(&str, f32); 7] = [
    ("oak-1", 0.16),
    ("oak-2", 0.16),
    ("birch-1", 0.16),
    ("birch-2", 0.14),
    ("spruce-1", 0.14),
    ("spruce-2", 0.12),
    ("bush", 0.12),
];

/// Effective triangles of the smaller forests.
const SMALLER: [(&str, u64); 3] = [("6", 1_000_000), ("7", 10_000_000), ("8", 100_000_000)];

/// How much there is of everything.
pub struct Detail {
    /// How large plants are, whose leaves are not smaller.
    pub growth: f32,
    /// How finely ground and water are cut.
    pub cells: f32,
}

impl Detail {
    /// Two hundred million triangles.
    pub const WHOLE: Self = Self { growth: 1.0, cells: 1.0 };
    /// As many plants, of a tenth of the leaves.
    pub const SMALL: Self = Self { growth: 0.45, cells: 0.2 };
}

pub fn make(folder: &Path, detail: Detail) -> io::Result<String> {
    let Detail { growth, cells } = detail;
    let [oak, birch, bush] = [
        Broadleaf { trunk: 2.2, crown: [3.6, 3.6], points: 15000, leaf: [0.1, 0.06], leaves: 4 },
        Broadleaf { trunk: 2.6, crown: [1.9, 4.2], points: 8000, leaf: [0.065, 0.048], leaves: 5 },
        Broadleaf { trunk: 0.3, crown: [1.1, 0.9], points: 1800, leaf: [0.06, 0.035], leaves: 5 },
    ]
    .map(|plant| Broadleaf {
        trunk: plant.trunk * growth,
        crown: plant.crown.map(|radius| radius * growth),
        points: (plant.points as f32 * growth * growth * growth) as u32,
        ..plant
    });
    let mut plants = String::new();
    let mut triangles = Vec::new();
    for (i, (name, _)) in TREES.into_iter().enumerate() {
        let seed = i as u64 + 1;
        let tree = match name {
            "oak-1" | "oak-2" => oak.grow(seed),
            "birch-1" | "birch-2" => birch.grow(seed),
            "bush" => bush.grow(seed),
            "spruce-1" => spruce(9.0 * growth, seed),
            _ => spruce(6.0 * growth, seed),
        };
        tree.wood.write(&folder.join(format!("{name}-wood.ply")))?;
        tree.leaves.write(&folder.join(format!("{name}-leaves.ply")))?;
        triangles.push((tree.wood.triangles.len() + tree.leaves.triangles.len()) as u64);
        let kind = name.split('-').next().unwrap_or(name);
        writeln!(plants, "ObjectBegin \"{name}\"").unwrap_or_default();
        for part in ["wood", "leaves"] {
            let _ = writeln!(
                plants,
                "  NamedMaterial \"{kind} {part}\" Shape \"plymesh\" \"string filename\" \"{name}-{part}.ply\""
            );
        }
        plants += "ObjectEnd\n";
    }
    let blades = grass(2600, 99);
    blades.write(&folder.join("grass.ply"))?;
    plants += "ObjectBegin \"grass\"\n  NamedMaterial \"grass\" Shape \"plymesh\" \"string filename\" \"grass.ply\"\nObjectEnd\n";
    fs::write(folder.join("plants.pbrt"), plants)?;

    ground(cells).write(&folder.join("ground.ply"))?;
    water(cells).write(&folder.join("water.ply"))?;
    fs::write(folder.join("sky.pfm"), sky(256))?;
    fs::write(folder.join("place.pbrt"), PLACE)?;
    fs::write(folder.join("ground.pbrt"), GROUND_OF_SOIL)?;
    pond::make(folder)?;
    fs::write(folder.join("meadow.pbrt"), meadow())?;

    let stand = stand();
    let total: u64 = stand.iter().map(|tree| triangles[tree.0]).sum();
    for (suffix, least) in SMALLER.into_iter().chain([("", u64::MAX)]) {
        let (mut text, mut sum) = (String::new(), 0);
        for (kind, place) in &stand {
            if sum >= least {
                break;
            }
            sum += triangles[*kind];
            text += place;
        }
        let name = if suffix.is_empty() { "forest".into() } else { format!("forest-{suffix}") };
        let trees = format!("{name}-trees.pbrt");
        fs::write(folder.join(&trees), text)?;
        let scene =
            VIEW.replace("PICTURE", &name).replace("TREES", &trees).replace("TRIANGLES", &sum.to_string());
        fs::write(folder.join(format!("{name}.pbrt")), scene)?;
    }
    Ok(format!("{} trees of {total} triangles in all", stand.len()))
}

fn ground(cells: f32) -> Mesh {
    let count = (500.0 * cells) as u32;
    let mut mesh = Mesh::default();
    // Finer where the pond is.
    let at = |i: u32| {
        let t = 2.0 * i as f32 / (count - 1) as f32 - 1.0;
        GROUND * t * (0.25 + 0.75 * t * t)
    };
    mesh.grid([count; 2], |i, j| {
        let (x, y) = (at(i), at(j));
        [Vec3::new(x, y, height(x, y)), slope(x, y)]
    });
    // Textures know the height, and do not change along v.
    mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(pond::coordinate(p.z), 0.5 + p.y / GROUND)).collect();
    mesh
}

/// The surface of the water: ripples of many lengths and directions, as a faint wind makes them.
fn water(cells: f32) -> Mesh {
    let count = [900.0, 640.0].map(|count: f32| (count * cells) as u32);
    let mut rng = Rng::from_sequence(7);
    let waves: Vec<(Vec2, f32, f32)> = (0..24)
        .map(|i| {
            let length = 0.14 * lanes::pow(1.14, i as f32);
            let turn = 0.9 + 1.9 * (rng.uniform_f32() - 0.5);
            let way = Vec2::new(lanes::cos(turn), lanes::sin(turn)) * (TAU / length);
            (way, TAU * rng.uniform_f32(), 0.0016 * length)
        })
        .collect();
    let mut mesh = Mesh::default();
    mesh.grid(count, |i, j| {
        let x = 1.35 * POND[0] * (2.0 * i as f32 / (count[0] - 1) as f32 - 1.0);
        let y = 1.35 * POND[1] * (2.0 * j as f32 / (count[1] - 1) as f32 - 1.0);
        // Calm patches.
        let wind = 0.35 + 0.65 * (0.5 + fbm(0.12 * x, 0.2 * y + 9.0, 2)).clamp(0.0, 1.0);
        let (mut z, mut slope) = (0.0, Vec2::ZERO);
        for &(way, phase, amplitude) in &waves {
            let (sin, cos) = lanes::sin_cos((way.dot(Vec2::new(x, y)) + phase) % TAU);
            z += amplitude * wind * sin;
            slope += way * (amplitude * wind * cos);
        }
        [Vec3::new(x, y, z), Vec3::new(-slope.x, -slope.y, 1.0).normalize()]
    });
    mesh
}

/// A sky covered by clouds as a picture over the sphere in the format PFM; below the horizon it is
/// dark.
fn sky(size: u32) -> Vec<u8> {
    picture::sphere(size, |d| {
        let clouds = 1.0 + 0.25 * fbm(2.0 * d.x / (d.z.abs() + 0.25), 2.0 * d.y / (d.z.abs() + 0.25), 4);
        let luminance = if d.z > 0.0 { (1.0 + 2.0 * d.z) / 3.0 * clouds } else { 0.08 };
        Vec3::new(0.95, 1.0, 1.08) * luminance
    })
}

/// The trees in their order: which, and the statement that places it.
fn stand() -> Vec<(usize, String)> {
    let mut rng = Rng::from_sequence(31);
    let (mut taken, mut stand) = (Vec::<(Vec2, f32)>::new(), Vec::new());
    for _ in 0..60_000 {
        let mut u = rng.uniform_f32();
        let mut kind = 0;
        while kind + 1 < TREES.len() && u >= TREES[kind].1 {
            u -= TREES[kind].1;
            kind += 1;
        }
        // The first ones are near to the pond, where they are seen.
        let reach = lanes::pow(rng.uniform_f32(), 0.62) * RADIUS;
        let (sin, cos) = lanes::sin_cos(TAU * rng.uniform_f32());
        let p = Vec2::new(reach * cos, reach * sin);
        let (size, turn) = (0.75 + 0.5 * rng.uniform_f32(), 360.0 * rng.uniform_f32());
        let space = match TREES[kind].0 {
            "bush" => 1.2,
            "oak-1" | "oak-2" => 4.6,
            _ => 2.8,
        };
        // None in the water, at the viewer, or within another one.
        let is_view = p.x.abs() < 4.0 && p.y < -8.0;
        if shore(p.x, p.y) < 1.12 || is_view || taken.iter().any(|(q, s)| q.distance(p) < 0.5 * (s + space)) {
            continue;
        }
        taken.push((p, space));
        let place = format!(
            "AttributeBegin Translate {} {} {} Rotate {turn} 0 0 1 Scale {size} {size} {size} ObjectInstance \"{}\" AttributeEnd\n",
            p.x,
            p.y,
            height(p.x, p.y),
            TREES[kind].0
        );
        stand.push((kind, place));
    }
    stand
}

/// Grass around the pond.
fn meadow() -> String {
    let mut rng = Rng::from_sequence(47);
    let mut text = String::new();
    for i in -32..=32 {
        for j in -30..=30 {
            let (x, y) = (0.95 * i as f32, 0.95 * j as f32);
            let turn = 90.0 * (4.0 * rng.uniform_f32()).floor();
            if shore(x, y) > 1.03 && height(x, y) > 0.03 && rng.uniform_f32() < 0.93 {
                let z = height(x, y);
                let _ = writeln!(
                    text,
                    "AttributeBegin Translate {x} {y} {z} Rotate {turn} 0 0 1 ObjectInstance \"grass\" AttributeEnd"
                );
            }
        }
    }
    text
}

const VIEW: &str = r#"# A forest of TRIANGLES triangles of trees around a pond, under an overcast sky.
# Made by `cargo xtask scenes forest`. x is to the right, y into the picture, z up; metres.

Film "rgb" "integer xresolution" 960 "integer yresolution" 540 "string filename" "PICTURE.png"
Sampler "zsobol" "integer pixelsamples" 64
Integrator "volpath" "integer maxdepth" 16

MakeNamedMedium "mist" "string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 0.0048 0.005 0.0053 ]
MediumInterface "" "mist"
LookAt 1.5 -13.2 0.8   0.2 0 2.2   0 0 1
Camera "perspective" "float fov" 44

WorldBegin
Include "place.pbrt"
Include "ground.pbrt"
Include "plants.pbrt"
Include "meadow.pbrt"
Include "TREES"
"#;

const PLACE: &str = r#"# Sky, mist and water, and the materials of plants.

LightSource "infinite" "string filename" "sky.pfm" "float scale" 2.5

MakeNamedMedium "water" "string type" "homogeneous" "rgb sigma_a" [ 0.9 0.35 0.3 ] "rgb sigma_s" [ 0.05 0.06 0.05 ]
AttributeBegin
  MediumInterface "mist" ""
  Material "interface"
  Shape "sphere" "float radius" 160
AttributeEnd
AttributeBegin
  MediumInterface "water" "mist"
  Material "dielectric" "float eta" 1.333
  Shape "plymesh" "string filename" "water.ply"
AttributeEnd

MakeNamedMaterial "oak wood" "string type" "diffuse" "rgb reflectance" [ 0.11 0.085 0.06 ]
MakeNamedMaterial "oak leaves" "string type" "diffusetransmission" "rgb reflectance" [ 0.085 0.17 0.03 ] "rgb transmittance" [ 0.12 0.23 0.025 ]
MakeNamedMaterial "birch wood" "string type" "diffuse" "rgb reflectance" [ 0.48 0.46 0.42 ]
MakeNamedMaterial "birch leaves" "string type" "diffusetransmission" "rgb reflectance" [ 0.15 0.2 0.035 ] "rgb transmittance" [ 0.2 0.26 0.03 ]
MakeNamedMaterial "spruce wood" "string type" "diffuse" "rgb reflectance" [ 0.1 0.07 0.05 ]
MakeNamedMaterial "spruce leaves" "string type" "diffuse" "rgb reflectance" [ 0.035 0.075 0.035 ]
MakeNamedMaterial "bush wood" "string type" "diffuse" "rgb reflectance" [ 0.12 0.09 0.06 ]
MakeNamedMaterial "bush leaves" "string type" "diffusetransmission" "rgb reflectance" [ 0.11 0.15 0.03 ] "rgb transmittance" [ 0.14 0.19 0.03 ]
MakeNamedMaterial "grass" "string type" "diffusetransmission" "rgb reflectance" [ 0.11 0.18 0.035 ] "rgb transmittance" [ 0.11 0.2 0.025 ]
"#;

const GROUND_OF_SOIL: &str = r#"# The ground.

Texture "patches" "float" "fbm" "integer octaves" 5 "float roughness" 0.6
Texture "soil" "spectrum" "mix" "rgb tex1" [ 0.07 0.05 0.03 ] "rgb tex2" [ 0.06 0.09 0.025 ] "texture amount" "patches"
Material "diffuse" "texture reflectance" "soil"
Shape "plymesh" "string filename" "ground.ply"
"#;
