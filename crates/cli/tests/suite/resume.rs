//! Renders that are saved, resumed, sharded and merged have the bits of those that are not.

use std::fs;
use std::path::Path;

use crate::common::Folder;
use alhazen::film::{FilmFile, FilmHeader};
use serde_json::Value;

/// A closed box with a lamp, a mirror and glass: paths of all kinds.
const ROOM: &str = r#"
LookAt 0 0 -0.9  0 0 1  0 1 0
Camera "perspective" "float fov" 80
Film "rgb" "integer xresolution" 32 "integer yresolution" 32 "bool savefp16" false
Sampler "zsobol" "integer pixelsamples" 4
WorldBegin
Texture "tiles" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.5 ]
Shape "trianglemesh" "point3 P" [ -1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1 ]
  "integer indices" [ 0 1 2 0 2 3  4 5 6 4 6 7  0 4 7 0 7 3  1 5 6 1 6 2  3 2 6 3 6 7 ]
Material "diffuse" "texture reflectance" "tiles"
Shape "trianglemesh" "point3 P" [ -1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1 ] "integer indices" [ 0 1 2 0 2 3 ]
  "point2 uv" [ 0 0  1 0  1 1  0 1 ]
AttributeBegin
Translate -0.4 -0.6 0.4
Material "dielectric"
Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
Translate 0.5 -0.6 0.2
Material "conductor" "float roughness" 0.2
Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
Shape "trianglemesh" "point3 P" [ -0.3 0.98 -0.3  0.3 0.98 -0.3  0.3 0.98 0.3  -0.3 0.98 0.3 ]
  "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
"#;

/// The algorithms, with settings that make them quick.
const INTEGRATORS: [(&str, &[&str]); 7] = [
    ("path", &[]),
    ("bdpt", &["maxdepth=2", "techniques=true"]),
    ("mlt", &[]),
    ("sppm", &[]),
    ("vcm", &[]),
    ("photon-mapping", &["photons=2000", "causticphotons=2000"]),
    ("radiosity", &["steps=2", "tolerance=0.5", "patchsize=0.7", "subdivision=1", "gather=2"]),
];

fn room(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("room.pbrt", ROOM);
    folder
}

/// The arguments of a render of the room.
fn render<'a>(integrator: (&'a str, &[&'a str]), more: &[&'a str]) -> Vec<&'a str> {
    let settings = integrator.1.iter().flat_map(|setting| ["--set", setting]);
    let start = ["render", "room.pbrt", "--quiet", "--integrator", integrator.0, "--spp", "8"];
    start.into_iter().chain(settings).chain(more.iter().copied()).collect()
}

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn header(folder: &Folder, name: &str) -> FilmHeader {
    FilmFile::read_header(&bytes(folder, name)[..]).expect("a film file")
}

/// All pictures that begin with a name, without that name.
fn pictures(folder: &Folder, start: &str) -> Vec<(String, Vec<u8>)> {
    let names = folder.files().into_iter().filter(|name| name.ends_with(".exr"));
    let rests = names.filter_map(|name| name.strip_prefix(start).map(str::to_owned));
    rests.map(|rest| (rest.clone(), bytes(folder, &format!("{start}{rest}")))).collect()
}

