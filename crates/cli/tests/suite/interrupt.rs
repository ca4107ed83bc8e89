//! Ctrl-C leaves a valid picture, and ends the program at any moment.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{Folder, SCENE};

/// An unlimited render, interrupted after a moment: its exit code and standard output.
fn interrupted(folder: &Folder, signal: &str) -> (Option<i32>, String) {
    // The warning about the second film is printed when the render begins, so that the test knows
    // when to interrupt it.
    folder.write("scene.pbrt", &SCENE.replace("Film \"rgb\"", "Film \"rgb\" Film \"rgb\""));
    let arguments = ["render", "scene.pbrt", "--spp", "100000000", "-o", "a.exr", "-o", "a.png"];
    let mut child = folder
        .command(&arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let errors = BufReader::new(child.stderr.take().expect("standard error"));
    let begun = errors.lines().map_while(Result::ok).any(|line| line.contains("1 warning"));
    assert!(begun, "the program ended before it rendered");
    // A preview is written long before the render is done.
    let deadline = Instant::now() + Duration::from_secs(60);
    while !folder.path().join("a.png").exists() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(50));
    }
    assert_eq!(folder.image("a.exr").width(), 24);
    let pid = child.id().to_string();
    assert!(Command::new("kill").args([signal, &pid]).status().expect("kill runs").success());
    let status = child.wait().expect("the program ends");
    let mut said = String::new();
    child.stdout.take().expect("standard output").read_to_string(&mut said).expect("text");
    (status.code(), said)
}

#[test]
fn an_interrupted_render_writes_its_picture() {
    for (name, signal) in [("interrupt", "-INT"), ("terminate", "-TERM")] {
        let folder = Folder::new(name);
        let (code, said) = interrupted(&folder, signal);
        assert_eq!(code, Some(130), "{said}");
        assert!(
            said.contains("interrupted after ") && said.contains("the picture so far is written"),
            "{said}"
        );
        let exr = folder.image("a.exr");
        assert_eq!((exr.width(), exr.height()), (24, 16));
        assert!(exr.values().all(f32::is_finite) && exr.values().any(|value| value > 0.1));
        assert_eq!(folder.image("a.png").width(), 24);
        assert_eq!(folder.files(), ["a.exr", "a.png", "scene.pbrt"], "no leftovers");
    }
}

/// Sends an interrupt to a program once it listens for it.
#[cfg(target_os = "linux")]
fn interrupt(child: &std::process::Child) {
    let pid = child.id().to_string();
    let deadline = Instant::now() + Duration::from_secs(60);
    let listens = || {
        let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        // The signal of number 2.
        caught.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).is_ok_and(|mask| mask & 2 != 0))
    };
    while !listens() {
        assert!(Instant::now() < deadline, "the program has no signal handler");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(Command::new("kill").args(["-INT", &pid]).status().expect("kill runs").success());
}

/// Waits until a program ends: its exit code and what it wrote to standard output.
#[cfg(target_os = "linux")]
fn end(mut child: std::process::Child) -> (Option<i32>, serde_json::Value) {
    let status = child.wait().expect("the program ends");
    let mut out = String::new();
    child.stdout.take().expect("standard output").read_to_string(&mut out).expect("text");
    (status.code(), serde_json::from_str(&out).expect("JSON"))
}

#[cfg(target_os = "linux")]
#[test]
fn the_import_ends_at_once() {
    let folder = Folder::new("interrupt-import");
    // The scene never arrives.
    let mut command = folder.command(&["render", "-", "--json", "-o", "a.exr"]);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the program runs");
    let _open = child.stdin.take();
    interrupt(&child);
    let (code, json) = end(child);
    assert_eq!(code, Some(130));
    assert_eq!(json, serde_json::json!({ "status": "interrupted", "outputs": [], "passes": 0 }));
    assert!(folder.files().is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn a_second_interrupt_ends_a_program_that_is_stuck() {
    use std::io::BufReader;

    let folder = Folder::new("interrupt-stuck");
    folder.write("scene.pbrt", &SCENE.replace("24", "240").replace("16", "160"));
    let pipe = folder.path().join("a.exr");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let mut command =
        folder.command(&["render", "scene.pbrt", "--json", "--spp", "100000000", "-o", "a.exr"]);
    let child = command.stdout(Stdio::piped()).spawn().expect("the program runs");
    // The rest of the first preview is not read, so that writing it blocks.
    let mut reader = BufReader::with_capacity(1, std::fs::File::open(&pipe).expect("the pipe"));
    while reader.read(&mut [0]).expect("a byte") == 0 {
        std::thread::sleep(Duration::from_millis(20));
    }
    interrupt(&child);
    std::thread::sleep(Duration::from_millis(100));
    interrupt(&child);
    let (code, json) = end(child);
    assert_eq!(
        (code, &json["status"], &json["outputs"]),
        (Some(130), &"interrupted".into(), &serde_json::json!([]))
    );
}

/// A white box that light does not leave, so that a pass takes a second or so.
#[cfg(target_os = "linux")]
const BOX: &str = r#"
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 256 "integer yresolution" 256
Sampler "independent"
Integrator "simplepath" "integer maxdepth" 10
WorldBegin
Material "diffuse" "rgb reflectance" [ 1 1 1 ]
AreaLightSource "diffuse"
ReverseOrientation
Shape "sphere" "float radius" 1
"#;

#[cfg(target_os = "linux")]
#[test]
fn all_passes_before_an_interrupt_are_saved() {
    // The second is interrupted in the middle of a pass.
    for (name, scene) in [("short", SCENE), ("long", BOX)] {
        let folder = Folder::new(&format!("interrupt-{name}-pass"));
        folder.write("scene.pbrt", scene);
        let save = ["--checkpoint", "a.film", "--every", "1h", "-o", "a.exr"];
        let mut command = folder.command(&["render", "scene.pbrt", "--json", "--spp", "100000000"]);
        let child = command.args(save).stdout(Stdio::piped()).spawn().expect("the program runs");
        let deadline = Instant::now() + Duration::from_secs(60);
        while !folder.path().join("a.exr").exists() && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(50));
        }
        interrupt(&child);
        let (code, json) = end(child);
        assert_eq!(
            (code, &json["status"], &json["checkpoint"]),
            (Some(130), &"interrupted".into(), &"a.film".into())
        );
        let passes = json["passes"].to_string();
        let resumed = folder.alhazen(&["resume", "a.film", "--spp", &passes, "-o", "b.exr"]).expect(0);
        assert!(resumed.out.contains(&format!("all {passes} are done already")), "{resumed:?}");
    }
}
