//! Pictures of shapes, lights and cameras that move by both engines.

use alhazen_gpu::Algorithm;
use description::{LightSamplerDesc, LightTracingDesc, PathDesc};

use crate::pictures::Case;
use crate::texts::PAN;

/// Shapes and an instance that move, turn and stretch while the shutter is open, before the motion
/// is over, one at rest of the same object, a mesh with normals that is a mirror, and a light.
pub const TURNING: &str = r#"
TransformTimes 1 4
LookAt 0 -6 2  0 0 0.6  0 0 1
Camera "perspective" "float fov" 40 "float shutteropen" 0.5 "float shutterclose" 3
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.4 0.5 0.7 ]
LightSource "point" "point3 from" [ 2 -4 4 ] "float scale" 90
Texture "squares" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
    "rgb tex1" [ 0.7 0.6 0.5 ] "rgb tex2" [ 0.2 0.3 0.4 ]
Material "diffuse" "texture reflectance" "squares"
Shape "bilinearmesh" "point3 P" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0 ]
ObjectBegin "pair"
    Shape "trianglemesh" "point3 P" [ 0 0 0  0.8 0 0  0 0 0.8 ] "integer indices" [ 0 1 2 ]
    Translate 0.3 -0.1 0.3
    Shape "sphere" "float radius" 0.25
ObjectEnd
AttributeBegin
    Translate -1.8 0 0.1
    ObjectInstance "pair"
    ActiveTransform EndTime
    Rotate 80 0.1 0.2 1
    Translate 0.4 0.3 0.8
    Scale 1.2 -0.9 1
    ActiveTransform All
    ObjectInstance "pair"
AttributeEnd
AttributeBegin
    Translate 0.2 0.4 0.6
    Material "conductor" "float roughness" 0
    ActiveTransform EndTime
    Translate 0.3 0.5 0.2
    ActiveTransform All
    Shape "sphere" "float radius" 0.5
    Shape "trianglemesh" "point3 P" [ -0.5 -1 -0.4  0.6 -1.1 -0.5  0 -0.9 0.4 ] "integer indices" [ 0 1 2 ]
        "normal N" [ -0.3 -1 0  0.3 -1 0  0 -1 0.3 ]
AttributeEnd
AttributeBegin
    Translate 1.6 0 0.5
    ActiveTransform EndTime
    Rotate 150 1 0.5 0
    ActiveTransform All
    Shape "cylinder" "float radius" 0.2 "float zmin" -0.4 "float zmax" 0.4
    AreaLightSource "diffuse" "rgb L" [ 4 6 9 ]
    Translate -0.8 0.4 0
    Shape "sphere" "float radius" 0.2
AttributeEnd
"#;

/// Lanterns of all shapes that emit, turned, stretched and mirrored, alone and in strings, at rest
/// and in motion, also within what moves.
pub const LANTERNS: &str = r#"
LookAt 0 -5 2  0 0 0.5  0 0 1
Camera "perspective" "float fov" 45 "float shutterclose" 1
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.1 0.2 ]
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
ObjectBegin "lantern"
    AreaLightSource "diffuse" "rgb L" [ 8 5 3 ]
    Shape "trianglemesh" "point3 P" [ -0.4 -0.2 0  0.4 -0.2 0  0 -0.3 0.6  0.3 -0.4 0.5 ]
        "integer indices" [ 0 1 2 2 1 3 ]
    AreaLightSource "diffuse" "rgb L" [ 3 6 8 ] "bool twosided" true "float power" 9
    Shape "bilinearmesh" "point3 P" [ -0.4 0.2 0.1  0.3 0.2 0  -0.4 0.3 0.5  0.3 0.1 0.6 ]
    Shape "bilinearmesh" "point3 P" [ -0.3 0 0.9  0.3 0 0.9  -0.3 0.3 0.9  0.3 0.3 0.9 ]
    Translate -0.6 0 0.3
    Shape "sphere" "float radius" 0.15
    Translate 1.2 0 0
    Shape "disk" "float radius" 0.2 "float innerradius" 0.05
    Shape "cylinder" "float radius" 0.08 "float zmin" -0.3 "float zmax" -0.05
ObjectEnd
ObjectBegin "string"
    Shape "sphere" "float radius" 0.2
    Translate 0 0 0.5
    ObjectInstance "lantern"
    Translate 0.9 0.5 0.2
    ActiveTransform EndTime
    Rotate 50 0.3 1 0.2
    Translate 0.2 0.1 0.3
    ActiveTransform All
    ObjectInstance "lantern"
ObjectEnd
Shape "disk" "float radius" 9 "float height" -0.4
AttributeBegin
    Translate -1.6 0 0
    Scale 1.2 0.7 -0.9
    ObjectInstance "lantern"
