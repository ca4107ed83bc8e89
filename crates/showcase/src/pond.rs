//! What lies about the shore of the pond: stones, leaves of water lilies, and reeds; and the bed.

use std::f32::consts::{PI, TAU};
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use math::{Vec2, Vec3};
use sampling::Rng;

use super::land::{height, shore};
use super::mesh::Mesh;
use super::noise::fbm;

/// Different stones.
const STONES: u32 = 3;
/// The viewer stands at the near shore, about here; what is farther away is too small to be seen.
const VIEWER: Vec2 = Vec2::new(1.2, -10.0);

/// Stones that stick out of the water: x, y and size.
const LARGE_STONES: [(f32, f32, f32); 6] = [
    (0.0, -8.8, 0.36),
    (0.5, -8.6, 0.2),
    (2.7, -8.3, 0.42),
    (3.2, -8.6, 0.2),
    (2.3, -8.7, 0.13),
    (-1.3, -9.3, 0.26),
];

pub fn make(folder: &Path) -> io::Result<()> {
    let mut text = BANK.to_owned();
    for i in 0..STONES {
        stone(i).write(&folder.join(format!("stone-{i}.ply")))?;
        let _ = writeln!(
            text,
            "ObjectBegin \"stone-{i}\" NamedMaterial \"stone\" Shape \"plymesh\" \"string filename\" \"stone-{i}.ply\" ObjectEnd"
        );
    }
    lily_leaf().write(&folder.join("lily.ply"))?;
    text += "ObjectBegin \"lily\" NamedMaterial \"lily\" Shape \"plymesh\" \"string filename\" \"lily.ply\" ObjectEnd\n";
    reed().write(&folder.join("reed.ply"))?;
    text += "ObjectBegin \"reed\" NamedMaterial \"reed\" Shape \"plymesh\" \"string filename\" \"reed.ply\" ObjectEnd\n";
    fs::write(folder.join("bed.pfm"), bed())?;
    fs::write(folder.join("bank.pbrt"), text + &stones() + &lilies() + &reeds())?;
    fs::write(folder.join("pond.pbrt"), VIEW)
}

/// The coordinate of textures for a height over the water: the picture of the bed goes from a metre
/// and a half below to as much above.
pub fn coordinate(height: f32) -> f32 {
    (0.5 + height / 3.0).clamp(0.0, 1.0)
}

/// How much soil there is for each height, as a picture in the format PFM: sand lies in the water
/// and at its edge.
fn bed() -> Vec<u8> {
    const WIDTH: u32 = 256;
    let mut file = format!("Pf\n{WIDTH} 1\n-1.0\n").into_bytes();
    for x in 0..WIDTH {
        let height = 3.0 * ((x as f32 + 0.5) / WIDTH as f32 - 0.5);
        let soil = ((height - 0.02) / 0.08).clamp(0.0, 1.0);
        file.extend(soil.to_le_bytes());
    }
    file
}

/// A stone about as large as the unit sphere: a sphere with bumps, worn flat.
fn stone(seed: u32) -> Mesh {
    const SIZE: [u32; 2] = [48, 25];
    let shift = 20.0 * seed as f32;
    let mut mesh = Mesh::default();
    mesh.ring(SIZE, |i, j| {
        let (sin_phi, cos_phi) = lanes::sin_cos(TAU * i as f32 / SIZE[0] as f32);
        // From below to above, but for the very poles, where a ring would have no direction.
        let theta = PI * (1.0 - j as f32 / (SIZE[1] - 1) as f32);
        let (sin, cos) = lanes::sin_cos(theta.clamp(0.004, PI - 0.004));
        let d = Vec3::new(sin * cos_phi, sin * sin_phi, cos);
        let bumps = fbm(1.3 * d.x + 0.8 * d.z + shift, 1.3 * d.y - 0.7 * d.z, 4);
        d * (1.0 + 0.45 * bumps) * Vec3::new(1.0, 0.8, 0.55)
    });
    mesh
}

