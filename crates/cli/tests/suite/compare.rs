//! Tests of `alhazen compare`.

use crate::common::{Folder, SCENE};
use serde_json::Value;

fn report(folder: &Folder, name: &str) -> (String, Value) {
    let read =
        |extension: &str| std::fs::read_to_string(folder.path().join(format!("{name}.{extension}"))).unwrap();
    (read("html"), serde_json::from_str(&read("json")).unwrap())
}

#[test]
fn a_report_is_written_as_page_and_numbers() {
    let folder = Folder::with_scene("compare");
    let arguments =
        ["compare", "scene.pbrt", "--integrators", "path,simplepath,path:maxdepth=1", "--spp", "4"];
    let said = folder.alhazen(&[&arguments[..], &["-o", "a.html"]].concat()).expect(0).out;
    for part in [
        "scene.pbrt: 24 × 16 pixels, 4 samples per pixel for each picture",
        "reference: path, twice 32 passes in ",
        "  simple-path ",
        "  path:maxdepth=1 ",
        "  report   a.html",
        "  report   a.json",
    ] {
        assert!(said.contains(part), "no `{part}` in {said}");
    }
    assert_eq!(folder.files(), ["a.html", "a.json", "scene.pbrt"]);
    let (page, json) = report(&folder, "a");
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
    let names: Vec<_> =
        json["integrators"].as_array().unwrap().iter().map(|run| run["name"].clone()).collect();
    assert_eq!(names, ["path", "simple-path", "path:maxdepth=1"]);
    assert_eq!(json["integrators"][0]["passes"], 4);
    let settings = serde_json::json!({ "maxdepth": 1, "regularize": false, "lightsampler": "bvh" });
    assert_eq!(json["integrators"][2]["settings"], settings);
    assert_eq!(json["integrators"][2]["sampler"], serde_json::json!({ "name": "independent" }));
    assert!(page.contains("maxdepth 1, regularize false, lightsampler bvh; sampler independent"));
}

#[test]
fn a_picture_can_be_the_reference() {
    let folder = Folder::with_scene("compare-reference");
    folder.alhazen(&["render", "scene.pbrt", "--quiet", "--spp", "64", "-o", "r.exr"]).expect(0);
    let arguments =
        ["compare", "scene.pbrt", "--integrators", "path", "--time", "50ms", "--reference", "r.exr"];
    let finished = folder.alhazen(&[&arguments[..], &["--json"]].concat()).expect(0);
    let json = finished.json();
    assert_eq!(json["reference"]["source"], "r.exr");
    assert_eq!(json["outputs"], serde_json::json!(["scene.html", "scene.json"]), "named after the scene");
    assert!(json["integrators"][0]["seconds"].as_f64() >= Some(0.05));
    let mut written = report(&folder, "scene").1;
    written["outputs"] = json["outputs"].clone();
    assert_eq!(written, json, "the same numbers in both");
    let quiet = folder.alhazen(&[&arguments[..], &["--quiet"]].concat()).expect(0);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
}

#[test]
fn invalid_plans_are_refused_before_rendering() {
    let folder = Folder::with_scene("compare-errors");
    folder.alhazen(&["render", "scene.pbrt", "--quiet", "--resolution", "8x8", "-o", "small.exr"]).expect(0);
    // Each of these would take an hour if it began.
    let fails = |arguments: &[&str], code: i32, part: &str| {
        let all = [&["compare", "scene.pbrt", "--time", "1h"], arguments].concat();
        let said = folder.alhazen(&all).expect(code).err;
        assert!(said.contains(part), "no `{part}` in {said}");
    };
    fails(
        &["--integrators", "path,simpel-path"],
        2,
        "no integrator is called `simpel-path`; did you mean `simple-path`?",
    );
    fails(&["--integrators", "path", "--reference-with", "pth"], 2, "did you mean `path`?");
    fails(&["--integrators", "path:samplebsdf=true"], 2, "path:samplebsdf=true: cannot set samplebsdf");
    fails(
        &["--integrators", "path,vcm:alpha=2"],
        2,
        "vcm:alpha=2: cannot set alpha to `2`: it is a number above 0",
    );
    fails(
        &["--integrators", "path,vcm", "--set", "sigma=1"],
        2,
        "cannot set sigma to `1`: no algorithm here has",
    );
    fails(&["--integrators", "path,bdpt", "--set", "maxdepth=-1"], 2, "path: cannot set maxdepth to `-1`");
    fails(&["--integrators", "path,vcm,path"], 2, "path is listed twice");
    fails(&["--integrators", "bdpt:techniques=true"], 2, "a comparison writes no files but its report");
    fails(&["--integrators", "path", "--reference", "none.exr"], 1, "none.exr: ");
    fails(&["--integrators", "path", "--reference", "scene.pbrt"], 1, "scene.pbrt: ");
    fails(
        &["--integrators", "path", "--reference", "small.exr"],
        1,
        "small.exr has 8 × 8 pixels, not the scene's 24 × 16",
    );
    fails(&["--integrators", "path", "-o", "none/a.html"], 2, "none does not exist");
    fails(&["--integrators", "path", "-o", "a.exr"], 2, "its extension is .html");
    folder.write("scene.pbrt", "WorldBegin\nShape \"spere\"\n");
    fails(&["--integrators", "path"], 1, "scene.pbrt:2");
    assert_eq!(folder.files(), ["scene.pbrt", "small.exr"]);
}

#[cfg(unix)]
#[test]
fn an_interruption_leaves_a_report() {
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Command, Stdio};

    let folder = Folder::with_scene("compare-interrupt");
    folder.alhazen(&["render", "scene.pbrt", "--quiet", "-o", "r.exr"]).expect(0);
    // The warning about the second film is printed when rendering begins, so that the test knows
    // when to interrupt it.
    folder.write("scene.pbrt", &SCENE.replace("Film \"rgb\"", "Film \"rgb\" Film \"rgb\""));
    let arguments = ["compare", "scene.pbrt", "--integrators", "path,whitted", "--spp", "100000000"];
    let mut child = folder
        .command(&[&arguments[..], &["--reference", "r.exr", "-o", "a.html"]].concat())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let errors = BufReader::new(child.stderr.take().expect("standard error"));
    let begun = errors.lines().map_while(Result::ok).any(|line| line.contains("1 warning"));
    assert!(begun, "the program ended before it rendered");
    std::thread::sleep(std::time::Duration::from_secs(1));
    assert!(
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs").success()
    );
    let status = child.wait().expect("the program ends");
    let mut said = String::new();
    child.stdout.take().expect("standard output").read_to_string(&mut said).expect("text");
    assert_eq!(status.code(), Some(130), "{said}");
    assert!(said.contains("interrupted; the report covers what was rendered"), "{said}");
    let (page, json) = report(&folder, "a");
    assert!(page.contains("Interrupted") && page.contains("<p class=\"warning\">Warning: "));
    assert_eq!((&json["status"], &json["missing"]), (&"interrupted".into(), &serde_json::json!(["whitted"])));
    assert!(json["integrators"][0]["passes"].as_u64() > Some(0));
}