AttributeEnd
Translate 0.3 0.4 0
Scale 0.7 0.7 0.7
ObjectInstance "string"
Translate 0.9 -1 0
ActiveTransform EndTime
Rotate 40 1 0.1 0.5
Translate 0.3 0.2 0.3
ActiveTransform All
ObjectInstance "string"
"#;

/// Lights without surfaces that move, turn and stretch, and parts of spheres, cylinders and disks
/// that emit, stretched and mirrored.
pub const SIGNALS: &str = r#"
LookAt 0 -6 2.5  0 0 0.6  0 0 1
Camera "perspective" "float fov" 45 "float shutterclose" 1
Film "rgb"
WorldBegin
AttributeBegin
    ActiveTransform EndTime
    Translate 0.8 0.2 -0.3
    Rotate 50 0.2 1 0.3
    Scale 1.2 0.8 1
    ActiveTransform All
    LightSource "infinite" "string filename" "slide.pfm" "float scale" 0.1
    LightSource "distant" "rgb L" [ 0.5 0.4 0.3 ] "point3 from" [ -1 -2 2 ]
    LightSource "point" "rgb I" [ 2 3 2 ] "point3 from" [ -1.5 -1 1.5 ]
    LightSource "spot" "rgb I" [ 9 5 5 ] "point3 from" [ 0 -1 3 ] "point3 to" [ 0.5 0 0 ] "float coneangle" 35
    Translate 1 -1 2
    LightSource "goniometric" "string filename" "slide.pfm" "float scale" 3
    Translate 0 -2 0
    Rotate 110 1 0 0
    LightSource "projection" "string filename" "slide.pfm" "float fov" 50 "float scale" 9
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "bilinearmesh" "point3 P" [ -4 -4 -0.3  4 -4 -0.3  -4 4 0  4 4 0 ]
AreaLightSource "diffuse" "rgb L" [ 4 6 8 ]
AttributeBegin
    Translate -1.4 0.3 0.5
    Scale 1 0.6 -1.5
    Shape "sphere" "float radius" 0.4 "float zmin" -0.2 "float zmax" 0.35 "float phimax" 250
    Translate 1 0 0
    Rotate 40 1 1 0
    Scale 0.5 1 1.2
    Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
    Translate 0.5 0.4 0.4
    Scale 0.5 1 1.3
    Rotate 50 1 0.2 0.3
    Shape "cylinder" "float radius" 0.3 "float zmin" -0.3 "float zmax" 0.3 "float phimax" 200
    Translate 0.9 0 0.6
    Shape "disk" "float radius" 0.4 "float innerradius" 0.1 "float phimax" 300
AttributeEnd
"#;

#[test]
fn lights_of_all_forms_in_motion_have_the_picture_of_the_cpu() {
    let slide = [0.9, 0.2, 0.1, 0.1, 0.8, 0.2, 0.3, 0.3, 0.9, 0.8, 0.8, 0.7];
    let case = Case::with_image(SIGNALS, "slide.pfm", slide);
    let path = Algorithm::Path(PathDesc { max_depth: 3, ..PathDesc::default() });
    assert_eq!(case.compare("signals", &path), None);
    let refusals = case.flatten(&Algorithm::LightTracing(LightTracingDesc::default())).err();
    assert_eq!(refusals.expect("a refusal")[0].what, "light paths from moving lights");
}

#[test]
fn shapes_in_motion_have_the_picture_of_the_cpu() {
    let case = Case::of_text(TURNING);
    let path = Algorithm::Path(PathDesc { max_depth: 3, ..PathDesc::default() });
    assert_eq!(case.compare("turning", &path), None);
    let refusals = case.flatten(&Algorithm::LightTracing(LightTracingDesc::default())).err();
    assert_eq!(refusals.expect("a refusal")[0].what, "light paths among shapes that move");
}

/// Each motion is interpolated by itself, within others.
#[test]
fn lights_in_instances_have_the_picture_of_the_cpu() {
    let case = Case::of_text(LANTERNS);
    for light_sampler in [LightSamplerDesc::Bvh, LightSamplerDesc::Uniform] {
        let settings = PathDesc { light_sampler, max_depth: 3, ..PathDesc::default() };
        assert_eq!(case.compare("lanterns", &Algorithm::Path(settings)), None, "{light_sampler:?}");
    }
}

#[test]
fn moving_cameras_have_the_picture_of_the_cpu() {
    let case = Case::of_text(PAN);
    let path = Algorithm::Path(PathDesc { max_depth: 3, ..PathDesc::default() });
    assert_eq!(case.compare("pan", &path), None);
    let refusals = case.flatten(&Algorithm::LightTracing(LightTracingDesc::default())).err();
    assert_eq!(refusals.expect("a refusal")[0].what, "light paths to moving cameras");
}
