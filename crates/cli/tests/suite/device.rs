//! `--device`: what renders, and what GPUs and their drivers say.

use crate::common::{Finished, Folder};
use crate::render::LAYERED;
use serde_json::Value;

/// Whether or not there is a GPU, the CPU takes what the GPU cannot, and says why and where.
#[test]
fn what_no_gpu_draws_is_left_to_the_cpu() {
    let folder = Folder::new("device");
    folder.write("scene.pbrt", &LAYERED.replace("Shape \"sphere\"", "Shape \"cone\""));
    let arguments = ["render", "scene.pbrt", "-o", "a.exr", "--device", "gpu"];
    let told = folder.alhazen(&arguments).expect(0);
    assert!(told.err.contains("GPU") && told.out.contains("CPU"), "{told:?}");
    let picture = folder.image("a.exr");
    folder.alhazen(&["render", "scene.pbrt", "-o", "b.exr", "--device", "cpu"]).expect(0);
    assert!(picture.values().eq(folder.image("b.exr").values()));
}

/// Layers of Vulkan and libraries of displays write what they like to the terminal.
#[test]
fn no_driver_writes_to_the_terminal() {
    let folder = Folder::with_scene("terminal");
    let run = |arguments: &[&str]| -> Finished {
        let mut command = folder.command(arguments);
        for display in ["DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR"] {
            command.env_remove(display);
        }
        command.arg("--json").output().expect("the program runs").into()
    };
    let told = run(&["doctor"]).expect(0);
    if !told.out.contains("llvmpipe") {
        println!("skipped in part, for there is no Vulkan in software: {}", told.out);
    }
    assert_eq!(told.err, "");
    let view = ["view", "scene.pbrt", "--headless", "--frames", "1"];
    for arguments in [
        &["render", "scene.pbrt", "--device", "gpu"][..],
        &[&view[..], &["--device", "gpu"]].concat(),
        &[&view[..], &["--split"]].concat(),
    ] {
        assert_eq!(run(arguments).err, "", "{arguments:?}");
    }
}

/// A GPU's schedule changes neither the picture nor what the CPU does; where there are no stages,
/// that is said.
#[test]
fn pictures_do_not_depend_on_the_schedule() {
    let folder = Folder::with_scene("schedule");
    let render = |output: &str, more: &[&str]| -> Value {
        let arguments = ["render", "scene.pbrt", "--device", "gpu", "--json", "-o", output];
        folder.alhazen(&[&arguments[..], more].concat()).expect(0).json()
    };
    let by_stages = ["--set", "schedule=wavefront"];
    let told = render("wavefront.exr", &by_stages);
    if told["notes"]["device"] == "CPU" {
        println!("skipped, for there is no GPU: {told}");
        return;
    }
    assert!(told["notes"]["occupancy"].is_string() && told["warnings"] == Value::Array(vec![]), "{told}");
    assert!(render("megakernel.exr", &[])["notes"]["occupancy"].is_null());
    let [wavefront, megakernel] = ["wavefront.exr", "megakernel.exr"].map(|name| folder.image(name));
    for (a, b) in wavefront.values().zip(megakernel.values()) {
        assert!((a - b).abs() <= 1e-4 * b.max(0.01), "{a} instead of {b}");
    }
    let whitted = render("whitted.exr", &[&by_stages[..], &["--integrator", "whitted"]].concat());
    let warning = whitted["warnings"][0]["message"].as_str().unwrap_or_default();
    assert!(warning.contains("no stages for this algorithm"), "{whitted}");

    let contenders = ["compare", "scene.pbrt", "--integrators", "path,path:schedule=wavefront"];
    let options = ["--device", "gpu", "--spp", "2", "--json"];
    let compared = folder.alhazen(&[&contenders[..], &options].concat()).expect(0).json();
    let [first, second] = [0, 1].map(|index| &compared["integrators"][index]);
    assert!(first["notes"]["occupancy"].is_null(), "{compared}");
    assert!(second["notes"]["occupancy"].is_string(), "{compared}");
}
