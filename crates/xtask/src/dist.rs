//! `cargo xtask dist`: archives of the program for people without Rust.
//!
//! An archive has the program, its man pages, completions for shells, the README and the licences.
//! On Linux there is a Debian package, too.
//!
//! The program has the window of `alhazen view`. Libraries of a graphics driver can be loaded by a
//! dynamically linked program only, so on Linux it needs a glibc as new as that of the machine that
//! built it. With `--static` it has neither window nor GPU, and runs on any distribution. With
//! `--profile` it is optimized by a profile (`profile.rs`), which takes three times as long to
//! build.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::command::{cargo, succeed, target};
use super::profile;

/// The profile of what people get.
pub const PROFILE: &str = "dist";
const VERSION: &str = env!("CARGO_PKG_VERSION");
const SHELLS: [&str; 5] = ["bash", "zsh", "fish", "elvish", "powershell"];
/// Files of the repository that go along.
const DOCUMENTS: [&str; 3] = ["README.md", "LICENSE-APACHE", "LICENSE-MIT"];

/// Builds for this machine, or for another target, into `target/packages`.
pub fn run(root: &Path, arguments: &[&str]) -> Result<(), String> {
    let host = host(root)?;
    let (options, targets): (Vec<&str>, Vec<&str>) =
        arguments.iter().partition(|argument| argument.starts_with("--"));
    let is_static = options.contains(&"--static");
    let has_profile = options.contains(&"--profile");
    let triple = match targets[..] {
        [] => host.as_str(),
        [triple] => triple,
        _ => return Err("expected one target, such as aarch64-unknown-linux-gnu".into()),
    };
    if let Some(unknown) = options.iter().find(|option| !["--static", "--profile"].contains(option)) {
        return Err(format!("expected --static or --profile, not {unknown}"));
    }
    if has_profile && triple != host {
        return Err(format!("a profile of {triple} needs a machine of its own"));
    }
    let flags = match has_profile {
        true => profile::flags(root, &host, |flags| build(root, &host, is_static, flags))?,
        false => String::new(),
    };
    let program = build(root, triple, is_static, &flags)?;
    // Pages and completions are the same everywhere, and only a program of this machine runs.
    let own = if triple == host { program.clone() } else { build(root, &host, is_static, "")? };
    let packages = target(root).join("packages");
    let name = format!("alhazen-{VERSION}-{triple}{}", if is_static { "-static" } else { "" });
    let folder = packages.join(&name);
    io(&folder, || assemble(root, &folder, &program))?;
    describe(&own, &folder)?;

    // Windows' own tar knows no xz, and picks the kind of archive by its name.
    let (kind, options) = if triple.contains("windows") { ("zip", "-acf") } else { ("tar.xz", "-cJf") };
    let archive = format!("{name}.{kind}");
    succeed(Command::new("tar").current_dir(&packages).args([options, &archive, &name]))?;
    println!("{}", packages.join(archive).display());
    if triple.contains("linux") && !is_static {
        debian(&folder, triple, &packages)?;
    }
    Ok(())
}

/// The target that this machine's compiler builds for.
pub fn host(root: &Path) -> Result<String, String> {
    let output = cargo(root).args(["-vV"]).output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| "cargo does not say what it builds for".into())
}

/// Builds the program for a target, with more flags for the compiler, and returns its path.
fn build(root: &Path, triple: &str, is_static: bool, flags: &str) -> Result<PathBuf, String> {
    let mut command = cargo(root);
    let features = if is_static { "portable" } else { "full" };
    command.args(["build", "--profile", PROFILE, "--package", "alhazen-cli"]);
    command.args(["--features", features, "--target", triple]);
    let mut all = flags.to_owned();
    if is_static && triple.contains("linux-gnu") {
        all += " -C target-feature=+crt-static";
    }
    if !all.is_empty() {
        // This replaces the flags of `.cargo/config.toml`.
        if triple.starts_with("x86_64") {
            all += " -C target-cpu=x86-64-v3";
        }
        let variable = format!("CARGO_TARGET_{}_RUSTFLAGS", triple.to_uppercase().replace('-', "_"));
        command.env(variable, all);
    }
    succeed(&mut command)?;
    let suffix = if triple.contains("windows") { ".exe" } else { "" };
    Ok(target(root).join(triple).join(PROFILE).join(format!("alhazen{suffix}")))
}

/// Puts the program and documents into an empty folder.
fn assemble(root: &Path, folder: &Path, program: &Path) -> std::io::Result<()> {
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    fs::create_dir_all(folder.join("completions"))?;
    fs::copy(program, folder.join(program.file_name().unwrap_or_default()))?;
    for document in DOCUMENTS {
        fs::copy(root.join(document), folder.join(document))?;
    }
    Ok(())
}

