//! `cargo xtask dist`: the release build, optimised for what a first, instrumented build counted
//! while it rendered some scenes.
//!
//! Code that the scenes never run is optimised for size, so they are rendered with each instruction
//! set that the machine has: build for others where the processor has AVX-512.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::command::{cargo, succeed, target};

/// Scenes with shapes and materials of many kinds, rendered by their own algorithms.
const SCENES: [&str; 12] = [
    "caustic-ball",
    "cornell-box",
    "curves",
    "dispersion",
    "environment",
    "implicit",
    "instances",
    "mesh",
    "mirror-room",
    "prism",
    "textures",
    "translucency",
];

/// Other algorithms and samplers by which one scene is rendered as well.
const ALTERNATIVES: [[&str; 2]; 15] = [
    ["--engine", "scalar"],
    ["--set", "sampler=independent"],
    ["--set", "sampler=halton"],
    ["--set", "sampler=sobol"],
    ["--integrator", "ray-casting"],
    ["--integrator", "whitted"],
    ["--integrator", "ambient-occlusion"],
    ["--integrator", "random-walk"],
    ["--integrator", "simple-path"],
    ["--integrator", "light-tracing"],
    ["--integrator", "bdpt"],
    ["--integrator", "mlt"],
    ["--integrator", "sppm"],
    ["--integrator", "vcm"],
    ["--integrator", "photon-mapping"],
];

/// Builds the program of the workspace at `root` into `target/dist`.
pub fn run(root: &Path) -> Result<(), String> {
    let folder = target(root).join("dist");
    let (counts, profile) = (folder.join("counts"), folder.join("alhazen.profdata"));
    if counts.exists() {
        fs::remove_dir_all(&counts).map_err(|error| error.to_string())?;
    }
    let merge = profile_tool(root)?;
    let instrumented = build(root, &folder, &format!("-Cprofile-generate={}", counts.display()))?;
    for set in instruction_sets() {
        let render = |scene: &str, options: &[&str]| {
            let mut render = Command::new(&instrumented);
            render.env("ALHAZEN_INSTRUCTION_SET", set);
            render.arg("render").arg(root.join(format!("scenes/{scene}.pbrt"))).args(options);
            render.args(["--resolution", "192x144", "--spp", "8", "--threads", "1", "--quiet"]);
            succeed(render.arg("--output").arg(folder.join("picture.exr")))
        };
        SCENES.iter().try_for_each(|scene| render(scene, &[]))?;
        ALTERNATIVES.iter().try_for_each(|options| render("dispersion", options))?;
    }
    succeed(Command::new(merge).args(["merge", "--output"]).arg(&profile).arg(&counts))?;
    let program = build(root, &folder, &format!("-Cprofile-use={}", profile.display()))?;
    let result = folder.join(program.file_name().unwrap_or_default());
    fs::copy(&program, &result).map_err(|error| error.to_string())?;
    println!("{}", result.display());
    Ok(())
}

/// The vectors of this machine's processor, by their names in `ALHAZEN_INSTRUCTION_SET`.
fn instruction_sets() -> Vec<&'static str> {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx512f") {
        return vec!["avx512", "avx2"];
    }
    vec![if cfg!(target_arch = "x86_64") { "avx2" } else { "neon" }]
}

/// Builds the program with another flag of the compiler, which build scripts do not get.
fn build(root: &Path, folder: &Path, flag: &str) -> Result<PathBuf, String> {
    let host = compiler(root, &["--print", "host-tuple"])?;
    let mut command = cargo(root);
    command.args(["build", "--release", "--package", "alhazen-cli", "--target", &host, "--target-dir"]);
    command.arg(folder.join("build"));
    // The flags of all matching tables are joined: those of `.cargo/config.toml` stay.
    command.args(["--config", &format!("target.'cfg(all())'.rustflags = [{flag:?}]")]);
    succeed(&mut command)?;
    let name = format!("alhazen{}", std::env::consts::EXE_SUFFIX);
    Ok(folder.join("build").join(host).join("release").join(name))
}

/// `llvm-profdata` of the compiler's own LLVM, which is installed if it is missing.
fn profile_tool(root: &Path) -> Result<PathBuf, String> {
    let libraries = PathBuf::from(compiler(root, &["--print", "target-libdir"])?);
    let name = format!("llvm-profdata{}", std::env::consts::EXE_SUFFIX);
    let tool = libraries.parent().unwrap_or(&libraries).join("bin").join(name);
    if !tool.exists() {
        succeed(Command::new("rustup").args(["component", "add", "llvm-tools"]).current_dir(root))?;
    }
    Ok(tool)
}

/// The first line that the compiler prints.
fn compiler(root: &Path, arguments: &[&str]) -> Result<String, String> {
    let output = Command::new("rustc").args(arguments).current_dir(root).output();
    let output = output.map_err(|error| format!("rustc did not start: {error}"))?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
