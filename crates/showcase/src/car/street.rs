//! A street after rain, when the sun has set: houses with lit windows, lamps, a wet road.
//!
//! The sky is bright over the end of the street, where the sun went down, and dark above.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use math::Vec3;
use sampling::Rng;

use crate::mesh::Mesh;
use crate::noise::fbm;
use crate::picture;

/// The edge of the pavement, and the houses on both sides of the street, by x.
const KERB: f32 = -2.9;
const NEAR: f32 = -6.4;
const FAR: f32 = 24.0;
/// The height of the pavement.
const STEP: f32 = 0.13;

/// The meshes of houses.
#[derive(Default)]
struct Houses {
    /// Walls in three colours.
    walls: [Mesh; 3],
    panes: Mesh,
    lit: Mesh,
}

pub fn write(folder: &Path) -> io::Result<()> {
    fs::write(folder.join("dusk.pfm"), sky(1024))?;
    let houses = houses();
    for (i, walls) in houses.walls.iter().enumerate() {
        walls.write(&folder.join(format!("walls-{i}.ply")))?;
    }
    houses.panes.write(&folder.join("panes.ply"))?;
    houses.lit.write(&folder.join("lit-panes.ply"))?;
    pavement().write(&folder.join("pavement.ply"))?;
    lines().write(&folder.join("lines.ply"))?;
    posts().write(&folder.join("posts.ply"))?;
    let mut lamps = String::new();
    for y in LAMPS {
        let _ = writeln!(
            lamps,
            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 75 46 20 ] Translate {} {y} 4.62 Shape \"sphere\" \"float radius\" 0.13 AttributeEnd",
            KERB - 0.5
        );
    }
    fs::write(folder.join("street.pbrt"), format!("{PLACE}{lamps}"))?;
    fs::write(folder.join("car-street.pbrt"), VIEW)
}

/// A dusky sky as a picture over the sphere in the format PFM.
fn sky(size: u32) -> Vec<u8> {
    picture::sphere(size, |d| {
        let up = d.z.abs();
        // Towards the sunset, which is at −y.
        let west = d.dot(Vec3::new(-0.1, -0.99, 0.05)).clamp(0.0, 1.0);
        let glow = lanes::pow(west, 6.0) * lanes::exp(-5.0 * up);
        let band = lanes::exp(-3.2 * up);
        let clouds = fbm(1.2 * d.x / (up + 0.22), 2.4 * d.y / (up + 0.22), 5);
        let streaks = (0.5 + clouds).clamp(0.0, 1.0);
        let mut colour = Vec3::new(0.26, 0.37, 0.62) * (1.0 - 0.35 * up);
        colour += Vec3::new(0.26, 0.24, 0.28) * band;
        colour += Vec3::new(1.25, 0.5, 0.13) * glow;
        colour *= 0.75 + 0.5 * streaks;
        colour + Vec3::new(0.42, 0.17, 0.12) * (streaks * band * (0.2 + west))
    })
}

fn houses() -> Houses {
    let mut rng = Rng::from_sequence(3);
    let mut houses = Houses::default();
    for (x, way, y_end) in [(NEAR, 1.0, 26.0), (FAR, -1.0, 40.0)] {
        let (mut y, mut colour) = (-78.0, 0);
        while y < y_end {
            let bays = 3 + (4.0 * rng.uniform_f32()) as u32;
            let floors = 3 + (3.0 * rng.uniform_f32()) as u32;
            let set_back = 0.5 * (2.0 * rng.uniform_f32()).floor();
            let corner = Vec3::new(x - way * set_back, y, 0.0);
            house(corner, way, [bays, floors], colour, &mut rng, &mut houses);
            y += 2.6 * bays as f32 + if rng.uniform_f32() < 0.2 { 5.0 } else { 0.0 };
            colour = (colour + 1 + (2.0 * rng.uniform_f32()) as usize) % 3;
        }
    }
    houses
}