#[test]
fn resumed_and_sharded_renders_have_the_bits_of_unbroken_ones() {
    for integrator in INTEGRATORS {
        let folder = room(&format!("resume-{}", integrator.0));
        let run = |arguments: &[&str]| folder.alhazen(arguments).expect(0);
        run(&render(integrator, &["-o", "whole.exr"]));

        // At least one pass is done in any time.
        run(&render(integrator, &["-o", "a.exr", "--checkpoint", "a.film", "--time", "1ms"]));
        assert_eq!(header(&folder, "a.film").done.to_string(), "0");
        run(&["resume", "a.film", "--quiet", "--spp", "3", "-o", "a.exr"]);
        assert_eq!(header(&folder, "a.film").done.to_string(), "0-2");
        run(&["resume", "a.film", "--quiet", "--spp", "8", "-o", "resumed.exr"]);
        assert_eq!(header(&folder, "a.film").done.to_string(), "0-7");

        for shard in ["1/3", "2/3", "3/3"] {
            let film = format!("part{}.film", &shard[..1]);
            run(&render(integrator, &["--shard", shard, "--checkpoint", &film]));
        }
        run(&["merge", "part3.film", "part1.film", "part2.film", "--quiet", "-o", "merged.exr"]);

        let whole = pictures(&folder, "whole");
        assert_eq!(whole.len(), if integrator.0 == "bdpt" { 1 + 2 * 8 } else { 1 });
        for other in ["resumed", "merged"] {
            assert!(pictures(&folder, other) == whole, "{}: {other} is another picture", integrator.0);
        }
    }
}

#[test]
fn resuming_a_finished_render_changes_nothing() {
    let folder = room("resume-done");
    let saved = ["-o", "whole.exr", "--checkpoint", "whole.film"];
    folder.alhazen(&render(INTEGRATORS[0], &saved)).expect(0);
    let film = bytes(&folder, "whole.film");
    for (more, passes) in [(&[][..], 8), (&["--spp", "8"], 8), (&["--spp", "3"], 3)] {
        let resumed =
            folder.alhazen(&[&["resume", "whole.film", "-o", "again.exr"], more].concat()).expect(0);
        let note = format!("all {passes} are done already: the film has 8");
        assert!(resumed.out.contains(&note), "{resumed:?}");
        assert!(bytes(&folder, "again.exr") == bytes(&folder, "whole.exr"));
        assert!(bytes(&folder, "whole.film") == film, "there was nothing to save");
    }
    // A single film is whole, too.
    folder.alhazen(&["merge", "whole.film", "-o", "merged.exr", "--quiet"]).expect(0);
    assert!(bytes(&folder, "merged.exr") == bytes(&folder, "whole.exr"));
}

#[test]
fn samples_beyond_the_plan_are_reported() {
    let folder = room("resume-beyond");
    let resumed = |sampler: &str| {
        let plain: Vec<&str> = ROOM.lines().filter(|line| !line.contains("\"tiles\"")).collect();
        folder.write("room.pbrt", &plain.join("\n").replace("zsobol", sampler));
        folder.alhazen(&["render", "room.pbrt", "-o", "long.exr", "--quiet", "--spp", "8"]).expect(0);
        let saved = ["render", "room.pbrt", "-o", "a.exr", "--quiet", "--checkpoint", "a.film", "--spp", "4"];
        folder.alhazen(&saved).expect(0);
        let resumed = folder.alhazen(&["resume", "a.film", "--spp", "8", "-o", "a.exr", "--json"]).expect(0);
        let note = resumed.json()["notes"]["samples"].as_str().map(str::to_owned);
        (note, bytes(&folder, "a.exr") == bytes(&folder, "long.exr"))
    };
    let (note, same) = resumed("zsobol");
    assert!(note.is_some_and(|note| note.contains("arranged for 4 per pixel")) && !same);
    for sampler in ["independent", "halton", "sobol"] {
        assert_eq!(resumed(sampler), (None, true), "{sampler}");
    }
}

