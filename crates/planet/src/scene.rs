//! A planet as it is, as a scene in the pbrt format.

use std::fmt::Write as _;

use math::{Point3, Vec3, Vector3};

use crate::{Planet, Substance};

/// From where a picture is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// The place of the eyes.
    pub eyes: Point3,
    /// Where they look.
    pub gaze: Vector3,
    /// Upwards.
    pub up: Vector3,
    /// The field of view in degrees.
    pub fov: f32,
}

impl Viewpoint {
    /// All of a planet, from outside.
    pub fn of_all(planet: &Planet) -> Self {
        let from = Vec3::new(0.78, -0.42, 0.46).normalize();
        Self { eyes: from * (3.3 * planet.radius()), gaze: -from, up: Vector3::Z, fov: 44.0 }
    }
}

/// The scene: sun and sky, and for each substance that occurs one set of spheres, in the order of
/// [`Substance::ALL`]. `name` is that of its picture.
pub fn scene(planet: &Planet, viewpoint: &Viewpoint, name: &str) -> String {
    let bodies = planet.bodies();
    let Viewpoint { eyes, gaze, up, fov } = viewpoint;
    let mut text = format!("# A small planet of {} spheres. Metres.\n\n{SETTINGS}", bodies.len());
    text = text.replace("NAME", name);
    let vector = |v: Vec3| format!("{} {} {}", v.x, v.y, v.z);
    // Writing to a string cannot fail.
    // The format's camera has its right along up × forward, a mirrored one along forward × up.
    let _ = writeln!(
        text,
        "Scale -1 1 1\nLookAt {}   {}   {}",
        vector(*eyes),
        vector(*eyes + *gaze),
        vector(*up)
    );
    let _ = writeln!(text, "Camera \"perspective\" \"float fov\" {fov}\n\n{LIGHT}");
    for substance in Substance::ALL {
        let range = bodies.range(substance);
        if range.is_empty() {
            continue;
        }
        let _ = write!(text, "Material {}\nShape \"spheres\"\n  \"float radius\" [", substance.material());
        for (i, radius) in bodies.radius[range.clone()].iter().enumerate() {
            let _ = write!(text, "{}{radius}", if i % 16 == 0 { "\n" } else { " " });
        }
        text += " ]\n  \"point3 P\" [";
        for (i, center) in bodies.center[range].iter().enumerate() {
            let _ = write!(text, "{}{}", if i % 4 == 0 { "\n" } else { "  " }, vector(*center));
        }
        text += " ]\n";
    }
    text
}

const SETTINGS: &str = r#"Film "rgb" "integer xresolution" 640 "integer yresolution" 480 "string filename" "NAME.png"
Sampler "zsobol" "integer pixelsamples" 64
Integrator "whitted" "integer maxdepth" 4
"#;

const LIGHT: &str = r#"WorldBegin
LightSource "distant" "rgb L" [ 3.1 2.85 2.5 ] "point3 from" [ 0.75 -0.9 0.62 ] "point3 to" [ 0 0 0 ]
LightSource "infinite" "rgb L" [ 0.2 0.3 0.47 ]
"#;
