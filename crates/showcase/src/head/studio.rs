//! The light of a studio, materials, and views.

use std::fs;
use std::io;
use std::path::Path;

/// A name, the materials, and where the camera is, what it looks at, and its angle.
const VIEWS: [(&str, &str, &str, &str); 5] = [
    ("head", WALK, PORTRAIT, "12.2"),
    ("head-diffusion", DIFFUSION, PORTRAIT, "12.2"),
    ("head-realtime", REALTIME, PORTRAIT, "12.2"),
    ("head-face", WALK, "-520 960 30   2 60 -32", "8.2"),
    ("head-eye", WALK, "-420 800 10   -30 76 -2", "3.6"),
];
const PORTRAIT: &str = "-560 1060 40   0 0 -6";

pub fn write(folder: &Path) -> io::Result<()> {
    for (name, materials, look, angle) in VIEWS {
        let shapes = if materials == REALTIME { "" } else { SHAPES };
        let scene = [&HEAD.replace("NAME", name), materials, shapes, LIGHT].concat();
        fs::write(folder.join(format!("{name}.pbrt")), scene.replace("LOOK", look).replace("ANGLE", angle))?;
    }
    Ok(())
}

const HEAD: &str = r#"# A head in the light of a studio.
# Made by `cargo xtask scenes head`. x is to its left, y ahead, z up; millimetres.

Film "rgb" "integer xresolution" 960 "integer yresolution" 1200 "string filename" "NAME.png"
    "float maxcomponentvalue" 2.5
Sampler "zsobol" "integer pixelsamples" 256
Integrator "path" "integer maxdepth" 6 "bool regularize" true "string lightsampler" "power"

LookAt LOOK   0 0 1
Camera "perspective" "float fov" ANGLE

WorldBegin
Texture "skin colour" "spectrum" "imagemap" "string filename" "skin.pfm" "string wrap" "clamp"
Texture "eye colour" "spectrum" "imagemap" "string filename" "eyes.pfm"
"#;

/// Light that goes on under the skin, followed by random walks, under two specular lobes: that of
/// the skin, and a thin film of oil.
const WALK: &str = r#"
MakeNamedMaterial "skin" "string type" "openpbr" "float subsurface_weight" 1 "texture subsurface_color" "skin colour"
    "float subsurface_radius" 1.5 "rgb subsurface_radius_scale" [ 1 0.42 0.24 ] "float specular_ior" 1.4
    "float specular_roughness" 0.52 "float coat_weight" 0.35 "float coat_roughness" 0.3 "float coat_ior" 1.35
"#;

/// The same by a diffusion profile, and a single lobe.
const DIFFUSION: &str = r#"
MakeNamedMaterial "skin" "string type" "subsurface" "string method" "diffusion" "texture reflectance" "skin colour"
    "rgb mfp" [ 1.5 0.63 0.36 ] "float eta" 1.4 "float roughness" 0.22
"#;

/// No light under the skin; no cornea; a fifth of the hairs, twice as wide.
const REALTIME: &str = r#"
MakeNamedMaterial "skin" "string type" "coateddiffuse" "texture reflectance" "skin colour" "float roughness" 0.25 "float eta" 1.4
MakeNamedMaterial "white" "string type" "coateddiffuse" "texture reflectance" "eye colour" "float roughness" 0.01
MakeNamedMaterial "hairs" "string type" "hair" "float eumelanin" 2.2 "float pheomelanin" 0.5 "float beta_m" 0.28 "float beta_n" 0.3
MakeNamedMaterial "lashes" "string type" "hair" "float eumelanin" 5
NamedMaterial "skin" Shape "plymesh" "string filename" "skin.ply"
NamedMaterial "white" Shape "plymesh" "string filename" "eyes.ply"
NamedMaterial "lashes" Include "brows.pbrt"
NamedMaterial "hairs" Include "hair-realtime.pbrt"
"#;

/// Eyes that refract, and all hairs.
const SHAPES: &str = r#"
MakeNamedMaterial "white" "string type" "openpbr" "texture base_color" "eye colour" "float specular_roughness" 0.3
    "float coat_weight" 1 "float coat_roughness" 0 "float coat_ior" 1.34
MakeNamedMaterial "cornea" "string type" "dielectric" "float eta" 1.376
MakeNamedMaterial "hairs" "string type" "hair" "float eumelanin" 2.2 "float pheomelanin" 0.5 "float beta_m" 0.28 "float beta_n" 0.3
MakeNamedMaterial "lashes" "string type" "hair" "float eumelanin" 5
NamedMaterial "skin" Shape "plymesh" "string filename" "skin.ply"
NamedMaterial "white" Shape "plymesh" "string filename" "eyes.ply"
NamedMaterial "cornea" Shape "plymesh" "string filename" "corneas.ply"
NamedMaterial "lashes" Include "brows.pbrt"
NamedMaterial "hairs" Include "hair.pbrt"
"#;

const LIGHT: &str = r#"
LightSource "infinite" "rgb L" [ 0.02 0.022 0.027 ]
# A large key light, a rim light behind, and a weak fill.
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 16 15.4 14.5 ] "bool twosided" true
    Shape "bilinearmesh" "point3 P" [ 300 900 180  900 480 180  300 900 840  900 480 840 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 12 12.8 14 ] "bool twosided" true
    Shape "bilinearmesh" "point3 P" [ -700 -420 -100  -480 -640 -100  -700 -420 700  -480 -640 700 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 1.6 1.7 1.85 ] "bool twosided" true
    Shape "bilinearmesh" "point3 P" [ -900 300 -300  -700 900 -300  -900 300 500  -700 900 500 ]
AttributeEnd
"#;
