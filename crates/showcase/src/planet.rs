//! Small planets of 10⁵ and 10⁶ spheres, seen from outside and by one who walks there.
//!
//! Land and motion are those of `alhazen view --planet`: the picture is that of the smaller planet
//! after two seconds, and of the larger one, a step of which takes a second, after half of one.

use std::fs;
use std::io;
use std::path::Path;

use planet::{Input, Planet, Viewpoint, Walker, scene};

use crate::Size;

/// Planets by the power of ten of their spheres, and the steps of a sixtieth of a second before
/// they are seen.
const PLANETS: [(&str, usize, u32); 2] = [("5", 100_000, 120), ("6", 1_000_000, 30)];

pub fn make(folder: &Path, size: Size) -> io::Result<String> {
    let mut spheres = 0;
    for (power, count, steps) in PLANETS {
        let (count, steps) = if size == Size::Whole { (count, steps) } else { (count / 100, 2) };
        spheres += count;
        let mut planet = Planet::new(count);
        let mut walker = Walker::new(&planet);
        for _ in 0..steps {
            walker.step(&planet, &Input::default(), 1.0 / 60.0);
            planet.step(Some(walker.body()), 1.0 / 60.0);
        }
        let walk = walker.viewpoint(&planet);
        for (suffix, viewpoint) in [("", Viewpoint::of_all(&planet)), ("-walk", walk)] {
            let name = format!("planet-{power}{suffix}");
            fs::write(folder.join(format!("{name}.pbrt")), scene(&planet, &viewpoint, &name))?;
        }
    }
    Ok(format!("{} planets of {spheres} spheres in all", PLANETS.len()))
}
