//! The commands of figures, and what they draw.

use std::fs;
use std::path::Path;
use std::process::Command;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use showcase::Size;

use crate::command::{QUICK_KERNELS, target};
use crate::scenes::folder;

use super::figure::{Drawn, escaped};

/// Runs commands, and notes with all but the last how far their pictures are from its.
pub fn compare(root: &Path, program: &Path, lines: &[&str]) -> Result<Vec<Drawn>, String> {
    let folder = target(root).join("gallery");
    let file = |i: usize| folder.join(format!("compared-{i}.exr"));
    let run =
        |(i, line): (usize, &&str)| run_and_keep(root, program, line, Size::Whole, "picture", Some(&file(i)));
    let mut drawn = lines.iter().enumerate().map(run).collect::<Result<Vec<Drawn>, String>>()?;
    if let Some((_, others)) = drawn.split_last_mut() {
        let reference = file(others.len());
        for (i, drawn) in others.iter_mut().enumerate() {
            let mut command = Command::new(program);
            command.args(["image", "diff", "--json"]).args([&reference, &file(i)]);
            let json = json(&output(&mut command)?)?;
            let [flip, relmse] = ["flip", "relmse"].map(|key| json[key].as_f64().unwrap_or(f64::NAN));
            drawn.notes +=
                &format!("<p>Error against the last picture: FLIP {flip:.3}, relMSE {relmse:.4}</p>");
        }
    }
    Ok(drawn)
}

/// Runs a command, as a reader would in the root of the repository. What it draws is written to a
/// file of this name, which no other command at the same time may have.
pub fn run(root: &Path, program: &Path, line: &str, size: Size, name: &str) -> Result<Drawn, String> {
    run_and_keep(root, program, line, size, name, None)
}

/// The same; a picture is also written to another file.
fn run_and_keep(
    root: &Path,
    program: &Path,
    line: &str,
    size: Size,
    file_name: &str,
    also: Option<&Path>,
) -> Result<Drawn, String> {
    let failed = |problem: String| format!("`{line}`: {problem}");
    let line_of_size = line.replace(folder(Size::Whole), folder(size));
    let words: Vec<&str> = line_of_size.split_whitespace().collect();
    let ["alhazen", name @ ("render" | "trace-pixel" | "view"), rest @ ..] = &words[..] else {
        return Err(failed("it is none of `alhazen render`, `trace-pixel` and `view`".into()));
    };
    let folder = target(root).join("gallery");
    fs::create_dir_all(&folder).map_err(|error| failed(error.to_string()))?;
    let extension = if *name == "trace-pixel" { "svg" } else { "jpg" };
    let file = folder.join(file_name).with_extension(extension);
    let mut command = Command::new(program);
    command.current_dir(root).arg(name).arg("-o").arg(&file);
    if let Some(file) = also {
        command.arg("-o").arg(file);
    }
    match (*name, size) {
        ("render" | "view", Size::Small) => {
            command.args(without_size(rest)).args(["--resolution", "36x24", "--spp", "1", "--json"]);
            command.envs([QUICK_KERNELS]);
        }
        ("render" | "view", Size::Whole) => {
            command.args(rest).arg("--json");
        }
        _ => {
            command.args(rest);
        }
    }
    let text = match output(&mut command) {
        Err(problem) if size == Size::Small && *name == "view" && problem.contains("no GPU: ") => {
            println!("SKIPPED, not drawn: `{line}`: there is no GPU");
            return Ok(Drawn::default());
        }
        output => output.map_err(failed)?,
    };
    let bytes = fs::read(&file).map_err(|error| failed(error.to_string()))?;
    let kind = if *name == "trace-pixel" { "svg+xml" } else { "jpeg" };
    let picture = format!("image/{kind};base64,{}", STANDARD.encode(bytes));
    let notes = if *name == "trace-pixel" {
        format!("<summary>Every event in words</summary><pre>{}</pre>", escaped(&text))
    } else {
        let json = json(&text).map_err(failed)?;
        let cost = if *name == "view" { cost_of_view(&json) } else { cost(&json) };
        format!("<summary>Cost</summary><p>{cost}</p>")
    };
    Ok(Drawn { picture, notes })
}

/// The standard output of a command, or its errors if it fails.
fn output(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        Ok(text)
    } else {
        Err(format!("{text}{}", String::from_utf8_lossy(&output.stderr)))
    }
}

fn json(text: &str) -> Result<Value, String> {
    serde_json::from_str(text).map_err(|error| error.to_string())
}

/// The words of a command without those that say how large and how good a picture is.
fn without_size<'a>(words: &[&'a str]) -> Vec<&'a str> {
    let mut words = words.iter();
    let mut kept = Vec::new();
    while let Some(&word) = words.next() {
        match word {
            "--spp" | "--resolution" => drop(words.next()),
            _ => kept.push(word),
        }
    }
    kept
}

/// The cost of a render in words; not in seconds, so that pages are the same on every machine.
fn cost(json: &Value) -> String {
    let number = |key: &str| json[key].as_f64().unwrap_or(0.0);
    let rays = number("rays");
    let tests = (number("extent_tests") / rays, number("primitive_tests") / rays);
    let rays =
        if rays < 1e6 { format!("{:.0} thousand", rays / 1e3) } else { format!("{:.1} million", rays / 1e6) };
    // The picture is that of the crop window.
    let bound = |i: usize| json["pixel_bounds"][i].as_i64().unwrap_or(0);
    let [width, height] = [bound(1) - bound(0), bound(3) - bound(2)];
    format!(
        "{width} × {height} pixels, {} spp, {rays} rays; mean per ray: {:.1} bounding box tests, {:.1} primitive tests",
        json["samples_per_pixel"], tests.0, tests.1
    )
}

/// The cost of a view in words.
fn cost_of_view(json: &Value) -> String {
    let [width, height] = [0, 1].map(|i| json["resolution"][i].as_u64().unwrap_or(0));
    if json["rasterized"].is_null() {
        return format!("{width} × {height} pixels, the last of {} frames", json["frames"]);
    }
    let count = |key: &str| json["rasterized"][key].as_f64().unwrap_or(0.0);
    format!(
        "{width} × {height} pixels; rasterised, {:.1} million triangles and {} sprites",
        count("triangles") / 1e6,
        count("sprites")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_can_be_made_small() {
        let words = ["a.pbrt", "--spp", "64", "--integrator", "path", "--resolution", "9x9"];
        assert_eq!(without_size(&words), ["a.pbrt", "--integrator", "path"]);
    }
}
