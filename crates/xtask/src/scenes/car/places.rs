//! Where the car stands: a studio with soft boxes of light, and a street.

use std::fs;
use std::io;
use std::path::Path;

pub fn write(folder: &Path) -> io::Result<()> {
    fs::write(folder.join("car-studio.pbrt"), STUDIO)
}

const STUDIO: &str = r#"# A coupé in a studio: soft boxes over a dark floor that reflects.
# Made by `cargo xtask scenes car`. x is to the left, y ahead, z up; metres.

Film "rgb" "integer xresolution" 1920 "integer yresolution" 1080 "string filename" "car-studio.png"
Sampler "zsobol" "integer pixelsamples" 256
Integrator "path" "integer maxdepth" 12

LookAt 5.0 6.9 1.35   0.0 0.05 0.56   0 0 1
Camera "perspective" "float fov" 22

WorldBegin
LightSource "infinite" "rgb L" [ 0.012 0.013 0.015 ]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 5 5 5 ]
    Shape "bilinearmesh" "point3 P" [ -1.3 3.2 3.4  1.3 3.2 3.4  -1.3 -3.2 3.4  1.3 -3.2 3.4 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 3 3.1 3.3 ]
    Shape "bilinearmesh" "point3 P" [ 6 -4 0.9  6 4.5 0.9  6 -4 2.3  6 4.5 2.3 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 2 2 2.1 ]
    Shape "bilinearmesh" "point3 P" [ 2.5 9 0.9  -4 8 0.9  2.5 9 2.4  -4 8 2.4 ]
AttributeEnd
Material "openpbr" "rgb base_color" [ 0.02 0.02 0.022 ] "float specular_roughness" 0.22
Shape "bilinearmesh" "point3 P" [ -40 -40 0  40 -40 0  -40 40 0  40 40 0 ]
Include "car.pbrt"
"#;