/// Writes man pages and completions.
fn describe(program: &Path, folder: &Path) -> Result<(), String> {
    succeed(Command::new(program).arg("man").arg(folder.join("man")))?;
    for shell in SHELLS {
        let output = Command::new(program).args(["completions", shell]).output();
        let script = output.map_err(|error| error.to_string())?.stdout;
        let path = folder.join("completions").join(format!("alhazen.{shell}"));
        io(&path, || fs::write(&path, script))?;
    }
    Ok(())
}

/// Makes a Debian package of an archive's folder, where `dpkg-deb` is installed.
fn debian(folder: &Path, triple: &str, packages: &Path) -> Result<(), String> {
    let architecture = match triple.split('-').next() {
        Some("x86_64") => "amd64",
        Some("aarch64") => "arm64",
        _ => return Ok(()),
    };
    if Command::new("dpkg-deb").arg("--version").output().is_err() {
        eprintln!("warning: no Debian package, as there is no dpkg-deb");
        return Ok(());
    }
    let package = packages.join(format!("alhazen_{VERSION}_{architecture}"));
    io(&package, || lay_out(folder, &package, architecture))?;
    let mut command = Command::new("dpkg-deb");
    succeed(command.args(["--root-owner-group", "--build"]).arg(&package).arg(packages))?;
    Ok(())
}

/// Lays the files of an archive out as the Debian package installs them.
fn lay_out(folder: &Path, package: &Path, architecture: &str) -> std::io::Result<()> {
    if package.exists() {
        fs::remove_dir_all(package)?;
    }
    let place = |from: &str, to: &str| {
        let to = package.join(to);
        fs::create_dir_all(to.parent().unwrap_or(package))?;
        fs::copy(folder.join(from), to).map(|_| ())
    };
    place("alhazen", "usr/bin/alhazen")?;
    for document in DOCUMENTS {
        place(document, &format!("usr/share/doc/alhazen/{document}"))?;
    }
    place("completions/alhazen.bash", "usr/share/bash-completion/completions/alhazen")?;
    place("completions/alhazen.zsh", "usr/share/zsh/vendor-completions/_alhazen")?;
    place("completions/alhazen.fish", "usr/share/fish/vendor_completions.d/alhazen.fish")?;
    for page in fs::read_dir(folder.join("man"))? {
        let page = page?.file_name().to_string_lossy().into_owned();
        place(&format!("man/{page}"), &format!("usr/share/man/man1/{page}"))?;
    }
    let program = fs::read(folder.join("alhazen"))?;
    let size = program.len() / 1024;
    let glibc = newest_glibc(&program).map_or(String::new(), |minor| format!(" (>= 2.{minor})"));
    fs::create_dir_all(package.join("DEBIAN"))?;
    let control = format!(
        "Package: alhazen\nVersion: {VERSION}\nArchitecture: {architecture}\nSection: graphics\n\
         Priority: optional\nInstalled-Size: {size}\nDepends: libc6{glibc}, libgcc-s1\n\
         Recommends: libvulkan1, mesa-vulkan-drivers, libxkbcommon-x11-0, libxcursor1, libxi6\n\
         Maintainer: The authors of alhazen <alhazen@localhost>\n\
         Description: physically based renderer\n Renders pbrt-v4 scenes and meshes by every \
         algorithm of light transport.\n"
    );
    fs::write(package.join("DEBIAN/control"), control)
}

/// The minor version of the newest glibc, 2.x, whose functions a program calls.
fn newest_glibc(program: &[u8]) -> Option<u32> {
    const NAME: &[u8] = b"GLIBC_2.";
    let names = program.windows(NAME.len()).enumerate().filter(|(_, window)| *window == NAME);
    let minors = names.filter_map(|(start, _)| {
        let rest = &program[start + NAME.len()..];
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        std::str::from_utf8(&rest[..digits]).ok()?.parse().ok()
    });
    minors.max()
}

/// Runs a task on files; the error names the path.
fn io(path: &Path, task: impl FnOnce() -> std::io::Result<()>) -> Result<(), String> {
    task().map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::newest_glibc;

    #[test]
    fn a_package_asks_for_the_glibc_of_its_program() {
        let symbols = b"\0GLIBC_2.2.5\0GLIBC_2.34\0GLIBC_2.9\0GLIBC_PRIVATE\0GLIBC_2.";
        assert_eq!(newest_glibc(symbols), Some(34));
        assert_eq!(newest_glibc(b"GLIBC_PRIVATE"), None);
    }
}
