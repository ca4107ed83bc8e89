//! Ctrl-C leaves a valid picture.
#![cfg(unix)]

mod common;

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use common::{Folder, SCENE};

/// A render that would take for ever, interrupted after a moment: its exit code and what it said.
fn interrupted(folder: &Folder, signal: &str) -> (Option<i32>, String) {
    // The warning about the sensor is printed when the render begins, which tells when to interrupt
    // it.
    folder.write(
        "scene.pbrt",
        &SCENE.replace("Film \"rgb\"", "Film \"rgb\" \"string sensor\" \"canon_eos_100d\""),
    );
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
    // The picture is to be seen long before it is done.
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
fn the_picture_is_written_as_it_stands() {
    for (name, signal) in [("interrupt", "-INT"), ("terminate", "-TERM")] {
        let folder = Folder::new(name);
        let (code, said) = interrupted(&folder, signal);
        assert_eq!(code, Some(130), "{said}");
        assert!(
            said.contains("interrupted after ") && said.contains("the picture is written as it stands"),
            "{said}"
        );
        let exr = folder.image("a.exr");
        assert_eq!((exr.width(), exr.height()), (24, 16));
        assert!(exr.values().all(f32::is_finite) && exr.values().any(|value| value > 0.1));
        assert_eq!(folder.image("a.png").width(), 24);
        assert_eq!(folder.files(), ["a.exr", "a.png", "scene.pbrt"], "no leftovers");
    }
}
