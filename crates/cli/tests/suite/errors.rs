//! Errors: texts and exit codes.

use crate::common::{Folder, SCENE};

#[test]
fn a_wrong_scene_is_shown_with_carets() {
    let folder = Folder::new("carets");
    folder.write(
        "scene.pbrt",
        &SCENE.replace("\"sphere\"", "\"spere\"").replace("\"float fov\"", "\"float fow\""),
    );
    let err = folder.alhazen(&["render", "scene.pbrt"]).expect(1).err;
    for part in
        ["scene.pbrt:3:", "scene.pbrt:10:7", "Shape \"spere\"", "      ^^^^^^^", "did you mean", "2 errors"]
    {
        assert!(err.contains(part), "no `{part}` in {err}");
    }
    assert_eq!(folder.files(), ["scene.pbrt"], "no picture");
    let json = folder.alhazen(&["render", "scene.pbrt", "--json"]).expect(1).json();
    assert_eq!(json["status"], "error");
    let errors = json["errors"].as_array().expect("a list");
    assert_eq!(errors.len(), 2);
    assert_eq!((&errors[1]["line"], &errors[1]["column"]), (&10.into(), &7.into()));
    assert_eq!(errors[1]["file"], "scene.pbrt");
}

#[test]
fn a_wrong_formula_is_shown_with_a_caret_in_it() {
    let folder = Folder::new("formula");
    let ball = "Shape \"sphere\" \"float radius\" 1";
    assert!(SCENE.contains(ball));
    folder.write("scene.pbrt", &SCENE.replace(ball, "Shape \"implicit\" \"string f\" \"x^2 + ln(y) - 1\""));
    let err = folder.alhazen(&["render", "scene.pbrt"]).expect(1).err;
    for part in ["scene.pbrt:10:36", "there is no `ln` in formulas", "did you mean `log`?"] {
        assert!(err.contains(part), "no `{part}` in {err}");
    }
}

#[test]
fn scene_check_does_not_render() {
    let folder = Folder::with_scene("check");
    let right = folder.alhazen(&["scene", "check", "scene.pbrt"]).expect(0);
    assert_eq!((right.out.as_str(), right.err.as_str()), ("scene.pbrt is valid\n", ""));
    folder.write("films.pbrt", &SCENE.replace("Film \"rgb\"", "Film \"rgb\" Film \"rgb\""));
    let warned = folder.alhazen(&["scene", "check", "films.pbrt"]).expect(0);
    assert!(
        warned.err.contains("warning[replaced-statement]: this `Film` replaces an earlier one"),
        "{warned:?}"
    );
    assert!(warned.err.contains("films.pbrt:4:") && warned.err.contains("1 warning"), "{warned:?}");
    let json = folder.alhazen(&["scene", "check", "films.pbrt", "--json"]).expect(0).json();
    assert_eq!(json["warnings"][0]["code"], "replaced-statement");
    folder.write("wrong.pbrt", &SCENE.replace("WorldBegin", "WorldBegins"));
    folder.alhazen(&["scene", "check", "wrong.pbrt"]).expect(1);
    folder.alhazen_reading(&["scene", "check", "-"], SCENE).expect(0);
    assert!(!folder.files().iter().any(|name| name.ends_with(".exr")));
}

#[test]
fn scene_check_says_that_a_picture_may_show_nothing() {
    let folder = Folder::new("black");
    let light = "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]";
    assert!(SCENE.contains(light));
    let lamp = "LightSource \"point\"";
    let black = [
        ("no light", SCENE.replace(light, "")),
        ("no shape", SCENE.replace(light, lamp).replace("Shape", "# Shape")),
        ("no shape in view", SCENE.replace(light, lamp).replace("Shape", "Translate 0 100 0 Shape")),
    ];
    for (name, text) in black {
        folder.write("scene.pbrt", &text);
        let checked = folder.alhazen(&["scene", "check", "scene.pbrt"]).expect(0);
        assert_eq!(
            checked.out, "scene.pbrt is valid, but its picture may show nothing: see above\n",
            "{name}"
        );
        assert!(checked.err.contains("1 warning"), "{name}: {}", checked.err);
    }
}

