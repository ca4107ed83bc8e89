//! `alhazen trace-pixel`: what it tells is what the picture has.

use serde_json::Value;

use crate::common::Folder;

/// A ball of glass and one of plaster on a floor, under a lamp and a sky, in a mist.
const SCENE: &str = r#"
Film "rgb" "integer xresolution" 16 "integer yresolution" 16 "bool savefp16" false
PixelFilter "box"
Sampler "independent" "integer pixelsamples" 1
Integrator "path" "integer maxdepth" 6
LookAt 0 1.5 -6   0 1 0   0 1 0
Camera "perspective" "float fov" 45
WorldBegin
LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
    Translate 0 5 0
    Shape "sphere" "float radius" 0.7
AttributeEnd
MakeNamedMaterial "plaster" "string type" "diffuse"
Material "dielectric"
AttributeBegin
    Translate -1.1 1 0
    Shape "sphere"
AttributeEnd
NamedMaterial "plaster"
AttributeBegin
    Translate 1.1 1 0
    Shape "sphere"
AttributeEnd
Shape "bilinearmesh" "point3 P" [ -9 0 -9  9 0 -9  -9 0 9  9 0 9 ]
"#;

const MIST: &str = r#"
AttributeBegin
    MakeNamedMedium "mist" "string type" "homogeneous" "rgb sigma_s" [ 0.5 0.5 0.5 ] "rgb Le" [ 0.1 0.1 0.1 ]
        "rgb sigma_a" [ 0.1 0.1 0.1 ]
    MediumInterface "mist" ""
    Material "interface"
    Translate 0 1.5 -2
    Shape "sphere"
AttributeEnd
"#;

fn rgb(json: &Value) -> [f64; 3] {
    [0, 1, 2].map(|c| json[c].as_f64().unwrap())
}

#[test]
fn the_light_that_arrives_is_that_of_the_pixel() {
    let folder = Folder::new("trace");
    folder.write("clear.pbrt", SCENE);
    folder.write("mist.pbrt", &format!("{SCENE}{MIST}"));
    for (scene, integrator) in [("clear.pbrt", "path"), ("mist.pbrt", "vol-path"), ("mist.pbrt", "whitted")] {
        let options = ["--integrator", integrator, "--engine", "scalar", "--quiet", "-o", "picture.exr"];
        folder.alhazen(&[&["render", scene], &options[..]].concat()).expect(0);
        let picture = folder.image("picture.exr");
        let mut seen = Vec::new();
        for (x, y) in [(4, 7), (11, 8), (8, 14), (1, 1), (8, 6), (8, 0)] {
            let (column, row) = (x.to_string(), y.to_string());
            let order = ["trace-pixel", scene, &column, &row, "--integrator", integrator, "--json"];
            let json = folder.alhazen(&order).expect(0).json();
            let sample = &json["samples"][0];
            let whole = rgb(&sample["rgb"]);
            for (c, expected) in whole.into_iter().enumerate() {
                let value = f64::from(picture.channel(x, y, c));
                assert!(
                    (value - expected).abs() < 1e-5 * value.abs().max(1.0),
                    "{integrator} {x} {y}: {sample}"
                );
            }
            let steps = sample["steps"].as_array().unwrap();
            seen.extend(steps.iter().map(|step| step["step"].as_str().unwrap().to_owned()));
            if integrator != "whitted" {
                let light = steps.iter().filter(|step| step["step"] == "light").map(|step| rgb(&step["rgb"]));
                let sum = light.fold([0.0; 3], |sum, l| [0, 1, 2].map(|c: usize| sum[c] + l[c]));
                for c in 0..3 {
                    let error = (sum[c] - whole[c]).abs();
                    assert!(error < 1e-5 * whole[c].abs().max(1.0), "{integrator} {x} {y}: {sample}");
                }
            }
        }
        let expected = ["ray", "surface", "shadow"];
        assert!(expected.iter().all(|step| seen.iter().any(|s| s == step)), "{integrator}: {seen:?}");
    }
}

#[test]
fn paths_are_told_and_drawn() {
    let folder = Folder::new("trace-drawn");
    folder.write("scene.pbrt", SCENE);
    let order = ["trace-pixel", "scene.pbrt", "4", "7", "--samples", "2", "-o", "a.svg", "-o", "a.ply"];
    let text = folder.alhazen(&order).expect(0).out;
    for part in [
        "sample 0 of pixel 4, 7, at ",
        "sample 1 of pixel 4, 7, at ",
        "a ray leaves the camera at (0, 1.5, -6)",
        "hits `shape-1` after 5.",
        ": specular reflection and transmission",
        "a ray is transmitted",
        "together rgb (",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let read = |name| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let svg = read("a.svg");
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && svg.contains("data:image/png;base64,"));
    let rays = text.matches(" along (").count();
    assert_eq!(svg.matches("<line ").count(), rays, "{text}");
    assert!(read("a.ply").contains(&format!("element edge {rays}\n")));
}

#[test]
fn what_cannot_be_traced_is_refused() {
    let folder = Folder::new("trace-refused");
    folder.write("scene.pbrt", SCENE);
    for (order, problem) in [
        (&["16", "3"][..], "the picture has no pixel 16, 3: it is 16 x 16"),
        (&["1", "1", "--integrator", "mlt"], "`mlt` does not estimate pixels one by one"),
        (&["1", "1", "-o", "a.png"], "a.png is neither a drawing (.svg) nor a file of edges (.ply)"),
        (&["-1", "1"], "-1"),
    ] {
        let error = folder.alhazen(&[&["trace-pixel", "scene.pbrt"], order].concat()).expect(2).err;
        assert!(error.contains(problem), "{error}");
    }
}
