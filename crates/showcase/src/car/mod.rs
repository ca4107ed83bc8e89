//! A coupé in a studio and on a street.
//!
//! The body is drawn as a control cage (`body.rs`), subdivided, and then cut into panels
//! (`panels.rs`). What is fixed to it is placed by rays onto its surface (`fittings.rs`).

mod body;
mod fittings;
mod interior;
mod paint;
mod panels;
mod street;
mod studio;
mod trim;
mod wheel;

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use math::Vec3;

use super::mesh::Mesh;
use body::{AXLES, PANELS, Panel};
use panels::{Edge, Surface};

/// The files of the car while they are made.
struct Car<'a> {
    folder: &'a Path,
    /// The statements.
    text: String,
    /// Triangles of the files.
    triangles: usize,
}

impl Car<'_> {
    fn part(&mut self, name: &str, material: &str, mesh: &Mesh) -> io::Result<()> {
        mesh.write(&self.folder.join(format!("{name}.ply")))?;
        self.triangles += mesh.triangles.len();
        let _ = writeln!(
            self.text,
            "NamedMaterial \"{material}\" Shape \"plymesh\" \"string filename\" \"{name}.ply\""
        );
        Ok(())
    }
}

/// Makes the scenes, with a car that is subdivided in `steps` steps; one less has a fourth of the
/// triangles.
pub fn make(folder: &Path, steps: u32) -> io::Result<String> {
    let surface = Surface::new(body::cage().subdivided(steps));
    let sides = 6 << steps;
    let fine = steps.saturating_sub(1);
    let mut car = Car { folder, text: String::new(), triangles: 0 };
    panels(&mut car, &surface, fine)?;

    car.part("board", "leather", &interior::board(fine))?;
    car.part("seats", "seat leather", &interior::seats(fine))?;
    car.part("steering", "leather", &interior::steering(sides / 4))?;
    let mut mirrors = fittings::mirrors(fine);
    mirrors.uvs = mirrors.positions.iter().map(|p| p.truncate() * paint::SCALE).collect();
    car.part("mirrors", "paint", &mirrors)?;
    car.part("mirror-glass", "chrome", &fittings::mirror_glass(fine))?;
    car.part("handles", "chrome", &fittings::handles(&surface, fine))?;
    car.part("grille-slats", "chrome", &fittings::grille(&surface))?;
    car.part("exhausts", "chrome", &fittings::exhausts(sides / 2))?;
    car.part("wipers", "plastic", &fittings::wipers(&surface))?;
    car.part("badges", "chrome", &fittings::badges(&surface, sides / 2))?;
    let is_side = |p| matches!(p, Panel::DoorGlass | Panel::QuarterGlass);
    car.part("window-trim", "chrome", &trim::strips(&surface, is_side, 0.0045, 0.0005))?;
    car.part("grille-trim", "chrome", &trim::strips(&surface, |p| p == Panel::Grille, 0.006, 0.0))?;
    place_lamps(&mut car.text, &fittings::projectors(&surface));
    place_wheels(&mut car.text);
    fs::write(folder.join("car-parts.pbrt"), std::mem::take(&mut car.text))?;

    objects(&mut car, sides, fine)?;
    fs::write(folder.join("flakes.pfm"), paint::flakes(512))?;
    let objects = std::mem::take(&mut car.text);
    fs::write(folder.join("car-objects.pbrt"), format!("{}{objects}", paint::MATERIALS))?;

    car.text += "Include \"car-objects.pbrt\"\nInclude \"car-parts.pbrt\"\n";
    car.text += "AttributeBegin\n  AreaLightSource \"diffuse\" \"rgb L\" [ 9 9.4 10 ]\n  ";
    car.part("daylight", "plastic", &fittings::daylight(&surface))?;
    car.text += "AttributeEnd\nAttributeBegin\n  AreaLightSource \"diffuse\" \"rgb L\" [ 2.4 0.06 0.03 ]\n  ";
    car.part("taillight", "plastic", &fittings::taillight(&surface))?;
    car.text += "AttributeEnd\n";
    fs::write(folder.join("car.pbrt"), &car.text)?;
    studio::write(folder)?;
    street::write(folder)?;
    Ok(format!("{} triangles in files", car.triangles))
}

/// The outside, and a dark lining under all that is not transparent.
fn panels(car: &mut Car, surface: &Surface, fine: u32) -> io::Result<()> {
    let sheet = Edge { gap: 0.0018, bend: 0.0022, flange: 0.02, depth: 0.0 };
    let pane = Edge { gap: 0.0012, bend: 0.0015, flange: 0.006, depth: 0.002 };
    for panel in PANELS {
        let (end, material) = match panel {
            Panel::TailLamp => (pane, "red glass"),
            panel if panel.is_clear() => (pane, "glass"),
            Panel::Cowl | Panel::Splitter | Panel::Diffuser | Panel::Sill => (sheet, "plastic"),
            Panel::Grille | Panel::Intake => (Edge { depth: 0.05, ..sheet }, "mesh"),
            _ => (sheet, "paint"),
        };
        let name = format!("{panel:?}").to_lowercase();
        car.part(&name, material, &surface.panel(|other| other == panel, end))?;
    }
    let is_lined = |panel: Panel| !panel.is_clear() && panel != Panel::Grille;
    let coarse = Surface::new(body::cage().subdivided(fine.max(2) - 1));
    car.part("lining", "lining", &coarse.sheet(is_lined, 0.022))?;
    car.part(
        "headlamp-bowl",
        "bowl",
        &surface.panel(|p| p == Panel::Headlamp, Edge { gap: 0.004, bend: 0.0, flange: 0.05, depth: 0.07 }),
    )?;
    car.part("taillamp-bowl", "bowl", &surface.sheet(|p| p == Panel::TailLamp, 0.03))
}