#[test]
fn a_missing_or_foreign_scene_is_wrong_input() {
    let folder = Folder::new("missing");
    folder.write("a.stl", "solid a");
    folder.write("a.pbrt", "solid a");
    folder.write("a.usda", "#usda 1.0");
    folder.write("a.xml", "<scene version=\"3.0.0\"></scene>");
    for (file, problem) in [
        ("none.pbrt", "none.pbrt"),
        ("a.stl", "cannot read the mesh `a.stl`: unsupported mesh: it has no faces"),
        ("a.pbrt", "an STL mesh"),
        #[cfg(not(feature = "usd"))]
        ("a.usda", "a USD scene, which this program was built without"),
        ("a.xml", "a Mitsuba scene"),
    ] {
        for command in [&["render", file][..], &["scene", "check", file]] {
            let err = folder.alhazen(command).expect(1).err;
            assert!(err.contains(problem) && err.contains("1 error") && !err.contains("warning"), "{err}");
        }
    }
}

/// The option is known, and refused before the scene is read.
#[cfg(not(feature = "serve"))]
#[test]
fn a_program_without_the_server_says_so() {
    let folder = Folder::new("unserved");
    let refused = folder.alhazen(&["render", "none.pbrt", "--serve"]).expect(2);
    assert!(refused.err.contains("built without the server of --serve"), "{refused:?}");
    assert!(refused.err.contains("the cargo feature `serve`"), "{refused:?}");
}

#[test]
fn outputs_are_checked_before_anything_else() {
    let folder = Folder::new("outputs");
    #[cfg(unix)]
    std::os::unix::fs::symlink("loop.exr", folder.path().join("loop.exr")).expect("a link");
    for (output, problem) in [
        ("missing/a.exr", "missing does not exist"),
        ("a.xyz", "cannot tell the format"),
        (".", "cannot tell the format"),
        #[cfg(unix)]
        ("loop.exr", "too many symbolic links"),
    ] {
        // The scene does not exist either, but the output is reported.
        let finished = folder.alhazen(&["render", "none.pbrt", "-o", "good.exr", "-o", output]).expect(2);
        assert!(finished.err.contains(problem), "{finished:?}");
    }
    let json = folder.alhazen(&["render", "none.pbrt", "-o", "a.xyz", "--json"]).expect(2).json();
    assert_eq!(json["status"], "usage");
    assert!(!folder.files().contains(&"good.exr".to_owned()));
}

#[test]
fn a_scene_that_names_an_impossible_output_is_wrong() {
    let folder = Folder::new("film-name");
    folder.write(
        "scene.pbrt",
        &SCENE.replace("Film \"rgb\"", "Film \"rgb\" \"string filename\" \"no/such/a.exr\""),
    );
    let finished = folder.alhazen(&["render", "scene.pbrt"]).expect(1);
    assert!(
        finished.err.contains("no/such does not exist") && finished.err.contains("-o FILE"),
        "{finished:?}"
    );
}

#[test]
fn a_function_is_integrated_beside_the_list_of_its_errors() {
    let folder = Folder::new("function");
    folder.write("scene.pbrt", SCENE);
    let arguments = ["render", "scene.pbrt", "-o", "a.exr", "--integrator", "function", "--set"];
    let err = folder.alhazen(&[&arguments[..], &["filename=no/such.txt"]].concat()).expect(1).err;
    assert!(err.contains("no does not exist"), "{err}");
    folder.alhazen(&[&arguments[..], &["function=disk"]].concat()).expect(0);
    assert_eq!(folder.files(), ["a.exr", "disk-mse.txt", "scene.pbrt"]);
}

#[test]
fn a_mesh_that_cannot_be_written_is_reported_before_the_render() {
    let folder = Folder::new("mesh-out");
    let scene = |file: &str| {
        let integrator = format!("Integrator \"radiosity\" \"string mesh-out\" \"{file}\"");
        SCENE.replace("Integrator \"path\" \"integer maxdepth\" 3", &integrator)
    };
    folder.write("scene.pbrt", &scene("room.obj"));
    let err = folder.alhazen(&["scene", "check", "scene.pbrt"]).expect(1).err;
    assert!(err.contains("scene.pbrt:6:") && err.contains("ends in .ply, not room.obj"), "{err}");
    folder.write("scene.pbrt", &scene("no/such/room.ply"));
    let err = folder.alhazen(&["render", "scene.pbrt"]).expect(1).err;
    assert!(err.contains("no/such does not exist"), "{err}");
    assert_eq!(folder.files(), ["scene.pbrt"], "nothing was rendered");
}

