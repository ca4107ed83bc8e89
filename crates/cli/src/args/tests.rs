//! Tests of the definition of the command line.

use super::*;
use alhazen::Overrides;
use clap::CommandFactory;

fn render(arguments: &[&str]) -> Result<Render, String> {
    let cli = Cli::try_parse_from(["alhazen", "render", "a.pbrt"].iter().chain(arguments));
    match cli.map_err(|error| error.to_string())?.command {
        Command::Render(render) => Ok(*render),
        other => Err(format!("{other:?}")),
    }
}

#[test]
fn the_definition_is_consistent() {
    Cli::command().debug_assert();
}

#[test]
fn options_become_overrides() {
    let arguments = [
        "--integrator",
        "path",
        "--set",
        "maxdepth=3",
        "--set",
        "filter=box",
        "--accelerator",
        "none",
        "--engine",
        "scalar",
        "--spp",
        "4",
        "--resolution",
        "64x32",
        "--crop",
        "0,0.5,0.25,1",
        "--seed",
        "9",
        "-o",
        "a.exr",
        "-o",
        "b.png",
    ];
    let render = render(&arguments).unwrap();
    let expected = Overrides {
        integrator: Some("path".into()),
        accelerator: Some("none".into()),
        settings: vec![
            ("maxdepth".into(), "3".into()),
            ("filter".into(), "box".into()),
            ("engine".into(), "scalar".into()),
        ],
        samples_per_pixel: Some(4),
        resolution: Some([64, 32]),
        crop: Some([0.0, 0.5, 0.25, 1.0]),
        pixel: None,
        seed: Some(9),
        layers: Vec::new(),
    };
    assert_eq!(render.overrides(), expected);
    assert_eq!(render.output, [PathBuf::from("a.exr"), PathBuf::from("b.png")]);
}

fn compare(arguments: &[&str]) -> Result<Compare, String> {
    let cli = Cli::try_parse_from(["alhazen", "compare", "a.pbrt"].iter().chain(arguments));
    match cli.map_err(|error| error.to_string())?.command {
        Command::Compare(compare) => Ok(*compare),
        other => Err(format!("{other:?}")),
    }
}

#[test]
fn comparisons_have_algorithms_and_one_limit() {
    let compared = compare(&["--integrators", "path,path:maxdepth=8", "--time", "1.5min"]).unwrap();
    assert_eq!(compared.time, Some(Duration::from_secs(90)));
    let names: Vec<String> = compared.integrators.iter().map(ToString::to_string).collect();
    assert_eq!(names, ["path", "path:maxdepth=8"]);
    let named = ["--integrators", "path"];
    for arguments in [
        &["--spp", "4"][..],
        &named,
        &[&named[..], &["--time", "1s", "--spp", "4"]].concat(),
        &[&named[..], &["--time", "0s"]].concat(),
        &[&named[..], &["--time", "1 day"]].concat(),
        &["--integrators", "path,", "--spp", "4"],
        &[&named[..], &["--spp", "4", "--reference", "a.exr", "--reference-spp", "4"]].concat(),
    ] {
        assert!(compare(arguments).is_err(), "{arguments:?}");
    }
}

#[test]
fn values_that_make_no_sense_are_refused() {
    for arguments in [
        ["--resolution", "640"],
        ["--resolution", "0x480"],
        ["--resolution", "640x-1"],
        ["--crop", "0,1,0"],
        ["--crop", "0,2,0,1"],
        ["--crop", "0.5,0.5,0,1"],
        ["--crop", "nan,1,0,1"],
        ["--pixel", "1"],
        ["--pixel", "-1,2"],
        ["--set", "maxdepth"],
        ["--spp", "0"],
        ["--threads", "0"],
        ["--seed", "-1"],
    ] {
        assert!(render(&arguments).is_err(), "{arguments:?}");
    }
}
