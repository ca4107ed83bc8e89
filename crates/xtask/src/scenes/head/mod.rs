//! A head, sculpted of formulas, in the light of a studio.
//!
//! The head is one solid, a field of signed distances (`sculpture.rs`), of which a mesh is made
//! (`nets.rs`) and given pores (`pores.rs`). Hairs grow along a field of directions (`hair.rs`).
//! The same head has skin that scatters by random walks, by diffusion, and not at all.

mod blend;
mod ear;
mod eyes;
mod face;
mod hair;
mod nets;
mod pores;
mod sculpture;
mod skin;
mod skull;
mod studio;

use std::fs;
use std::io;
use std::path::Path;

use math::Vec3;

use sculpture::Sculpture;

/// The box of the bust, in millimetres.
const LOW_HIGH: [Vec3; 2] = [Vec3 { x: -232.0, y: -128.0, z: -262.0 }, Vec3 { x: 232.0, y: 128.0, z: 128.0 }];

/// How fine a head is.
#[derive(Clone, Copy)]
pub struct Detail {
    /// Cells of the mesh, in millimetres.
    pub cell: f32,
    /// How often the triangles of the face are cut into four.
    pub steps: u32,
    pub hairs: usize,
}

impl Detail {
    /// Two million triangles and a hundred thousand hairs.
    pub const WHOLE: Self = Self { cell: 0.85, steps: 2, hairs: 100_000 };
}

/// Makes the scenes.
pub fn make(folder: &Path, detail: Detail) -> io::Result<()> {
    let solid = Sculpture::new();
    let mut mesh = nets::mesh(&solid, LOW_HIGH, detail.cell);
    let hairs = hair::scalp(&solid, &mesh, detail.hairs);
    pores::add(&mut mesh, &solid, detail.steps);
    mesh.uvs = mesh.positions.iter().map(|p| skin::coordinates(*p)).collect();
    mesh.write(&folder.join("skin.ply"))?;
    println!("{} triangles of skin, {} hairs", mesh.triangles.len(), hairs.len());

    eyes::balls().write(&folder.join("eyes.ply"))?;
    eyes::corneas().write(&folder.join("corneas.ply"))?;
    fs::write(folder.join("eyes.pfm"), eyes::colours(512))?;
    fs::write(folder.join("skin.pfm"), skin::colours(512))?;

    let (brows, lashes) = (hair::brows(&solid), hair::lashes());
    fs::write(folder.join("hair.pbrt"), hair::curves(&hairs))?;
    fs::write(folder.join("brows.pbrt"), hair::curves(&brows) + &hair::curves(&lashes))?;
    // A fifth of the hairs, twice as wide, for engines that draw triangles.
    let mut prisms = hair::prisms(&hairs, 5, 2.4);
    let add = |mesh: &mut crate::scenes::mesh::Mesh, hairs: &[hair::Hair]| {
        mesh.add(&hair::prisms(hairs, 1, 1.0), |p| p, |n| n);
    };
    add(&mut prisms, &brows);
    add(&mut prisms, &lashes);
    prisms.write(&folder.join("hair.ply"))?;
    studio::write(folder)
}