#[test]
fn the_samples_of_every_sampler_are_as_many_as_asked_for() {
    let folder = room("resume-numbers");
    for sampler in ["independent", "stratified", "halton", "paddedsobol", "sobol", "zsobol", "pmj02bn"] {
        for samples in ["1", "5", "12"] {
            let set = format!("sampler={sampler}");
            let render = |more: &[&str]| {
                let start = ["render", "room.pbrt", "--json", "--resolution", "8x8", "--set", &set];
                folder.alhazen(&[&start, &["--spp", samples][..], more].concat()).expect(0).json()
            };
            let whole = render(&["-o", "whole.exr"]);
            assert_eq!(whole["samples_per_pixel"].to_string(), samples, "{sampler}");
            render(&["-o", "part.exr", "--time", "0.001ms", "--checkpoint", "a.film"]);
            let resumed = ["resume", "a.film", "--json", "--spp", samples, "--time", "1h", "-o", "part.exr"];
            let resumed = folder.alhazen(&resumed).expect(0).json();
            assert_eq!(resumed["samples_per_pixel"].to_string(), samples, "{sampler}");
            assert_eq!(resumed["notes"]["samples"], Value::Null, "{sampler}");
            assert!(bytes(&folder, "part.exr") == bytes(&folder, "whole.exr"), "{sampler} {samples}");
        }
    }
}

#[test]
fn another_number_of_samples_is_that_of_a_new_render_or_is_reported() {
    let folder = room("resume-other-numbers");
    let run = |arguments: &[&str]| folder.alhazen(arguments).expect(0).json();
    for sampler in ["stratified", "paddedsobol", "sobol", "zsobol", "pmj02bn"] {
        let set = format!("sampler={sampler}");
        let start = ["render", "room.pbrt", "--json", "--resolution", "8x8", "--set", &set];
        for [planned, asked] in [["6", "8"], ["8", "5"], ["6", "9"], ["6", "3"]] {
            run(&[&start[..], &["-o", "new.exr", "--spp", asked]].concat());
            let stopped = ["-o", "a.exr", "--spp", planned, "--time", "0.001ms", "--checkpoint", "a.film"];
            run(&[&start[..], &stopped].concat());
            let resumed = run(&["resume", "a.film", "--json", "--spp", asked, "-o", "a.exr"]);
            let is_same = bytes(&folder, "a.exr") == bytes(&folder, "new.exr");
            let is_told = resumed["notes"]["samples"].is_string();
            assert_eq!(is_same, !is_told, "{sampler}: {planned} and {asked}");
            let is_arranged_alike =
                ["8", "5", "6"].contains(&asked) && !["stratified", "paddedsobol"].contains(&sampler);
            assert_eq!(is_same, is_arranged_alike, "{sampler}: {planned} and {asked}");
        }
    }
}

#[test]
fn noise_and_time_end_a_render() {
    let folder = room("resume-limits");
    let noisy = |more: &[&str]| {
        let start = ["render", "room.pbrt", "-o", "a.exr", "--json", "--noise", "0.15"];
        folder.alhazen(&[&start[..], more].concat()).expect(0).json()
    };
    let whole = noisy(&[]);
    assert_eq!(whole["ended_by"], "noise");
    let (noise, passes) = (whole["noise"].as_f64(), whole["passes"].as_u64());
    assert!(noise.is_some_and(|noise| noise > 0.1 && noise <= 0.15), "{noise:?}");
    assert!(passes.is_some_and(|passes| passes > 16), "more than the scene plans: {passes:?}");
    let picture = bytes(&folder, "a.exr");

    // Interrupted by time and resumed, it ends at the same pass.
    let timed = noisy(&["--time", "1ms", "--checkpoint", "a.film"]);
    assert_eq!((&timed["ended_by"], &timed["passes"]), (&"time".into(), &1.into()));
    let again = folder.alhazen(&["resume", "a.film", "--json", "-o", "b.exr"]).expect(0).json();
    assert_eq!((&again["ended_by"], &again["passes"]), (&"time".into(), &1.into()), "the time was up before");
    let resumed =
        folder.alhazen(&["resume", "a.film", "--noise", "0.15", "--json", "-o", "b.exr"]).expect(0).json();
    assert_eq!((&resumed["ended_by"], resumed["noise"].as_f64()), (&"noise".into(), noise));
    assert!(bytes(&folder, "b.exr") == picture);

    let few = noisy(&["--spp", "2"]);
    assert_eq!((&few["ended_by"], &few["passes"], &few["noise"]), (&"passes".into(), &2.into(), &().into()));
}

