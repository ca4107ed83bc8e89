//! Wherever input can exhaust the memory, the error says what it was needed for.

use std::process::Command;

use crate::common::{Finished, Folder};

/// Runs the program in the folder with this many MiB of address space.
fn with_memory(folder: &Folder, mebibytes: u32, arguments: &[&str]) -> Finished {
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v $0 && exec \"$@\"", &(mebibytes << 10).to_string()]);
    command.arg(env!("CARGO_BIN_EXE_alhazen")).args(arguments).current_dir(folder.path());
    command.output().expect("the program runs").into()
}

#[test]
fn a_second_film_may_not_fit() {
    let folder = Folder::with_scene("memory-films");
    // A film of 393 MiB; the second has the same size.
    let layers = "depth,normal,camera-normal,position,camera-position,albedo,uv,motion,variance,alpha";
    let film = ["render", "scene.pbrt", "-o", "a.exr", "--threads", "1", "--resolution", "1000x1000"];
    let more = ["--integrator", "ray-casting", "--spp", "1", "--aov", layers, "--noise", "0.1"];
    let finished = with_memory(&folder, 740, &[&film[..], &more].concat()).expect(1);
    assert!(finished.err.contains("error: no memory for a film of 1000 × 1000 pixels"), "{finished:?}");
    // Main film and splats take 84 MiB, each strategy 34 MiB.
    let techniques = ["--integrator", "bdpt", "--set", "techniques=true", "--json"];
    let finished = with_memory(&folder, 600, &[&film[..], &techniques].concat()).expect(1);
    assert_eq!(finished.json()["status"], "error");
    let message = &finished.json()["errors"][0]["message"];
    assert_eq!(message, "no memory for a film of 1000 × 1000 pixels");
}

#[test]
fn a_tree_may_not_fit() {
    const TRIANGLES: usize = 2_000_000;
    let folder = Folder::with_scene("memory-tree");
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
         property float z\nelement face {TRIANGLES}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let vertices = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes);
    let face = [3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0];
    let mesh = [header.as_bytes(), vertices.as_flattened(), &face.repeat(TRIANGLES)].concat();
    std::fs::write(folder.path().join("mesh.ply"), mesh).expect("a file");
    folder.write("mesh.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"mesh.ply\"\n");
    let finished = with_memory(&folder, 340, &["render", "mesh.pbrt", "--threads", "1"]).expect(1);
    let problem = format!("no memory for the acceleration structure of {TRIANGLES} primitives");
    assert!(finished.err.contains(&problem) && finished.err.contains("mesh.pbrt:2:1"), "{finished:?}");
}

#[test]
fn photons_may_not_fit() {
    let folder = Folder::with_scene("memory-photons");
    for (integrator, photons) in
        [("photon-mapping", "photons=2000000000"), ("sppm", "photonsperiteration=2000000000")]
    {
        let set = ["--integrator", integrator, "--set", photons, "--threads", "1"];
        let render = ["render", "scene.pbrt", "-o", "a.exr"];
        let finished = with_memory(&folder, 4000, &[&render[..], &set].concat()).expect(1);
        assert!(finished.err.contains("error: no memory for "), "{finished:?}");
    }
}