/// A leaf of a water lily of radius 1: a disk with a notch, whose rim is bent up a little.
fn lily_leaf() -> Mesh {
    const SIDES: u32 = 40;
    let notch = 0.25;
    let mut points = vec![Vec3::new(-0.1, 0.0, 0.0)];
    for i in 0..=SIDES {
        let angle = notch + (TAU - 2.0 * notch) * i as f32 / SIDES as f32;
        let (sin, cos) = lanes::sin_cos(angle);
        points.push(Vec3::new(cos, sin, 0.05 + 0.03 * lanes::sin(5.0 * angle)));
    }
    let mut mesh = Mesh::default();
    mesh.fan(&points);
    mesh
}

/// A tuft of reeds, 1 high: long blades that bend outwards.
fn reed() -> Mesh {
    let mut rng = Rng::from_sequence(83);
    let mut mesh = Mesh::default();
    for _ in 0..26 {
        let (sin, cos) = lanes::sin_cos(TAU * rng.uniform_f32());
        let (out, across) = (Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0));
        let base = out * (0.1 * rng.uniform_f32().sqrt());
        let (height, bend) = (0.6 + 0.4 * rng.uniform_f32(), 0.05 + 0.3 * rng.uniform_f32());
        let at = |t: f32| base + Vec3::Z * (height * lanes::sin(0.5 * PI * t)) + out * (bend * t * t * t);
        let wide = |t: f32| across * (0.008 * (1.0 - t * t));
        for i in 0..8 {
            let [t, u] = [i, i + 1].map(|i| i as f32 / 8.0);
            mesh.fan(&[at(t) - wide(t), at(t) + wide(t), at(u) + wide(u), at(u) - wide(u)]);
        }
    }
    mesh
}

/// A place near the viewer whose distance from the middle of the pond, with the shore at 1, is
/// between these.
fn place(rng: &mut Rng, [inner, outer]: [f32; 2], reach: f32) -> Vec2 {
    loop {
        let p = VIEWER + reach * (2.0 * Vec2::new(rng.uniform_f32(), rng.uniform_f32()) - 1.0);
        if (inner..outer).contains(&shore(p.x, p.y)) {
            return p;
        }
    }
}

fn instance(name: &str, p: Vec3, turn: f32, size: Vec3) -> String {
    format!(
        "AttributeBegin Translate {} {} {} Rotate {turn} 0 0 1 Scale {} {} {} ObjectInstance \"{name}\" AttributeEnd\n",
        p.x, p.y, p.z, size.x, size.y, size.z
    )
}

/// Stones at the shore and in the water, many small ones and few large ones.
fn stones() -> String {
    let mut rng = Rng::from_sequence(61);
    let mut text = String::new();
    for (i, (x, y, size)) in LARGE_STONES.into_iter().enumerate() {
        let name = format!("stone-{}", i as u32 % STONES);
        text += &instance(&name, Vec3::new(x, y, -0.1 * size), 80.0 * i as f32, Vec3::splat(size));
    }
    for i in 0..900 {
        let p = place(&mut rng, [0.72, 1.04], 8.0);
        let u = rng.uniform_f32();
        let size = 0.03 + 0.17 * u * u * u;
        let z = height(p.x, p.y) + 0.25 * size;
        text += &instance(
            &format!("stone-{}", i % STONES),
            p.extend(z),
            360.0 * rng.uniform_f32(),
            Vec3::splat(size),
        );
    }
    text
}

/// Leaves on the water, in groups.
fn lilies() -> String {
    let mut rng = Rng::from_sequence(71);
    let mut taken = Vec::<(Vec2, f32)>::new();
    let mut text = String::new();
    for (middle, reach, count) in [([-1.6, -7.6], 1.5, 34), ([3.6, -6.4], 1.3, 24), ([-4.2, -4.0], 2.0, 30)] {
        for _ in 0..count {
            let (sin, cos) = lanes::sin_cos(TAU * rng.uniform_f32());
            let p = Vec2::from_array(middle) + reach * rng.uniform_f32() * Vec2::new(cos, 0.7 * sin);
            let size = 0.07 + 0.08 * rng.uniform_f32();
            if taken.iter().any(|(q, s)| q.distance(p) < 0.95 * (s + size)) {
                continue;
            }
            taken.push((p, size));
            text += &instance("lily", p.extend(0.012), 360.0 * rng.uniform_f32(), Vec3::splat(size));
        }
    }
    text
}