#[test]
fn noise_that_is_not_reached_is_a_warning() {
    let folder = room("resume-noise");
    let noisy = |more: &[&str]| {
        let start = ["render", "room.pbrt", "-o", "a.exr", "--integrator", "path", "--noise"];
        folder.alhazen(&[&start[..], more].concat()).expect(0)
    };
    for (more, expected) in [
        (&["0.001", "--spp", "16"][..], "after all passes, above the limit of 0.001"),
        (&["0.1", "--spp", "2"], "the noise is unknown after all passes, for 2 are too few"),
        (&["0.1", "--time", "0.001ms"], "the noise is unknown when the time was up, for 1 are too few"),
    ] {
        let warnings = noisy(&[more, &["--json"]].concat()).json()["warnings"].clone();
        assert_eq!(warnings[0]["code"], "noise-not-reached");
        let message = warnings[0]["message"].as_str().unwrap();
        assert!(message.contains(expected), "{message}");
        assert!(noisy(more).err.contains(message));
        assert_eq!(noisy(&[more, &["--quiet"]].concat()).err, "");
    }
    assert_eq!(noisy(&["0.5", "--spp", "64", "--json"]).json()["warnings"], Value::Array(Vec::new()));
}

#[test]
fn films_that_cannot_be_merged_are_named() {
    let folder = room("resume-errors");
    let run = |arguments: &[&str], code| folder.alhazen(arguments).expect(code).err;
    let part = |shard: &str, film: &str, more: &[&str]| {
        run(&[&render(INTEGRATORS[0], &["--shard", shard, "--checkpoint", film])[..], more].concat(), 0);
    };
    part("1/4", "1.film", &[]);
    part("2/4", "2.film", &[]);
    part("3/4", "3.film", &["--time", "1ms"]);
    part("1/4", "seed.film", &["--seed", "7"]);

    let merge = |films: &[&str]| run(&[&["merge", "-o", "a.exr"], films].concat(), 1);
    let problem = merge(&["1.film", "2.film", "3.film"]);
    assert!(problem.contains("missing passes 5 of shard 3/4 and shard 4/4 (passes 6-7)"), "{problem}");
    let problem = merge(&["1.film", "2.film", "1.film"]);
    assert!(problem.contains("1.film: passes 0-1 are in 1.film too"), "{problem}");
    part("1/3", "third.film", &[]);
    let problem = merge(&["third.film", "2.film"]);
    let splits = "The films are of different splits: third.film is shard 1/3, 2.film is shard 2/4";
    assert!(problem.contains("missing passes 4-7") && problem.contains(splits), "{problem}");
    let problem = merge(&["third.film", "1.film"]);
    let splits = "The films are of different splits: third.film is shard 1/3, 1.film is shard 1/4";
    assert!(
        problem.contains("1.film: passes 0-1 are in third.film too") && problem.contains(splits),
        "{problem}"
    );
    let problem = merge(&["2.film", "seed.film"]);
    assert!(problem.contains("seed.film: not of the same render as 2.film"), "{problem}");

    let whole = bytes(&folder, "1.film");
    for (name, damaged, expected) in [
        ("short", whole[..whole.len() / 2].to_vec(), "damaged film file"),
        ("empty", Vec::new(), "not a film file"),
        ("other", ROOM.as_bytes().to_vec(), "not a film file"),
        ("flipped", flipped(&whole), "checksum"),
    ] {
        let name = format!("{name}.film");
        fs::write(folder.path().join(&name), &damaged).expect("a file for the test");
        for problem in [merge(&[&name]), run(&["resume", &name, "-o", "a.exr"], 1)] {
            assert!(problem.contains(&name) && problem.contains(expected), "{problem}");
        }
        assert!(bytes(&folder, &name) == damaged, "an error leaves the film file as it is");
    }
    assert!(!folder.files().contains(&"a.exr".to_owned()));

    let problem = run(&["resume", "2.film", "--spp", "16", "-o", "a.exr"], 2);
    assert!(problem.contains("the film is shard 2/4 of 8 passes"), "{problem}");
    folder.write("room.pbrt", &ROOM.replace("radius\" 0.3", "radius\" 0.31"));
    let problem = run(&["resume", "2.film", "-o", "a.exr"], 1);
    assert!(problem.contains("2.film: files of the scene "), "{problem}");
    part("3/4", "3.film", &[]);
    let problem = merge(&["2.film", "3.film"]);
    assert!(problem.contains("3.film: not of the same render as 2.film: the scenes differ"), "{problem}");
}