/// A house from a corner along y, whose front looks along `way` × x.
fn house(
    corner: Vec3,
    way: f32,
    [bays, floors]: [u32; 2],
    colour: usize,
    rng: &mut Rng,
    houses: &mut Houses,
) {
    const BAY: f32 = 2.6;
    const DEEP: f32 = 0.22;
    let (length, height) = (BAY * bays as f32, 4.2 + 3.1 * (floors - 1) as f32);
    let at = |y: f32, z: f32, deep: f32| corner + Vec3::new(-way * deep, y, z);
    let quad = |mesh: &mut Mesh, [a, b, c, d]: [Vec3; 4]| mesh.fan(&[a, b, c, d]);
    let wall = &mut houses.walls[colour];
    for floor in 0..floors {
        let shop = floor == 0;
        let low = if shop { 0.0 } else { 4.2 + 3.1 * (floor - 1) as f32 };
        let high = if shop { 4.2 } else { low + 3.1 };
        let (sill, top) = if shop { (0.55, 3.2) } else { (low + 0.85, low + 2.55) };
        for bay in 0..bays {
            let (left, right) = (BAY * bay as f32, BAY * (bay + 1) as f32);
            let half = if shop { 1.05 } else { 0.58 };
            let (a, b) = (0.5 * (left + right) - half, 0.5 * (left + right) + half);
            for [y0, y1, z0, z1] in [
                [left, right, low, sill],
                [left, right, top, high],
                [left, a, sill, top],
                [b, right, sill, top],
            ] {
                quad(wall, [at(y0, z0, 0.0), at(y1, z0, 0.0), at(y1, z1, 0.0), at(y0, z1, 0.0)]);
            }
            for [[y0, z0], [y1, z1]] in
                [[[a, sill], [b, sill]], [[a, top], [b, top]], [[a, sill], [a, top]], [[b, sill], [b, top]]]
            {
                quad(wall, [at(y0, z0, 0.0), at(y1, z1, 0.0), at(y1, z1, DEEP), at(y0, z0, DEEP)]);
            }
            let is_lit = rng.uniform_f32() < if shop { 0.55 } else { 0.22 };
            let panes = if is_lit { &mut houses.lit } else { &mut houses.panes };
            // Two panes with a bar between them.
            for [y0, y1] in [[a + 0.05, 0.5 * (a + b) - 0.03], [0.5 * (a + b) + 0.03, b - 0.05]] {
                let (z0, z1) = (sill + 0.05, top - 0.05);
                quad(panes, [at(y0, z0, DEEP), at(y1, z0, DEEP), at(y1, z1, DEEP), at(y0, z1, DEEP)]);
            }
            quad(
                wall,
                [
                    at(a, sill, DEEP + 0.01),
                    at(b, sill, DEEP + 0.01),
                    at(b, top, DEEP + 0.01),
                    at(a, top, DEEP + 0.01),
                ],
            );
        }
    }
    // A cornice, the ends, and the roof.
    for (z, out) in [(4.0, 0.12), (height - 0.3, 0.25)] {
        let top = z + 0.3;
        quad(wall, [at(0.0, z, -out), at(length, z, -out), at(length, top, -out), at(0.0, top, -out)]);
        for z in [z, top] {
            quad(wall, [at(0.0, z, 0.0), at(length, z, 0.0), at(length, z, -out), at(0.0, z, -out)]);
        }
    }
    for y in [0.0, length] {
        quad(wall, [at(y, 0.0, 0.0), at(y, 0.0, 11.0), at(y, height, 11.0), at(y, height, 0.0)]);
    }
    quad(
        wall,
        [
            at(0.0, height, 0.0),
            at(length, height, 0.0),
            at(length, height + 3.0, 5.5),
            at(0.0, height + 3.0, 5.5),
        ],
    );
}

/// The pavement with its kerb of stones.
fn pavement() -> Mesh {
    let mut mesh = Mesh::default();
    let mut y = -80.0;
    while y < 40.0 {
        let [y0, y1] = [y, y + 0.99];
        let edge = [[KERB, 0.0], [KERB, STEP - 0.02], [KERB - 0.02, STEP], [KERB - 0.16, STEP]];
        for pair in edge.windows(2) {
            let [[x0, z0], [x1, z1]] = [pair[0], pair[1]];
            mesh.fan(&[
                Vec3::new(x0, y0, z0),
                Vec3::new(x0, y1, z0),
                Vec3::new(x1, y1, z1),
                Vec3::new(x1, y0, z1),
            ]);
        }
        y += 1.0;
    }
    let z = STEP - 0.004;
    mesh.fan(&[
        Vec3::new(KERB - 0.15, -80.0, z),
        Vec3::new(KERB - 0.15, 40.0, z),
        Vec3::new(NEAR - 2.0, 40.0, z),
        Vec3::new(NEAR - 2.0, -80.0, z),
    ]);
    mesh
}

/// White lines in the middle of the road.
fn lines() -> Mesh {
    let mut mesh = Mesh::default();
    for i in -18..8 {
        let y = 4.5 * i as f32;
        let [a, b] = [2.25, 2.37];
        mesh.fan(&[[a, y], [b, y], [b, y + 2.4], [a, y + 2.4]].map(|[x, y]| Vec3::new(x, y, 0.003)));
    }
    mesh
}

