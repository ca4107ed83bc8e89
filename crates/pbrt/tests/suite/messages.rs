//! One pinned message for every kind of error: code, position, text and help.

use assets::MemoryAssets;
use description::Severity;

/// Imports a text and shows its messages as `line:column severity[code] message (help)`.
fn messages(text: &str) -> Vec<String> {
    messages_among(MemoryAssets::default(), text)
}

/// [`messages`] beside other files.
fn messages_among(assets: MemoryAssets, text: &str) -> Vec<String> {
    let assets = assets
        .with("scene.pbrt", text)
        .with("self.pbrt", "Include \"self.pbrt\"")
        .with("a.pbrt", "Include \"b.pbrt\"")
        .with("b.pbrt", "Include \"a.pbrt\" Include \"a.pbrt\"")
        .with("room.glb", "glTF")
        .with("wide.pbrt", "Include \"narrow.pbrt\" ".repeat(101))
        .with("narrow.pbrt", "Include \"empty.pbrt\" ".repeat(100))
        .with("empty.pbrt", "")
        .with("bad.ply", "ply\nformat ascii 1.0\nelement vertex 99999999\nproperty float x\nend_header\n0\n")
        .with("bad.png", "no image")
        .with("good.pfm", "Pf\n1 1\n-1\n\0\0\0\0")
        .with("bad.spd", "400 1 500")
        .with("bad.dat", "1 2 x 4");
    let deep = |i: u32| format!("Include \"deep{}.pbrt\"", i + 1);
    let assets = (0..100).fold(assets, |assets, i| assets.with(format!("deep{i}.pbrt"), deep(i)));
    let imported = alhazen_pbrt::read("scene.pbrt", &assets);
    let show = |diagnostic: &description::Diagnostic| {
        let position = imported.sources.position(diagnostic.span());
        let severity = match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let help = diagnostic.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
        let place = format!("{}:{}", position.line, position.column);
        format!("{place} {severity}[{}] {}{help}", diagnostic.code, diagnostic.message)
    };
    imported.diagnostics.iter().map(show).collect()
}

