//! Scenes as text that have what no file of a scene has.

use assets::MemoryAssets;
use description::{MaterialKind, SpectrumDesc};

use crate::plain::difference;
use crate::{read, round_trip};

/// Checks that the scene of a text is the same after it was written; returns what was written.
fn check(scene: &str) -> String {
    let desc = read(&MemoryAssets::default().with("scene.pbrt", scene));
    let (exported, again) = round_trip(&desc);
    assert_eq!(difference(&desc, &again), None, "{}", exported.text);
    exported.text
}

#[test]
fn colours_keep_their_spaces() {
    let text = check(
        r#"ColorSpace "rec2020" Film "rgb" WorldBegin
        LightSource "point" ColorSpace "aces2065-1" LightSource "distant"
        MakeNamedMedium "grid" "string type" "rgbgrid" "rgb sigma_a" [ 1 2 3 4 5 6 ] "integer nx" 2
        Attribute "material" "rgb base_color" [ 0.1 0.2 0.3 ]
        ColorSpace "dci-p3"
        Material "openpbr" "rgb coat_color" [ 0.5 0.6 0.7 ]
        AreaLightSource "diffuse" Shape "sphere""#,
    );
    // The two colours of a material are in different spaces: one is a default.
    assert!(text.contains(r#"Attribute "material""#), "{text}");
    assert!(text.starts_with("ColorSpace \"rec2020\"\nFilm \"rgb\"\n"), "{text}");
}

#[test]
fn lookups_of_images_are_kept() {
    let image = [b"PF\n1 1\n-1\n".as_slice(), &[0; 12]].concat();
    let scene = r#"WorldBegin
        AreaLightSource "diffuse" "string filename" "a.pfm" "string wrap" "repeat" "string filter" "point"
            "float columns" [ 2 0 0.5 1 0.25 0 ]
        Material "openpbr" "string normalmap" "a.pfm" "string normalmap_wrap" "clamp-repeat"
            "string geometry_coat_normal" "a.pfm" "float geometry_coat_normal_columns" [ 1 0 0 2 0 0 ]
        Shape "sphere"
        Texture "t" "float" "imagemap" "string filename" "a.pfm" "string wrap" "black-clamp"
        AreaLightSource "diffuse" "string filename" "a.pfm" Shape "sphere" "texture alpha" "t""#;
    let desc = read(&MemoryAssets::default().with("scene.pbrt", scene).with("a.pfm", image));
    let (exported, again) = round_trip(&desc);
    assert_eq!(difference(&desc, &again), None, "{}", exported.text);
    for extension in ["lookups of images of emission and normals", "texture wrap by axis"] {
        assert!(exported.extensions.iter().any(|name| name == extension), "{:?}", exported.extensions);
    }
}

#[test]
fn motion_is_kept() {
    let text = check(
        r#"TransformTimes 0.25 0.75
        ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Camera "orthographic" "float shutteropen" 0.1
        WorldBegin
        ActiveTransform StartTime Rotate 33 1 2 3 ActiveTransform All
        MakeNamedMedium "m" "string type" "cloud"
        LightSource "spot" "point3 to" [ 1 2 3 ] "blackbody I" 4000 "float power" 20
        Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0  0 0 1 1 0 1 0 1 1 ] "integer keyframes" 2
            "normal N" [ 0 0 1 0 0 1 0 0 1 ]
        ObjectBegin "o" Shape "cylinder" "float zmin" -3 ObjectEnd
        ObjectInstance "o""#,
    );
    assert!(text.starts_with("TransformTimes 0.25 0.75\n"), "{text}");
    assert!(text.contains("ActiveTransform EndTime\n"), "{text}");
}

#[test]
fn media_are_in_force_where_they_were() {
    check(
        r#"MakeNamedMedium "fog" "string type" "homogeneous" "spectrum Le" [ 400 1 500 0.25 ] "float g" -0.5
        MediumInterface "" "fog" Camera "perspective" WorldBegin
        MakeNamedMedium "ice" "string type" "homogeneous" "string preset" "Skimmilk" "float scale" 2
        LightSource "point" "float scale" 3
        Shape "sphere" MediumInterface "ice" "fog" Shape "disk" "float innerradius" 0.5
        MediumInterface "" "" LightSource "point" Shape "cone" "float height" 2
        AttributeBegin Translate 1 2 3 MediumInterface "ice" Shape "paraboloid" AttributeEnd"#,
    );
}

#[test]
fn materials_are_kept() {
    let text = check(
        r#"WorldBegin
        Texture "rough" "float" "fbm" "integer octaves" 3
        Texture "rough" "spectrum" "marble" "float variation" 0.5
        Material "coatedconductor" "bool remaproughness" false "float conductor.roughness" 0.2
            "texture interface.uroughness" "rough" "float interface.vroughness" 0.25 "integer nsamples" 3
        Shape "sphere"
        Material "hair" "float eumelanin" 0.5 Shape "curve" "point3 P" [ 0 0 0 1 0 0 1 1 0 2 1 0 ]
            "float width0" 0.5 "string basis" "bspline"
        Material "subsurface" "rgb reflectance" [ 0.5 0.4 0.3 ] "string method" "random-walk"
        Shape "loopsubdiv" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "integer indices" [ 0 1 2 ] "texture alpha" "rough"
        Material "conductor" "spectrum eta" "metal-Au-eta" "texture displacement" "rough"
        Material "dielectric" "spectrum eta" "glass-BK7" Shape "hyperboloid" ReverseOrientation Shape "plane"
        Material "thindielectric" "float eta" 1.25
        MakeNamedMaterial "two" "string type" "mix" "string materials" [ "a \"b\"" "a \"b\"" ]
        MakeNamedMaterial "a \"b\"" "string type" "diffuse" "spectrum reflectance" [ 360 0.25 830 0.25 ]"#,
    );
    assert!(text.contains(r#""spectrum reflectance" [ 360 0.25 830 0.25 ]"#), "{text}");
}

#[test]
fn a_flat_spectrum_over_the_visible_wavelengths_is_a_constant() {
    let scene = r#"WorldBegin Material "diffuse" "spectrum reflectance" [ 360 0.3 830 0.3 ] Shape "sphere""#;
    let desc = read(&MemoryAssets::default().with("scene.pbrt", scene));
    let (_, material) = desc.materials.iter().next().unwrap();
    let MaterialKind::Diffuse { reflectance } = &material.kind else { panic!("{:?}", material.kind) };
    assert_eq!(reflectance.value(), Some(&SpectrumDesc::Constant(0.3)));
}

#[test]
fn settings_are_kept() {
    let text = check(
        r#"Option "seed" 7 Option "rendercoordsys" "world" Option "disablepixeljitter" true
        Film "spectral" "integer nbuckets" 5 "integer xresolution" 320 "float cropwindow" [ 0.1 0.5 0 1 ]
            "string layers" [ "depth" "normal" ] "string filename" "a \\ b.exr"
        PixelFilter "mitchell" "float B" 0.1 "float xradius" 3
        Sampler "stratified" "integer xsamples" 3 "bool jitter" false
        Integrator "volpath" "integer maxdepth" 9 "string lightsampler" "power"
        Accelerator "none"
        Camera "spherical" "string mapping" "equirectangular"
        WorldBegin"#,
    );
    let expected = [
        "Option \"disablepixeljitter\" true\n",
        "Option \"rendercoordsys\" \"world\"\n",
        "Option \"seed\" 7\n",
        "Sampler \"stratified\" \"integer xsamples\" 3 \"bool jitter\" false\n",
        "Integrator \"volpath\" \"integer maxdepth\" 9 \"string lightsampler\" \"power\"\n",
    ];
    for line in expected {
        assert!(text.contains(line), "{line} is not in\n{text}");
    }
}

#[test]
fn textures_are_kept() {
    check(
        r#"WorldBegin
        Texture "a" "float" "bilerp" "float v01" 0.5 "string mapping" "planar" "vector3 v1" [ 0 0 1 ] "float udelta" 3
        Texture "b" "spectrum" "checkerboard" "integer dimension" 3 "spectrum tex1" [ 400 0.5 600 0.25 ]
        Scale 2 3 4
        Texture "c" "spectrum" "mix" "texture tex1" "b" "texture amount" "a" "rgb tex2" [ 0.125 0.1 0.7 ]
        Texture "d" "spectrum" "scale" "texture tex" "c" "float scale" 0.5
        Texture "e" "float" "dots" "texture inside" "a" "string mapping" "cylindrical"
        Texture "f" "float" "directionmix" "vector3 dir" [ 1 0 0 ] "float tex1" 0.3
        Texture "g" "float" "windy" Texture "h" "float" "wrinkled" "float roughness" 0.1
        Texture "i" "spectrum" "constant" "rgb value" [ 0.3 0.2 0.1 ]
        Material "diffuse" "texture reflectance" "d" Shape "sphere""#,
    );
}