/// Parts that are there more than once.
fn objects(car: &mut Car, sides: u32, fine: u32) -> io::Result<()> {
    car.text += "ObjectBegin \"wheel\"\n";
    car.part("tyre", "rubber", &wheel::tyre(6 * sides, 2 * sides / 3))?;
    car.part("rim", "alloy", &wheel::rim(sides * 2, fine))?;
    car.part("disc", "steel", &wheel::disc(sides * 2))?;
    car.text += "ObjectEnd\nObjectBegin \"caliper\"\n";
    car.part("caliper", "caliper", &wheel::caliper(fine))?;
    car.text += "ObjectEnd\nObjectBegin \"well\"\n";
    car.part("well", "lining", &fittings::well(sides))?;
    car.text += "ObjectEnd\nObjectBegin \"projector\"\n";
    car.part("projector", "chrome", &fittings::projector(sides / 2))?;
    car.text +=
        "NamedMaterial \"crystal\" Translate -0.012 0 0 Shape \"sphere\" \"float radius\" 0.03\nObjectEnd\n";
    Ok(())
}

fn place_lamps(text: &mut String, places: &[Vec3]) {
    for p in places {
        for x in [p.x, -p.x] {
            let _ = writeln!(
                text,
                "AttributeBegin Translate {x} {} {} Rotate 90 0 0 1 ObjectInstance \"projector\" AttributeEnd",
                p.y, p.z
            );
        }
    }
}

fn place_wheels(text: &mut String) {
    for (axle, half, steer) in [(AXLES[0], 0.775, 7.0), (AXLES[1], 0.798, 0.0)] {
        for (side, turn) in [(1.0, 0.0), (-1.0, 180.0)] {
            let x = side * half;
            let _ = writeln!(
                text,
                "AttributeBegin Translate {x} {axle} {} Rotate {} 0 0 1 \
                 ObjectInstance \"wheel\" Rotate {} 1 0 0 ObjectInstance \"caliper\" AttributeEnd",
                body::WHEEL,
                turn + steer,
                if side > 0.0 { -75.0 } else { -105.0 },
            );
            let _ = writeln!(
                text,
                "AttributeBegin Translate {x} {axle} {} Rotate {turn} 0 0 1 ObjectInstance \"well\" AttributeEnd",
                body::WHEEL
            );
        }
    }
    *text += "NamedMaterial \"lining\" Shape \"bilinearmesh\" \"point3 P\" [ -0.7 -1.9 0.17  0.7 -1.9 0.17  -0.7 1.6 0.17  0.7 1.6 0.17 ]\n";
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// The files of a car of so many steps.
    fn files(name: &str, steps: u32) -> BTreeMap<String, Vec<u8>> {
        let folder = std::env::temp_dir().join(format!("{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        make(&folder, steps).unwrap();
        let read = |entry: io::Result<fs::DirEntry>| {
            let entry = entry.unwrap();
            (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())
        };
        let files = fs::read_dir(&folder).unwrap().map(read).collect();
        fs::remove_dir_all(&folder).unwrap();
        files
    }

    /// The triangles of a file.
    fn triangles(file: &[u8]) -> usize {
        let head = String::from_utf8_lossy(&file[..400.min(file.len())]).into_owned();
        let line = head.lines().find_map(|line| line.strip_prefix("element face ")).unwrap();
        line.parse().unwrap()
    }

    #[test]
    fn the_same_files_are_made_again() {
        let [a, b] = ["car-a", "car-b"].map(|name| files(name, 2));
        assert!(a == b);
        // All that scenes refer to is there.
        for (_, text) in a.iter().filter(|(name, _)| name.ends_with(".pbrt")) {
            let text = String::from_utf8_lossy(text);
            let named = text.split('"').filter(|word| word.ends_with(".ply") || word.ends_with(".pfm"));
            assert!(named.into_iter().all(|name| a.contains_key(name)));
        }
    }

    #[test]
    fn a_step_makes_four_triangles_of_one() {
        let [coarse, fine] = [2, 3].map(|steps| files(&format!("car-{steps}"), steps));
        for name in ["bonnet.ply", "door.ply", "seats.ply"] {
            let ratio = triangles(&fine[name]) as f32 / triangles(&coarse[name]) as f32;
            assert!((3.0..4.3).contains(&ratio), "{name}: {ratio}");
        }
    }
}