fn flipped(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    bytes
}

#[test]
fn invalid_combinations_of_options_are_refused() {
    let folder = room("resume-usage");
    let shard = ["--checkpoint", "a.film", "--shard"];
    for arguments in [
        &["--shard", "1/2"][..],
        &[&shard[..], &["0/2"]].concat(),
        &[&shard[..], &["3/2"]].concat(),
        &[&shard[..], &["1/9"]].concat(),
        &[&shard[..], &["1/2", "--noise", "0.1"]].concat(),
        &["--checkpoint", "missing/a.film"],
        &["--noise", "0"],
        &["--time", "0s"],
    ] {
        folder.alhazen(&render(INTEGRATORS[0], arguments)).expect(2);
    }
    let piped = folder.alhazen(&["render", "-", "--checkpoint", "a.film"]).expect(2);
    assert!(piped.err.contains("standard input cannot be read again"), "{}", piped.err);
    assert_eq!(folder.files(), ["room.pbrt"]);
}

#[cfg(unix)]
#[test]
fn a_kill_loses_neither_passes_nor_files() {
    use std::process::Stdio;
    use std::time::Duration;

    let rounds = std::env::var("ALHAZEN_KILLS").map_or(5, |rounds| rounds.parse().expect("a number"));
    let folder = room("resume-kill");
    let spp = (rounds * 40).to_string();
    let start = ["render", "room.pbrt", "--spp", &spp, "--quiet"];
    folder.alhazen(&[&start[..], &["-o", "whole.exr"]].concat()).expect(0);
    let save = ["-o", "a.exr", "--every", "10ms"];
    let mut passes = 0;
    for round in 0..rounds {
        let arguments = match Path::exists(&folder.path().join("a.film")) {
            true => [&["resume", "a.film", "--quiet"], &save[..]].concat(),
            false => [&start[..], &save, &["--checkpoint", "a.film"]].concat(),
        };
        let mut child = folder.command(&arguments).stderr(Stdio::null()).spawn().expect("the program runs");
        // At any moment of start, render and saving.
        std::thread::sleep(Duration::from_millis(20 + round * 61 % 210));
        // It may have ended before.
        let _ = child.kill();
        child.wait().expect("the program ends");
        if folder.files().contains(&"a.film".to_owned()) {
            let done = header(&folder, "a.film").done;
            assert!(done.count() >= passes, "round {round}: {} passes after {passes}", done.count());
            passes = done.count();
            assert_eq!(done.ranges().len(), 1, "passes are done in order: {done}");
        }
    }
    let arguments = match passes {
        0 => [&start[..], &["-o", "a.exr", "--checkpoint", "a.film"]].concat(),
        _ => vec!["resume", "a.film", "--quiet", "-o", "a.exr"],
    };
    folder.alhazen(&arguments).expect(0);
    assert!(bytes(&folder, "a.exr") == bytes(&folder, "whole.exr"));
    let leftovers = folder.files().into_iter().filter(|name| name.starts_with(".a.film"));
    assert_eq!(leftovers.count(), 0, "leftovers of killed programs are removed");
}
