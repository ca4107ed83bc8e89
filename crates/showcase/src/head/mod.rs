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
const LOW_HIGH: [Vec3; 2] = [Vec3 { x: -232.0, y: -128.0, z: -236.0 }, Vec3 { x: 232.0, y: 128.0, z: 128.0 }];

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
    pub const WHOLE: Self = Self { cell: 1.15, steps: 2, hairs: 100_000 };
    /// A few thousand triangles.
    pub const SMALL: Self = Self { cell: 6.0, steps: 1, hairs: 200 };
}

/// Makes the scenes.
pub fn make(folder: &Path, detail: Detail) -> io::Result<String> {
    let solid = Sculpture::new();
    let mut mesh = nets::mesh(&solid, LOW_HIGH, detail.cell);
    let hairs = hair::scalp(&solid, &mesh, detail.hairs);
    pores::add(&mut mesh, &solid, detail.steps);
    mesh.uvs = mesh.positions.iter().map(|p| skin::coordinates(*p)).collect();
    mesh.write(&folder.join("skin.ply"))?;

    eyes::balls().write(&folder.join("eyes.ply"))?;
    eyes::corneas().write(&folder.join("corneas.ply"))?;
    fs::write(folder.join("eyes.pfm"), eyes::colours(512))?;
    fs::write(folder.join("skin.pfm"), skin::colours(512))?;

    let (brows, lashes) = (hair::brows(&solid), hair::lashes());
    fs::write(folder.join("hair.pbrt"), hair::curves(&hairs))?;
    fs::write(folder.join("brows.pbrt"), hair::curves(&brows) + &hair::curves(&lashes))?;
    fs::write(folder.join("hair-realtime.pbrt"), hair::curves(&hair::thinned(&hairs, 5, 2.4)))?;
    studio::write(folder)?;
    Ok(format!("{} triangles of skin, {} hairs", mesh.triangles.len(), hairs.len()))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// The files of a coarse head.
    fn files(name: &str) -> BTreeMap<String, Vec<u8>> {
        let folder = std::env::temp_dir().join(format!("{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        make(&folder, Detail::SMALL).unwrap();
        let read = |entry: io::Result<fs::DirEntry>| {
            let entry = entry.unwrap();
            (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())
        };
        let files = fs::read_dir(&folder).unwrap().map(read).collect();
        fs::remove_dir_all(&folder).unwrap();
        files
    }

    #[test]
    fn the_same_files_are_made_again() {
        let [a, b] = ["head-a", "head-b"].map(files);
        assert!(a == b);
        // All that scenes refer to is there.
        for (_, text) in a.iter().filter(|(name, _)| name.starts_with("head")) {
            let text = String::from_utf8_lossy(text);
            let is_file = |word: &&str| [".ply", ".pfm", ".pbrt"].iter().any(|end| word.ends_with(end));
            let mut named = text.split('"').filter(is_file);
            assert!(named.all(|name| a.contains_key(name)));
        }
    }

    #[test]
    fn a_head_has_the_proportions_of_heads() {
        let solid = Sculpture::new();
        let is_inside = |x: f32, y: f32, z: f32| solid.distance(Vec3::new(x, y, z)) < 0.0;
        let reach = |inside: &dyn Fn(f32) -> bool| (0..200).rev().map(|i| i as f32).find(|v| inside(*v));
        let top = reach(&|z| is_inside(0.0, -10.0, z)).unwrap();
        let side = reach(&|x| is_inside(x, -32.0, 42.0)).unwrap();
        let chin = solid.front(0.0, -100.0);
        // The eyes are at half of the height, and the head is two thirds as wide as high.
        assert!((105.0..125.0).contains(&top) && (68.0..82.0).contains(&side), "{top} {side}");
        assert!(chin.y > 80.0 && solid.front(0.0, -42.0).y > chin.y + 8.0, "{chin}");
    }
}
