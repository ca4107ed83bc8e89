//! Paths of pictures and reports, checked before anything is rendered.

use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};

use alhazen::image::{DisplaySettings, Format, link_target};

use crate::args::DisplayOptions;

/// Checks that a picture can be written to `path`: its extension names a format, its folder exists
/// and is writable, and an existing file can be replaced.
pub fn check(path: &Path) -> Result<(), String> {
    let shown = path.display();
    if Format::from_name(&path.to_string_lossy()).is_none() {
        let known = Format::ALL.map(|format| format!(".{}", format.extensions()[0])).join(", ");
        return Err(format!(
            "cannot tell the format of the output {shown} by its extension; there are {known}"
        ));
    }
    check_place(path)
}

/// How these pictures show the light; refused where none of them is in a format for a display.
pub fn display(options: &DisplayOptions, outputs: &[PathBuf]) -> Result<DisplaySettings, String> {
    let settings = options.settings();
    let is_for_display =
        |path: &PathBuf| Format::from_name(&path.to_string_lossy()).is_some_and(Format::is_for_display);
    if settings != DisplaySettings::default() && !outputs.iter().any(is_for_display) {
        let known = Format::ALL.into_iter().filter(|format| format.is_for_display());
        let known = known.map(|format| format!(".{}", format.extensions()[0])).collect::<Vec<_>>().join(", ");
        return Err(format!(
            "--view, --exposure and --white-balance are for {known}; other files stay linear"
        ));
    }
    Ok(settings)
}

/// Checks that a file can be written to `path`, whatever its extension.
pub fn check_place(path: &Path) -> Result<(), String> {
    let shown = path.display();
    // The file is written where a symbolic link leads.
    let path = &link_target(path).map_err(|error| format!("cannot write {shown}: {error}"))?;
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        let problem = if folder.exists() { "is not a folder" } else { "does not exist" };
        return Err(format!("cannot write {shown}: {} {problem}", folder.display()));
    }
    if path.is_dir() {
        return Err(format!("cannot write {shown}: it is a folder"));
    }
    // Whether the folder is writable depends on permissions, read-only and full file systems: only
    // an attempt shows it.
    let probe = folder.join(format!(".alhazen-{}.part", std::process::id()));
    let attempt = OpenOptions::new().write(true).create_new(true).open(&probe);
    attempt.map_err(|error| format!("cannot write to the folder {}: {error}", folder.display()))?;
    fs::remove_file(&probe).map_err(|error| format!("cannot remove {}: {error}", probe.display()))?;
    match OpenOptions::new().append(true).open(path) {
        Err(error) if path.exists() => Err(format!("cannot replace {shown}: {error}")),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_obstacle_is_named() {
        let folder = std::env::temp_dir().join(format!("alhazen-output-{}", std::process::id()));
        fs::create_dir_all(folder.join("folder.exr")).unwrap();
        fs::write(folder.join("file"), "").unwrap();
        let problem = |name: &str| check(&folder.join(name)).unwrap_err();
        assert!(problem("a.xyz").contains("cannot tell the format"));
        assert!(problem("a").contains("there are .exr, .png"));
        assert!(problem("missing/a.exr").ends_with("missing does not exist"));
        assert!(problem("file/a.exr").ends_with("file is not a folder"));
        assert!(problem("folder.exr").ends_with("it is a folder"));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("missing/b.exr", folder.join("link.exr")).unwrap();
            assert!(problem("link.exr").ends_with("missing does not exist"));
            fs::remove_file(folder.join("link.exr")).unwrap();
            for [from, to] in [["a.exr", "b.exr"], ["b.exr", "a.exr"]] {
                std::os::unix::fs::symlink(to, folder.join(from)).unwrap();
            }
            assert!(problem("a.exr").ends_with("too many symbolic links"));
            fs::remove_file(folder.join("a.exr")).unwrap();
            fs::remove_file(folder.join("b.exr")).unwrap();
        }
        check(&folder.join("a.EXR")).unwrap();
        let left: Vec<_> = fs::read_dir(&folder).unwrap().collect();
        assert_eq!(left.len(), 2, "the check leaves nothing behind");
        fs::remove_dir_all(folder).unwrap();
    }
}