#[test]
fn a_wrong_command_line_is_reported() {
    let folder = Folder::with_scene("usage");
    for (arguments, part) in [
        (&["render"][..], "SCENE"),
        (
            &["render", "scene.pbrt", "--integrator", "magic"],
            "no integrator is called `magic`; there are ray-casting",
        ),
        (&["render", "scene.pbrt", "--set", "depth=3"], "no setting is called `depth`; there are maxdepth"),
        (&["render", "scene.pbrt", "--set", "maxdepth=deep"], "it is a whole number"),
        (
            &["render", "scene.pbrt", "--integrator", "mlt", "--set", "sigma=-1"],
            "cannot set sigma to `-1`: it is a number above 0",
        ),
        (
            &["render", "scene.pbrt", "--integrator", "sppm", "--set", "photons=0"],
            "cannot set photons to `0`: it is a whole number of 1 or more",
        ),
        (&["render", "scene.pbrt", "--set", "iso=-1"], "cannot set iso to `-1`"),
        (&["render", "scene.pbrt", "--set", "filterradius=-1"], "cannot set filterradius to `-1`"),
        (
            &[
                &["render", "scene.pbrt", "--integrator", "bdpt", "--set", "techniques=true"][..],
                &["--set", "maxdepth=8", "--resolution", "760x760"],
            ]
            .concat(),
            "cannot set techniques to `true`: pictures of all strategies take 2.1 GiB, more than 2 GiB",
        ),
        (&["render", "scene.pbrt", "--pixel", "24,0"], "not in the image of 24 × 16 pixels"),
        (&["render", "scene.pbrt", "--threads", "60000"], "cannot start 60000 threads: this machine has"),
        (&["render", "scene.pbrt", "--resolution", "12"], "640x480"),
        (&["render", "scene.pbrt", "--checkpoint", "scene.obj"], "expected a name that ends in .film"),
        (&["paint", "scene.pbrt"], "paint"),
    ] {
        let finished = folder.alhazen(arguments).expect(2);
        assert!(finished.err.contains(part) && !finished.err.contains("scene.pbrt:"), "{finished:?}");
        let json = folder.alhazen(&[arguments, &["--json"]].concat()).expect(2).json();
        assert!(json["errors"][0]["message"].as_str().is_some_and(|text| text.contains(part)), "{json}");
    }
}

#[test]
fn help_names_every_algorithm_and_setting() {
    let folder = Folder::new("help");
    let help = folder.alhazen(&["render", "--help"]).expect(0).out;
    let groups: Vec<_> = alhazen::PARTS.iter().flat_map(alhazen::Part::groups).collect();
    let members = groups.iter().filter_map(|group| group.member).map(|member| member.names[0]);
    let settings = groups.iter().flat_map(|group| &group.settings).map(|setting| setting.field.name);
    for name in members.chain(settings) {
        assert!(help.contains(name), "{name} is not in the help");
    }
    folder.alhazen(&["--version"]).expect(0);
}

#[test]
fn a_camera_that_sees_no_surface_gives_a_warning() {
    let folder = Folder::new("nothing-in-view");
    let scene = |look_at: &str| {
        format!(
            "LookAt {look_at} Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 8 \
             \"integer yresolution\" 8\nWorldBegin LightSource \"point\" \"point3 from\" [0 0 -3] \
             Shape \"sphere\""
        )
    };
    let warning = "no surface seems to be in view";
    for (look_at, is_away) in [("0 0 -5  0 0 0  0 1 0", false), ("0 0 -5  0 0 -9  0 1 0", true)] {
        folder.write("scene.pbrt", &scene(look_at));
        let finished = folder.alhazen(&["render", "scene.pbrt", "--spp", "1", "-o", "a.exr"]).expect(0);
        assert_eq!(finished.err.contains(warning), is_away, "{finished:?}");
    }
}
