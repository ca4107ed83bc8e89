//! `--device`: what renders, and what GPUs and their drivers say.

use crate::common::{Finished, Folder};
use crate::render::LAYERED;

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