/// Reeds along the shore, in clumps.
fn reeds() -> String {
    let mut rng = Rng::from_sequence(73);
    let mut text = String::new();
    for _ in 0..900 {
        let p = place(&mut rng, [0.93, 1.02], 14.0);
        let size = 0.6 + 0.7 * rng.uniform_f32();
        // Not in front of the viewer.
        if fbm(0.5 * p.x + 3.0, 0.5 * p.y, 2) > 0.05 && (p.x - VIEWER.x).abs() > 1.1 {
            let z = height(p.x, p.y) - 0.02;
            text += &instance("reed", p.extend(z), 360.0 * rng.uniform_f32(), Vec3::splat(size));
        }
    }
    text
}

const VIEW: &str = r#"# The shore of the pond in the forest of `forest.pbrt`: stones, water lilies and reeds.
# Made by `cargo xtask scenes forest`. x is to the right, y into the picture, z up; metres.

Film "rgb" "integer xresolution" 720 "integer yresolution" 480 "string filename" "pond.png"
Sampler "zsobol" "integer pixelsamples" 64
Integrator "volpath" "integer maxdepth" 16

MakeNamedMedium "mist" "string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 0.0019 0.002 0.0021 ]
MediumInterface "" "mist"
LookAt 1.5 -12.6 1.5   0.2 0 -0.6   0 0 1
Camera "perspective" "float fov" 50

WorldBegin
Include "place.pbrt"
Include "bank.pbrt"
Include "plants.pbrt"
Include "meadow.pbrt"
Include "forest-trees.pbrt"
"#;

/// The same medium on both sides is none of a surface's own, so that stones can be half in water.
const BANK: &str = r#"# The ground with a bed of sand, and what lies on it.

MediumInterface "mist" "mist"
Texture "patches" "float" "fbm" "integer octaves" 5 "float roughness" 0.6
Texture "soil" "spectrum" "mix" "rgb tex1" [ 0.07 0.05 0.03 ] "rgb tex2" [ 0.06 0.09 0.025 ] "texture amount" "patches"
AttributeBegin
  Scale 0.12 0.12 0.12
  Texture "grains" "float" "fbm" "integer octaves" 5 "float roughness" 0.7
AttributeEnd
Texture "sand" "spectrum" "mix" "rgb tex1" [ 0.28 0.23 0.15 ] "rgb tex2" [ 0.4 0.34 0.235 ] "texture amount" "grains"
Texture "height" "float" "imagemap" "string filename" "bed.pfm" "string wrap" "clamp" "string encoding" "linear"
Texture "bed" "spectrum" "mix" "texture tex1" "sand" "texture tex2" "soil" "texture amount" "height"
Material "diffuse" "texture reflectance" "bed"
Shape "plymesh" "string filename" "ground.ply"

Texture "veins" "spectrum" "mix" "rgb tex1" [ 0.24 0.23 0.21 ] "rgb tex2" [ 0.33 0.315 0.28 ] "texture amount" "grains"
MakeNamedMaterial "stone" "string type" "diffuse" "texture reflectance" "veins"
MakeNamedMaterial "lily" "string type" "coateddiffuse" "rgb reflectance" [ 0.09 0.19 0.04 ] "float roughness" 0.25
MakeNamedMaterial "reed" "string type" "diffusetransmission" "rgb reflectance" [ 0.12 0.17 0.04 ] "rgb transmittance" [ 0.1 0.16 0.03 ]
"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stones_are_lumps_whose_normals_point_outwards() {
        for seed in 0..STONES {
            let stone = stone(seed);
            let outwards = stone.positions.iter().zip(&stone.normals).filter(|(p, n)| p.dot(**n) > 0.0);
            assert!(outwards.count() > stone.positions.len() * 9 / 10);
            assert!(stone.positions.iter().all(|p| p.length() > 0.2 && p.length() < 1.6));
        }
    }

    #[test]
    fn sand_ends_where_the_ground_leaves_the_water() {
        let bed = bed();
        let (_, soil) = bed.split_at(bed.len() - 4 * 256);
        let soil = |height: f32| {
            let at = 4 * (255.0 * coordinate(height)) as usize;
            f32::from_le_bytes([soil[at], soil[at + 1], soil[at + 2], soil[at + 3]])
        };
        assert_eq!([soil(-1.0), soil(-0.05), soil(0.2), soil(1.0)], [0.0, 0.0, 1.0, 1.0]);
    }
}
