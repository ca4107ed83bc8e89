//! What the program prints: versions, manuals and completions, and what happens where its output
//! cannot be delivered.

use std::io::Read;
use std::process::Stdio;

use crate::common::Folder;
use alhazen::image::{Image, WriteOptions, write};

#[test]
fn the_version_contains_the_commit() {
    let folder = Folder::new("version");
    let out = folder.alhazen(&["--version"]).expect(0).out;
    let start = format!("alhazen {}", env!("CARGO_PKG_VERSION"));
    let rest = out.trim_end().strip_prefix(&start).unwrap_or_else(|| panic!("{out}"));
    // Built from an unpacked archive, the commit is unknown.
    if std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../.git")).exists() {
        let [hash, date] = rest.trim_matches([' ', '(', ')']).split(' ').collect::<Vec<_>>()[..] else {
            panic!("{out}")
        };
        assert!(hash.len() >= 7 && hash.chars().all(|c| c.is_ascii_hexdigit()), "{out}");
        assert!(date.len() == 10 && date.starts_with("20"), "{out}");
    } else {
        assert_eq!(rest, "");
    }
}

#[test]
fn completions_and_man_pages_contain_every_command() {
    let folder = Folder::new("manual");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.alhazen(&["completions", shell]).expect(0).out;
        assert!(script.contains("integrator") && script.contains("convert"), "{shell}: {script}");
    }
    folder.alhazen(&["completions", "csh"]).expect(2);
    let page = folder.alhazen(&["man"]).expect(0).out;
    assert!(page.contains(".TH alhazen 1") && page.contains("alhazen\\-render(1)"), "{page}");
    folder.alhazen(&["man", "share/man1"]).expect(0);
    let pages = std::fs::read_dir(folder.path().join("share/man1")).expect("a folder").count();
    assert!(pages >= 8, "{pages}");
    let render = std::fs::read_to_string(folder.path().join("share/man1/alhazen-render.1")).expect("a page");
    assert!(render.contains("\\-\\-spp") && render.contains("maxdepth"), "{render}");
}

#[test]
fn quiet_and_json_go_together() {
    let folder = Folder::with_scene("quiet-json");
    let both = folder.alhazen(&["render", "scene.pbrt", "--quiet", "--json"]).expect(0);
    assert_eq!((both.json()["status"].as_str(), both.err.as_str()), (Some("done"), ""));
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_an_error() {
    let folder = Folder::with_scene("full");
    let picture = Image::from_fn(4, 4, ["R", "G", "B"], |_, _| [0.5; 3]);
    write(&picture, folder.path().join("a.exr"), &WriteOptions::default()).expect("a picture for the test");
    folder.alhazen(&["render", "scene.pbrt", "--checkpoint", "a.film", "--quiet"]).expect(0);
    for arguments in [
        &["render", "scene.pbrt"][..],
        &["render", "scene.pbrt", "--json"],
        &["render", "none.pbrt", "--json"],
        &["resume", "a.film"],
        &["resume", "a.film", "--json"],
        &["merge", "a.film"],
        &["merge", "a.film", "--json"],
        &["compare", "scene.pbrt", "--integrators", "path", "--spp", "1"],
        &["scene", "check", "scene.pbrt"],
        &["scene", "check", "scene.pbrt", "--json"],
        &["image", "diff", "a.exr", "a.exr"],
        &["image", "diff", "a.exr", "a.exr", "--json"],
        &["image", "info", "a.exr"],
        &["image", "convert", "a.exr", "b.exr", "--json"],
        &["completions", "bash"],
        &["man"],
        &["--help"],
        &["--version"],
    ] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("/dev/full");
        let output = folder.command(arguments).stdout(full).stderr(Stdio::piped()).output().expect("it runs");
        let err = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {err}");
        assert!(err.contains("cannot write to standard output: No space left"), "{arguments:?}: {err}");
    }
}

#[test]
fn a_broken_pipe_is_not_an_error() {
    let folder = Folder::with_scene("pipe");
    let mut child = folder
        .command(&["render", "scene.pbrt", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it runs");
    drop(child.stdout.take());
    let mut err = String::new();
    child.stderr.take().expect("standard error").read_to_string(&mut err).expect("text");
    assert_eq!((child.wait().expect("it ends").code(), err.as_str()), (Some(0), ""));
}

#[cfg(unix)]
#[test]
fn pictures_are_written_through_symbolic_links() {
    let folder = Folder::with_scene("symlink");
    std::fs::create_dir(folder.path().join("store")).expect("a folder");
    std::os::unix::fs::symlink("store/a.exr", folder.path().join("link.exr")).expect("a link");
    folder.alhazen(&["render", "scene.pbrt", "-o", "link.exr"]).expect(0);
    assert!(folder.path().join("link.exr").is_symlink());
    assert_eq!(folder.image("store/a.exr").width(), 24);
}
