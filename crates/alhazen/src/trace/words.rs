//! Traces in words.

use std::fmt;

use math::Vec3;

use super::{PixelTrace, SampleTrace, TraceStep, Way};

impl fmt::Display for PixelTrace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.pixel;
        for (i, sample) in self.samples.iter().enumerate() {
            let gap = if i > 0 { "\n" } else { "" };
            let nanometres: Vec<_> = sample.wavelengths.iter().map(|l| format!("{l:.0}")).collect();
            let nanometres = nanometres.join(", ");
            writeln!(f, "{gap}sample {} of pixel {x}, {y}, at {nanometres} nm", sample.index)?;
            write!(f, "{sample}")?;
        }
        Ok(())
    }
}

impl fmt::Display for SampleTrace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut vertex = 0;
        for step in &self.steps {
            match step {
                TraceStep::Ray { way, vertex: of, from, d, hit } => {
                    let way = match way {
                        Way::Camera => format!("a ray leaves the camera at {}", Point(*from)),
                        Way::Reflected => "a ray is reflected".into(),
                        Way::Transmitted => "a ray is transmitted".into(),
                        Way::Scattered => "a ray goes on from there".into(),
                        Way::Onward => "the ray goes straight on".into(),
                    };
                    let earlier = *of > 0 && *of < vertex;
                    let place = if earlier { format!("at {of} ") } else { String::new() };
                    write!(f, "  {place}{way} along {} and ", Point(*d))?;
                    match hit {
                        Some((length, object)) => writeln!(f, "hits `{object}` after {length:.4}")?,
                        None => writeln!(f, "leaves the scene")?,
                    }
                }
                TraceStep::Surface { p, material, lobes } => {
                    vertex += 1;
                    writeln!(f, "{vertex}. material `{material}` at {}: {lobes}", Point(*p))?;
                }
                TraceStep::Medium { p } => {
                    vertex += 1;
                    writeln!(f, "{vertex}. a medium scatters light at {}", Point(*p))?;
                }
                TraceStep::Shadow { d, length, is_clear, .. } => {
                    let to = match length.is_finite() {
                        true => format!("over {length:.4} along {}", Point(*d)),
                        false => format!("along {}", Point(*d)),
                    };
                    let end = if *is_clear { "nothing is in its way" } else { "something is in its way" };
                    writeln!(f, "  a shadow ray {to}: {end}")?;
                }
                TraceStep::Light { name, events, rgb } => {
                    let events = match events {
                        0 => "not scattered".into(),
                        1 => "scattered once".into(),
                        n => format!("scattered {n} times"),
                    };
                    writeln!(f, "  light from {name}, {events}, brings {}", Color(*rgb))?;
                }
            }
        }
        writeln!(f, "  together {}", Color(self.rgb))
    }
}

struct Point(Vec3);

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Adding zero makes −0 a 0.
        let [x, y, z] = self.0.to_array().map(|x| (x * 1e4).round() / 1e4 + 0.0);
        write!(f, "({x}, {y}, {z})")
    }
}

struct Color([f32; 3]);

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "rgb ({r:.4}, {g:.4}, {b:.4})")
    }
}
