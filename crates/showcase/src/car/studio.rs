//! A studio with soft boxes of light over a dark floor.

use std::fs;
use std::io;
use std::path::Path;

use math::Vec3;

use crate::mesh::Mesh;

/// Where the camera of the studio looks, on the ground.
const VIEW: [f32; 2] = [-0.587, -0.81];

pub fn write(folder: &Path) -> io::Result<()> {
    backdrop().write(&folder.join("backdrop.ply"))?;
    let whole = (["5.0 6.9 1.25   0.0 0.05 0.57", "19.5"], PATH, INCLUDED);
    let near = (["2.3 4.0 0.95   0.66 1.85 0.57", "17"], PATH, INCLUDED);
    let reflections = (whole.0, WHITTED, AS_OBJECT);
    for (name, ([look, angle], integrator, car)) in
        [("car-studio", whole), ("car-paint", near), ("car-reflections", reflections)]
    {
        let scene = STUDIO.replace("NAME", name).replace("LOOK", look).replace("ANGLE", angle);
        let scene = scene.replace("INTEGRATOR", integrator).replace("CAR", car);
        fs::write(folder.join(format!("{name}.pbrt")), scene)?;
    }
    Ok(())
}

const PATH: &str = "Integrator \"path\" \"integer maxdepth\" 12 \"bool regularize\" true";
const WHITTED: &str = "Integrator \"whitted\" \"integer maxdepth\" 5";

const INCLUDED: &str = "Include \"car.pbrt\"";
/// One object, of which a picture of its surroundings can be made. Its lamps are off, as `whitted`
/// sends a shadow ray to each of their triangles.
const AS_OBJECT: &str = "Include \"car-objects.pbrt\"
ObjectBegin \"car\"
Include \"car-parts.pbrt\"
ObjectEnd
ObjectInstance \"car\"";

/// The floor of the studio, which rises behind the car in an arc.
fn backdrop() -> Mesh {
    const FLOOR: f32 = 6.0;
    const RADIUS: f32 = 3.5;
    const HIGH: f32 = 9.0;
    let mut mesh = Mesh::default();
    mesh.grid([41, 66], |i, j| {
        let across = 1.5 * (i as f32 - 20.0);
        let (out, z, turn) = match j {
            0 => (-30.0, 0.0, 0.0),
            65 => (FLOOR + RADIUS, HIGH, 90.0_f32),
            j => {
                let turn = 90.0 * (j - 1) as f32 / 63.0;
                let (sin, cos) = lanes::sin_cos(turn.to_radians());
                (FLOOR + RADIUS * sin, RADIUS * (1.0 - cos), turn)
            }
        };
        let (sin, cos) = lanes::sin_cos(turn.to_radians());
        let [x, y] = VIEW;
        let p = Vec3::new(x * out + y * across, y * out - x * across, z);
        [p, Vec3::new(-x * sin, -y * sin, cos)]
    });
    mesh
}

const STUDIO: &str = r#"# A coupé in a studio: soft boxes over a dark floor that reflects.
# Made by `cargo xtask scenes car`. x is to the left, y ahead, z up; metres.

Film "rgb" "integer xresolution" 1920 "integer yresolution" 1080 "string filename" "NAME.png"
    "float maxcomponentvalue" 3
Sampler "zsobol" "integer pixelsamples" 256
INTEGRATOR

LookAt LOOK   0 0 1
Camera "perspective" "float fov" ANGLE

WorldBegin
# Above the car, beside it, and behind the camera.
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 5 5 5 ]
    Shape "bilinearmesh" "point3 P" [ -1.2 3.4 3.6  1.2 3.4 3.6  -1.2 -3.4 3.6  1.2 -3.4 3.6 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 2.6 2.75 3 ] "bool twosided" true
    Shape "bilinearmesh" "point3 P" [ 6.5 -6 0.5  6.5 3 0.5  6.5 -6 1.9  6.5 3 1.9 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 2.2 2.2 2.2 ] "bool twosided" true
    Shape "bilinearmesh" "point3 P" [ 1 9.5 0.6  -6 7.5 0.6  1 9.5 2.2  -6 7.5 2.2 ]
AttributeEnd
# Behind the car, and hidden by it, one that makes the backdrop glow.
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 110 114 122 ]
    Shape "bilinearmesh" "point3 P" [ -3.0 -2.2 0.05  -1.0 -3.7 0.05  -3.0 -2.2 0.3  -1.0 -3.7 0.3 ]
AttributeEnd
Material "openpbr" "rgb base_color" [ 0.05 0.051 0.055 ] "float specular_roughness" 0.16
Shape "plymesh" "string filename" "backdrop.ply"
CAR
"#;
