//! Small planets of 10⁵ and 10⁶ spheres, seen from outside and by one who walks there.
//!
//! Land and motion are those of `alhazen view --planet`: the picture is that of the planet after
//! some seconds, when most of what has fallen rests.

use std::fs;
use std::io;
use std::path::Path;

use planet::{Input, Planet, Viewpoint, Walker, scene};

/// Planets by the power of ten of their spheres.
const PLANETS: [(&str, usize); 2] = [("5", 100_000), ("6", 1_000_000)];

/// Steps of a sixtieth of a second.
const STEPS: u32 = 240;

pub fn make(folder: &Path) -> io::Result<()> {
    for (power, count) in PLANETS {
        let mut planet = Planet::new(count);
        let mut walker = Walker::new(&planet);
        for _ in 0..STEPS {
            walker.step(&planet, &Input::default(), 1.0 / 60.0);
            planet.step(Some(walker.body()), 1.0 / 60.0);
        }
        let walk = walker.viewpoint(&planet);
        for (suffix, viewpoint) in [("", Viewpoint::of_all(&planet)), ("-walk", walk)] {
            let name = format!("planet-{power}{suffix}");
            fs::write(folder.join(format!("{name}.pbrt")), scene(&planet, &viewpoint, &name))?;
        }
    }
    Ok(())
}