/// Errors before `WorldBegin`, and their messages.
const BEFORE_WORLD: &[(&str, &str)] = &[
    (
        r#"Camra "perspective""#,
        "1:1 error[unknown-directive] there is no directive `Camra` (did you mean `Camera`?)",
    ),
    (
        r#"SurfaceIntegrator "path""#,
        "1:1 error[old-name] there is no directive `SurfaceIntegrator` (write `Integrator`)",
    ),
    ("17", "1:1 error[unexpected-token] expected a directive, found 17"),
    ("LookAt 1 2 x", "1:12 error[unexpected-token] expected a number (9 in all), found x"),
    (r#"Camera perspective"#, "1:8 error[unexpected-token] expected its type in quotes, found perspective"),
    (r#"Film "rgb"#, "1:6 error[unexpected-token] expected its type in quotes, found \"rgb"),
    (r#""Film"#, "1:1 error[unterminated-string] this string has no closing quote on its line"),
    (r#"Shape "sphere""#, "1:1 error[misplaced-directive] `Shape` is only allowed after `WorldBegin`"),
    (r#"Sampler "sobel""#, "1:9 error[unknown-type] there is no sampler `sobel` (did you mean `sobol`?)"),
    (
        r#"Sampler "sobol" "integer pixelsample" 4"#,
        "1:17 error[unknown-parameter] `sobol` has no parameter `pixelsample` (did you mean `pixelsamples`?)",
    ),
    (
        r#"Sampler "sobol" "float pixelsamples" 4"#,
        "1:17 error[parameter-type] `pixelsamples` is of type `integer`, not `float` (write `\"integer pixelsamples\"`)",
    ),
    (
        r#"Sampler "sobol" "integer pixelsamples" [4 5]"#,
        "1:17 error[parameter-count] `pixelsamples` takes one value, not 2",
    ),
    (
        r#"Sampler "sobol" "integer pixelsamples" 1.5"#,
        "1:40 error[parameter-value] `pixelsamples` is of type `integer` and takes an integer, not `1.5`",
    ),
    (
        r#"Sampler "sobol" "integer pixelsamples" 0"#,
        "1:17 error[parameter-value] `pixelsamples` is a whole number of 1 or more, not 0",
    ),
    (
        r#"Sampler "stratified" "integer xsamples" 40000"#,
        "1:22 error[parameter-value] `xsamples` is a whole number from 1 to 30000, not 40000",
    ),
    (
        r#"Film "rgb" "integer xresolution" 0"#,
        "1:12 error[parameter-value] `xresolution` is a whole number from 1 to 1000000, not 0",
    ),
    (
        r#"Film "rgb" "float maxcomponentvalue" -1"#,
        "1:12 error[parameter-value] `maxcomponentvalue` is a number above 0, not -1",
    ),
    (r#"Film "rgb" "float iso" 0"#, "1:12 error[parameter-value] `iso` is a number above 0, not 0"),
    (
        r#"Film "rgb" "string sensor" "canon_eos_10d""#,
        "1:28 error[unknown-choice] `sensor` cannot be `canon_eos_10d` (did you mean `canon_eos_100d`?)",
    ),
    (
        r#"PixelFilter "box" "float xradius" 0"#,
        "1:19 error[parameter-value] `xradius` is a number above 0, not 0",
    ),
    (
        r#"Camera "perspective" "float fov" 180"#,
        "1:22 error[parameter-value] `fov` is a number between 0 and 180, not 180",
    ),
    (
        r#"Camera "orthographic" "float shutteropen" 2"#,
        "1:1 warning[ignored] the shutter closes before it opens: the two times are exchanged",
    ),
    (
        r#"Integrator "vcm" "float alpha" 2"#,
        "1:18 error[parameter-value] `alpha` is a number above 0 and at most 1, not 2",
    ),
    (
        r#"Sampler "sobol" "integer seed" 1 "integer seed" 2"#,
        "1:34 error[duplicate-parameter] the parameter `seed` is given twice",
    ),
    (
        r#"Sampler "sobol" "integer seed" [1"#,
        "1:17 error[unclosed-bracket] the values of `seed` have no closing `]`",
    ),
    (r#"Sampler "sobol" "integer seed""#, "1:17 error[parameter-value] the parameter `seed` has no value"),
    (
        r#"Sampler "sobol" "seed" 1"#,
        "1:17 error[parameter-declaration] `seed` is not a parameter declaration (a parameter is declared by its type and its name, as in `\"float radius\"`)",
    ),
    (
        r#"Sampler "sobol" "int seed" 1"#,
        "1:17 error[unknown-parameter-type] there is no parameter type `int` (known here: `integer`, `float`, `bool`, `string`, `point2`, `vector2`, `point3`, `vector3`, `normal`, `spectrum`, `rgb`, `blackbody`, `texture`)",
    ),
    (
        r#"Sampler "sobol" "string randomization" "owne""#,
        "1:40 error[unknown-choice] `randomization` cannot be `owne` (did you mean `owen`?)",
    ),
    (
        r#"Option "disablepixeljiter" true"#,
        "1:8 error[unknown-option] there is no option `disablepixeljiter` (did you mean `disablepixeljitter`?)",
    ),
    (
        r#"ColorSpace "sRBG""#,
        "1:12 error[unknown-color-space] there is no colour space `sRBG` (did you mean `srgb`?)",
    ),
    (
        r#"CoordSysTransform "camera""#,
        "1:19 error[unknown-reference] there is no coordinate system `camera` yet",
    ),
    ("Scale 1 0 1", "1:1 error[singular-transform] this transform is singular: it has no inverse"),
    ("Rotate 10 0 0 0", "1:1 error[singular-transform] the axis of this rotation has no direction"),
    (
        "LookAt 0 0 0 0 1 0 0 1 0",
        "1:1 error[singular-transform] eye, target and up vector of this `LookAt` do not define a frame",
    ),
    (r#"Film "rgb" Film "rgb""#, "1:12 warning[replaced-statement] this `Film` replaces an earlier one"),
    (
        r#"Film "rgb" "bool savefp16" "false""#,
        "1:28 warning[deprecated] `true` and `false` are written without quotes",
    ),
    (r#"Film "image""#, "1:6 error[old-name] there is no film `image` (write `rgb`)"),
    (r#"Camera "realistic""#, "1:8 error[missing-parameter] `realistic` needs the parameter `lensfile`"),
    (
        r#"Camera "realistic" "string lensfile" "bad.dat""#,
        "1:38 error[unreadable-lens] line 1 of `bad.dat` has `x`, which is not a number",
    ),
    (
        r#"Attribute "shap" "float radius" 2"#,
        "1:11 error[unknown-attribute-target] there are no attributes for `shap` (did you mean `shape`?)",
    ),
    (
        r#"Attribute "shape" "float raduis" 2"#,
        "1:19 warning[ignored] no statement uses the attribute `raduis`",
    ),
    (r#"Include "none.pbrt""#, "1:9 error[unreadable-file] cannot read `none.pbrt`: no such file"),
    (
        r#"Include "self.pbrt""#,
        "1:9 error[include-cycle] files include each other in a cycle: self.pbrt → self.pbrt",
    ),
    (
        r#"Include "a.pbrt""#,
        "1:9 error[include-cycle] files include each other in a cycle: a.pbrt → b.pbrt → a.pbrt",
    ),
    (
        r#"Include "scene.pbrt""#,
        "1:9 error[include-cycle] files include each other in a cycle: scene.pbrt → scene.pbrt",
    ),
    (
        r#"Include "room.glb""#,
        "1:9 error[foreign-format] `room.glb` is a glTF scene, not one of pbrt-v4 (scenes are pbrt-v4, glTF, ",
    ),
];

/// Errors after `WorldBegin`.
const IN_WORLD: &[(&str, &str)] = &[
    (r#"Sampler "sobol""#, "1:1 error[misplaced-directive] `Sampler` is only allowed before `WorldBegin`"),
    ("AttributeEnd", "1:1 error[unbalanced-block] `AttributeEnd` has no `AttributeBegin` before it"),
    ("AttributeBegin", "1:1 error[unbalanced-block] this `AttributeBegin` has no `AttributeEnd`"),
    (r#"NamedMaterial "rde" Shape "sphere""#, "1:15 error[unknown-reference] there is no material `rde`"),
    (
        r#"MakeNamedMaterial "red" "string type" "diffuse" NamedMaterial "rde" Shape "sphere""#,
        "1:63 error[unknown-reference] there is no material `rde` (did you mean `red`?)",
    ),
    (
        r#"MakeNamedMaterial "red" "rgb reflectance" [1 0 0]"#,
        "1:19 error[missing-parameter] the material `red` needs its type, as in `\"string type\" \"…\"`",
    ),
    (
        r#"MakeNamedMaterial "a" "string type" "mix" "string materials" ["a" "a"]"#,
        "1:43 error[material-cycle] this mix of materials contains itself",
    ),
    (
        r#"Material "glass""#,
        "1:10 error[old-name] there is no material `glass` (write `dielectric`; for thin sheets `thindielectric`)",
    ),
    (
        r#"Material "diffuse" "rgb Kd" [1 1 1]"#,
        "1:20 error[old-name] `diffuse` has no parameter `Kd` (`Kd` is now `reflectance`)",
    ),
    (
        r#"Material "diffuse" "rgb reflectance" [1 1]"#,
        "1:20 error[parameter-count] `reflectance` has 2 numbers; a colour has three: linear red, green and blue",
    ),
    (
        r#"Material "diffuse" "color reflectance" [1 1 1]"#,
        "1:20 error[old-name] there is no parameter type `color` (write `rgb`)",
    ),
    (
        r#"Material "diffuse" "spectrum reflectance" "metal-Cu-et""#,
        "1:43 error[unknown-spectrum] `metal-Cu-et` is neither the name of a spectrum nor a file (did you mean `metal-Cu-eta`?)",
    ),
    (
        r#"Material "diffuse" "spectrum reflectance" "bad.spd""#,
        "1:43 error[unreadable-spectrum] `bad.spd` does not hold pairs of increasing wavelength and value",
    ),
    (
        r#"Material "diffuse" "texture reflectance" "t""#,
        "1:42 error[unknown-reference] there is no spectrum texture `t`",
    ),
    (
        r#"Texture "t" "float" "constant" Material "diffuse" "texture reflectance" "t""#,
        "1:73 error[unknown-reference] `t` is a float texture; a spectrum texture is needed here",
    ),
    (
        r#"Texture "t" "float" "constant" Texture "t" "float" "constant""#,
        "1:40 error[redefinition] there is already a float texture `t`",
    ),
    (
        r#"Texture "t" "color" "constant""#,
        "1:13 error[old-name] a texture's values are of type `float` or `spectrum`, not `color` (write `spectrum`)",
    ),
    (
        r#"Texture "t" "spectrum" "imagemap" "string filename" "bad.png""#,
        "1:53 error[unreadable-image] cannot read the image `bad.png`: ",
    ),
    (
        r#"Texture "t" "float" "imagemap" "string filename" "good.pfm" "string channel" "x""#,
        "1:78 error[unknown-choice] `channel` cannot be `x`",
    ),
    (
        r#"Texture "t" "spectrum" "imagemap" "string filename" "good.pfm" "string channel" "r""#,
        "1:64 error[unknown-parameter] `imagemap` has no parameter `channel`",
    ),
    (
        r#"Shape "plymesh" "string filename" "bad.ply""#,
        "1:35 error[unreadable-mesh] cannot read the mesh `bad.ply`: mesh too large: 99999999 elements of `vertex` do not fit in 2 bytes",
    ),
    (
        r#"Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 3]"#,
        "1:53 error[parameter-value] `indices` has 3, but there are 3 points in `P`",
    ),
    (
        r#"Shape "polygon" "point3 P" [0 0 0 4 0 0 0 4 0 1 1 0 2 1 0 1 2 0] "integer contours" [3 4]"#,
        "1:66 error[parameter-value] `contours` must add up to the 6 points in `P`",
    ),
    (
        r#"Shape "polygon" "point3 P" [0 0 0 4 0 0 4 4 0 0 4 1]"#,
        "1:17 error[parameter-value] `P` is not a valid polygon: point 1 is not in the plane of the others",
    ),
    (
        r#"Shape "polygon" "point3 P" [0 0 0 4 4 0 1 4 0 4 0 0]"#,
        "1:17 error[parameter-value] `P` is not a valid polygon: the edges that begin with the points 0 and 2 touch or cross",
    ),
    (
        r#"Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0 0 0 1] "integer keyframes" 3"#,
        "1:59 error[parameter-value] the 4 points in `P` are not a multiple of 3",
    ),
    (
        r#"Shape "spheres" "point3 P" [0 0 0 1 0 0] "float radius" [1 2 3]"#,
        "1:42 error[parameter-value] `radius` has 3 values for 2 points in `P`",
    ),
    (
        r#"Shape "spheres" "point3 P" [0 0 0 1 0 0] "float radius" [1 -2]"#,
        "1:42 error[parameter-value] `radius` 1 is -2; it must be above zero",
    ),
    (r#"Shape "sphere" "float radius" 0"#, "1:16 error[parameter-value] `radius` is a number above 0, not 0"),
    (
        r#"Shape "sphere" "float radius" 2 "float zmin" 3 "float zmax" 4"#,
        "1:48 error[parameter-value] no part of the surface lies between `zmin` and `zmax`",
    ),
    (
        r#"Shape "cylinder" "float zmin" 1"#,
        "1:18 error[parameter-value] no part of the surface lies between `zmin` and `zmax`",
    ),
    (
        r#"Shape "paraboloid" "float zmax" -1"#,
        "1:20 error[parameter-value] no part of the surface lies between `zmin` and `zmax`",
    ),
    (
        r#"Shape "disk" "float innerradius" 1"#,
        "1:14 error[parameter-value] `innerradius` must be at least 0, and below `radius`",
    ),
    (
        r#"Shape "hyperboloid" "point3 p1" [0 0 1] "point3 p2" [0 0 2]"#,
        "1:41 error[parameter-value] `p1` and `p2` both lie on the z axis: such a line sweeps no surface",
    ),
    (
        r#"Shape "curve" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1] "float width" -1"#,
        "1:52 error[parameter-value] the width of a curve cannot be negative",
    ),
    (
        r#"LightSource "point" "float scale" -2"#,
        "1:21 error[parameter-value] `scale` is a number of 0 or more, not -2",
    ),
    (
        r#"AreaLightSource "diffuse" "float scale" -2"#,
        "1:27 error[parameter-value] `scale` is a number of 0 or more, not -2",
    ),
    (
        r#"LightSource "point" "float power" 0"#,
        "1:21 warning[ignored] `power` has no effect unless it is above zero",
    ),
    (
        r#"LightSource "infinite" "float illuminance" -3"#,
        "1:24 warning[ignored] `illuminance` has no effect unless it is above zero",
    ),
    (
        r#"LightSource "spot" "float coneangle" 0"#,
        "1:20 error[parameter-value] `coneangle` is a number above 0 and at most 180, not 0",
    ),
    (
        r#"LightSource "spot" "float conedeltaangle" -1"#,
        "1:20 error[parameter-value] `conedeltaangle` is a number from 0 to 180, not -1",
    ),
    (r#"Shape "spheres" "float radius" 2"#, "1:7 error[missing-parameter] `spheres` needs the parameter `P`"),
    (
        r#"Shape "nurbs""#,
        "1:7 error[old-name] there is no shape `nurbs` (there are no NURBS any more; write a mesh)",
    ),
    (
        r#"Shape "hyperboloid" "point3 p1" [1 0 1] "point3 p2" [0 2 1]"#,
        "1:41 error[parameter-value] `p1` and `p2` have the same z: use a `disk`, which is what such a line sweeps",
    ),
    (r#"ObjectInstance "x""#, "1:16 error[unknown-reference] there is no object `x`"),
    (r#"Shape "implicit""#, "1:7 error[missing-parameter] `implicit` needs the parameter `f`"),
    (
        r#"Shape "implicit" "string f" "x" "point3 bounds" [1 1 1 0 0 0]"#,
        "1:33 error[parameter-value] `bounds` are two corners of a box: the lowest and the highest x, y and z",
    ),
    (
        r#"ObjectBegin "a" Shape "sphere" ObjectEnd Shape "csg" "string operation" "union" "string operands" "a""#,
        "1:81 error[parameter-value] a solid is made of two objects or more",
    ),
    (
        r#"ObjectBegin "a" Shape "sphere" ObjectEnd Shape "csg" "string operation" "minus" "string operands" ["a" "a"]"#,
        "1:73 error[unknown-choice] `operation` cannot be `minus` (known here: `union`, `intersection`, `difference`)",
    ),
    (
        r#"ObjectBegin "ball" Shape "sphere" ObjectEnd Shape "csg" "string operation" "union" "string operands" ["ball" "bal"]"#,
        "1:110 error[unknown-reference] there is no object `bal` (did you mean `ball`?)",
    ),
    (
        r#"ObjectBegin "b" ObjectEnd ObjectBegin "a" Shape "csg" "string operation" "union" "string operands" ["a" "b"] ObjectEnd"#,
        "1:101 error[unknown-reference] the object `a` is not complete here (the operands of a solid in an object must end before that object begins)",
    ),
    (
        r#"Shape "csg" "string operands" ["a" "b"]"#,
        "1:7 error[missing-parameter] `csg` needs the parameter `operation`",
    ),
    ("WorldEnd", "1:1 warning[deprecated] `WorldEnd` is not needed any more: the world ends with the file"),
];

#[test]
fn every_error_has_its_message() {
    for (text, expected) in BEFORE_WORLD {
        let mut found = messages(&format!("{text}\nWorldBegin"));
        found.retain(|message| !message.contains("`WorldBegin`") || expected.contains("`WorldBegin`"));
        assert!(
            found.first().is_some_and(|found| found.starts_with(expected)),
            "{text}\n{expected}\n{found:#?}"
        );
    }
    for (text, expected) in IN_WORLD {
        // `WorldBegin` is on a line of its own, so that columns count from the text.
        let found = messages(&format!("WorldBegin\n{text}"));
        let expected = expected.replacen("1:", "2:", 1);
        assert_eq!(found.len(), 1, "{text}\n{found:#?}");
        assert!(found[0].starts_with(&expected), "{text}\n{expected}\n{}", found[0]);
    }
    assert_eq!(messages(""), ["1:1 error[missing-world] the scene has no `WorldBegin`: its world is empty"]);
}

#[test]
fn all_errors_of_a_scene_are_found_in_one_run() {
    let all: String =
        IN_WORLD[3..16].iter().map(|(text, _)| format!("AttributeBegin {text} AttributeEnd\n")).collect();
    let found = messages(&format!("Smapler \"sobol\"\nWorldBegin\n{all}\nShape \"spere\"\n"));
    assert!(found.len() >= 13, "{found:#?}");
    assert!(found[0].starts_with("1:1 error[unknown-directive]"));
    assert!(found.last().is_some_and(|last| last.contains("did you mean `sphere`?")), "{found:#?}");
}

#[test]
fn too_many_included_files_are_cut_off() {
    for (text, message) in [
        (r#"Include "deep0.pbrt""#.to_owned(), "more than 64 deep"),
        (r#"Include "double0.pbrt""#.to_owned(), "files are included more than 1000000 times"),
        (
            (0..=10_000).map(|i| format!("Include \"part{i}.pbrt\" ")).collect(),
            "more than 10000 different files",
        ),
    ] {
        let double = |i: u32| format!("Include \"double{0}.pbrt\" ", i + 1).repeat(2);
        let assets = (0..40).map(|i| (format!("double{i}.pbrt"), double(i)));
        let assets = assets.chain([("double40.pbrt".to_owned(), String::new())]);
        let assets = assets.chain((0..=10_000).map(|i| (format!("part{i}.pbrt"), String::new())));
        let assets = assets.fold(MemoryAssets::default(), |all, (name, text)| all.with(name, text));
        let found = messages_among(assets, &format!("{text}\nWorldBegin"));
        assert!(
            found.iter().any(|found| found.contains("[include-limit]") && found.contains(message)),
            "{found:#?}"
        );
    }
}

/// Backslashes of Windows are escapes of the format, or errors where they begin.
#[test]
fn backslashes_that_are_no_escapes_are_errors_at_their_place() {
    let expected = "error[unknown-escape] this backslash begins no escape of the format \
        (write `/` between folders, and `\\\\` for a backslash)";
    let found = messages("Include \"empty\\mpty.pbrt\"\nWorldBegin");
    assert!(found.contains(&format!("1:15 {expected}")), "{found:?}");
    let found = messages("WorldBegin\nTexture \"t\" \"float\" \"imagemap\" \"string filename\" \"a\\.pfm\"");
    assert!(found.contains(&format!("2:52 {expected}")), "{found:?}");
    // Escapes in a name are told where the file is not found.
    let found = messages("Include \"parts\\new.pbrt\"\nWorldBegin");
    assert!(found[0].contains("its name has escapes such as `\\n`: write `/` between folders"), "{found:?}");
    // A backslash that is written as one is that of a path.
    let assets = MemoryAssets::default().with("parts/metal.pbrt", "");
    assert_eq!(messages_among(assets, "Include \"parts\\\\metal.pbrt\"\nWorldBegin"), [""; 0]);
}

#[test]
fn the_same_file_may_be_included_many_times() {
    let found =
        messages(&format!("{}\nWorldBegin", "Include \"empty.pbrt\" Include \"wide.pbrt\"\n".repeat(2)));
    assert_eq!(found, [""; 0]);
}

#[test]
fn the_number_of_messages_is_bounded() {
    let found = messages(&"Noise 1 2 3\n".repeat(100_000));
    assert!(found.len() < 200);
    assert!(found.last().is_some_and(|last| last.contains("[more-errors]")));
}

#[test]
fn many_warnings_are_not_an_error() {
    let found = messages(&format!("WorldBegin\n{}", "TransformBegin TransformEnd WorldEnd\n".repeat(10_000)));
    assert_eq!(found.len(), 3, "{found:#?}");
    assert!(found.iter().all(|found| found.starts_with("2:") && found.contains("warning[deprecated]")));
    let names: String = (0..150).map(|i| format!("Attribute \"shape\" \"float a{i}\" 1\n")).collect();
    let found = messages(&format!("WorldBegin\n{names}"));
    assert_eq!(found.len(), 101);
    assert!(
        found[100].contains("warning[more-warnings] only the first 100 warnings are shown"),
        "{found:#?}"
    );
}

#[test]
fn long_quotes_are_shortened() {
    let long = "x".repeat(3_000_000);
    for text in [
        format!("{long} 1"),
        format!("\"{long}"),
        format!("Camera {long}"),
        format!("Camera \"{long}\""),
        format!("Include \"{long}\""),
        format!("Camera \"perspective\" \"float {long}\" 1"),
        format!("Camera \"perspective\" \"{long} fov\" 1"),
        format!("Camera \"perspective\" \"float fov\" {long}"),
        format!("Camera \"perspective\" \"float fov\" [ 1 \"{long}\" ]"),
        format!("WorldBegin NamedMaterial \"{long}\" Shape \"sphere\""),
        format!(
            "WorldBegin Texture \"{long}\" \"float\" \"constant\" Texture \"{long}\" \"float\" \"constant\""
        ),
        format!("WorldBegin Material \"diffuse\" \"spectrum reflectance\" \"{long}\""),
        format!("WorldBegin Shape \"plymesh\" \"string filename\" \"{long}.ply\""),
    ] {
        let found = messages(&text);
        assert!(!found.is_empty(), "{:.60}", text);
        assert!(found.iter().all(|found| found.len() < 3000), "{:.60}", found[0]);
    }
}

#[test]
fn a_statement_has_a_limited_number_of_parameters() {
    let many: String = (0..100_000).map(|i| format!("\"float a{i}\" 1 ")).collect();
    let found = messages(&format!("Sampler \"sobol\" {many}\nWorldBegin"));
    assert!(
        found
            .iter()
            .any(|found| found.contains("[too-many-parameters] a statement has at most 1000 parameters")),
        "{found:#?}"
    );
}