/// Where lamps stand along the street.
const LAMPS: [f32; 5] = [-50.0, -35.0, -20.0, -7.0, 8.0];

fn posts() -> Mesh {
    let mut mesh = Mesh::default();
    for y in LAMPS {
        let points = [(0.0, 0.09), (0.9, 0.085), (1.0, 0.055), (4.35, 0.04), (4.42, 0.07), (4.5, 0.08)];
        mesh.tube(&points.map(|(z, r)| (Vec3::new(KERB - 0.5, y, STEP + z), r)), 24);
        mesh.tube(
            &[(4.62, 0.13), (4.72, 0.10), (4.78, 0.02)].map(|(z, r)| (Vec3::new(KERB - 0.5, y, STEP + z), r)),
            24,
        );
    }
    mesh
}

const VIEW: &str = r#"# A coupé in a street after rain.
# Made by `cargo xtask scenes car`. x is to the left, y ahead, z up; metres.

Film "rgb" "integer xresolution" 1920 "integer yresolution" 1080 "string filename" "car-street.png"
    "float maxcomponentvalue" 8
Sampler "zsobol" "integer pixelsamples" 256
Integrator "path" "integer maxdepth" 8 "bool regularize" true

LookAt 3.55 7.1 0.8   0.2 -0.25 0.76   0 0 1
Camera "perspective" "float fov" 24

WorldBegin
Include "street.pbrt"
Include "car.pbrt"
"#;

const PLACE: &str = r#"# Sky, road and houses.

LightSource "infinite" "string filename" "dusk.pfm" "float scale" 1

Texture "puddles" "float" "fbm" "integer octaves" 4 "float roughness" 0.5
AttributeBegin
    Scale 0.9 2.2 1
    Texture "puddle shapes" "float" "fbm" "integer octaves" 3 "float roughness" 0.5
AttributeEnd
Texture "wet" "float" "step" "texture tex" "puddle shapes" "float edge" 0.08
AttributeBegin
    Scale 0.012 0.012 0.012
    Texture "gravel" "float" "fbm" "integer octaves" 3 "float roughness" 0.6
AttributeEnd
Texture "gravel height" "float" "scale" "texture tex" "gravel" "float scale" 0.0022
Texture "gravel colour" "spectrum" "mix" "rgb tex1" [ 0.028 0.028 0.03 ] "rgb tex2" [ 0.055 0.055 0.055 ] "texture amount" "gravel"
MakeNamedMaterial "asphalt" "string type" "openpbr" "texture base_color" "gravel colour" "float specular_roughness" 0.38
    "texture displacement" "gravel height"
MakeNamedMaterial "water" "string type" "openpbr" "rgb base_color" [ 0.02 0.02 0.021 ] "float specular_roughness" 0.03 "float specular_ior" 1.33
MakeNamedMaterial "road" "string type" "mix" "texture amount" "wet" "string materials" [ "asphalt" "water" ]
NamedMaterial "road"
Shape "bilinearmesh" "point3 P" [ -200 -300 0  200 -300 0  -200 300 0  200 300 0 ]
Material "openpbr" "rgb base_color" [ 0.45 0.45 0.43 ] "float specular_roughness" 0.35
Shape "plymesh" "string filename" "lines.ply"
Material "openpbr" "rgb base_color" [ 0.13 0.125 0.12 ] "float specular_roughness" 0.3
Shape "plymesh" "string filename" "pavement.ply"
Material "openpbr" "rgb base_color" [ 0.32 0.22 0.16 ] "float specular_roughness" 0.8
Shape "plymesh" "string filename" "walls-0.ply"
Material "openpbr" "rgb base_color" [ 0.36 0.33 0.28 ] "float specular_roughness" 0.8
Shape "plymesh" "string filename" "walls-1.ply"
Material "openpbr" "rgb base_color" [ 0.22 0.1 0.075 ] "float specular_roughness" 0.8
Shape "plymesh" "string filename" "walls-2.ply"
Material "openpbr" "rgb base_color" [ 0.01 0.011 0.012 ] "float specular_roughness" 0.02
Shape "plymesh" "string filename" "panes.ply"
Material "openpbr" "rgb base_color" [ 0.02 0.02 0.02 ] "float specular_roughness" 0.4
Shape "plymesh" "string filename" "posts.ply"
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 1.05 0.62 0.27 ] "bool twosided" true
    Shape "plymesh" "string filename" "lit-panes.ply"
AttributeEnd
"#;
