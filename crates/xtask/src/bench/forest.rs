//! How memory and time grow with the triangles of a forest of instances.
//!
//! An instance takes the memory of a transform and a node, whatever the number of its triangles,
//! and a ray finds its way through twice as many by one more step of the tree. So memory grows by
//! a constant for each tree, and the tests of a ray as the logarithm of their number.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use showcase::Size;

use crate::command::{cargo, succeed, target};
use crate::scenes;

/// The forests, from the smallest.
const FORESTS: [&str; 4] = ["forest-6", "forest-7", "forest-8", "forest"];

/// What a forest costs.
struct Cost {
    /// Triangles with all instances counted.
    triangles: f64,
    trees: usize,
    megabytes: f64,
    /// For each ray.
    nanoseconds: f64,
    tests: f64,
}

/// Measures the forests of `cargo xtask scenes forest`, prints a table, and draws it as
/// `target/forest.svg`.
pub fn measure(root: &Path) -> Result<(), String> {
    succeed(cargo(root).args(["build", "--release", "--quiet", "--package", "alhazen-cli"]))?;
    scenes::run(root, &["forest"], Size::Whole)?;
    let costs = FORESTS.iter().map(|name| cost(root, name)).collect::<Result<Vec<_>, _>>()?;
    println!("| triangles | trees | memory | ns a ray | tests of extents and primitives a ray |");
    println!("|---|---|---|---|---|");
    for Cost { triangles, trees, megabytes, nanoseconds, tests } in &costs {
        println!("| {triangles:.2e} | {trees} | {megabytes:.0} MB | {nanoseconds:.0} | {tests:.1} |");
    }
    let file = target(root).join("forest.svg");
    fs::write(&file, plot(&costs)).map_err(|error| format!("{}: {error}", file.display()))
}

fn cost(root: &Path, name: &str) -> Result<Cost, String> {
    let folder = root.join("target/scenes/forest");
    let read =
        |file: String| fs::read_to_string(folder.join(&file)).map_err(|error| format!("{file}: {error}"));
    let trees = read(format!("{name}-trees.pbrt"))?.lines().count();
    let text = read(format!("{name}.pbrt"))?;
    let said = text.strip_prefix("# A forest of ").and_then(|text| text.split(' ').next());
    let triangles = said.and_then(|number| number.parse().ok());
    let program = target(root).join("release/alhazen");
    let mut command = Command::new(program);
    command.current_dir(&folder).args(["render", &format!("{name}.pbrt"), "--json", "--quiet"]);
    command.args(["--resolution", "240x135", "--spp", "8", "-o"]).arg(target(root).join("forest.exr"));
    let failed = |problem: String| format!("{name}: {problem}");
    let output = command.output().map_err(|error| failed(error.to_string()))?;
    if !output.status.success() {
        return Err(failed(String::from_utf8_lossy(&output.stderr).into_owned()));
    }
    let json: Value = serde_json::from_slice(&output.stdout).map_err(|error| failed(error.to_string()))?;
    let number = |value: &Value| value.as_f64().ok_or_else(|| format!("{name}: no number in {json}"));
    let rays = number(&json["rays"])?;
    Ok(Cost {
        triangles: triangles.ok_or_else(|| format!("{name}: the scene says no number of triangles"))?,
        trees,
        megabytes: number(&json["peak_memory_bytes"])? / 1e6,
        nanoseconds: 1e9 * number(&json["seconds"]["render"])? * number(&json["threads"])? / rays,
        tests: (number(&json["extent_tests"])? + number(&json["primitive_tests"])?) / rays,
    })
}

/// The costs relative to the first, over the number of triangles, both axes logarithmic.
fn plot(costs: &[Cost]) -> String {
    const WIDTH: f64 = 560.0;
    const HEIGHT: f64 = 300.0;
    let (first, last) = (&costs[0], &costs[costs.len() - 1]);
    let decades = (last.triangles / first.triangles).log10();
    let x = |triangles: f64| 60.0 + (WIDTH - 160.0) * (triangles / first.triangles).log10() / decades;
    let y = |ratio: f64| HEIGHT - 40.0 - (HEIGHT - 60.0) * ratio.log10() / decades;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" font-size=\"12\">\n"
    );
    for decade in 0..=decades as i32 {
        let ratio = 10f64.powi(decade);
        let (at, up) = (x(first.triangles * ratio), y(ratio));
        let _ = writeln!(
            svg,
            "<path d=\"M60 {up:.1}H{:.1}M{at:.1} 20V{:.1}\" stroke=\"#ddd\"/>\n<text x=\"52\" y=\"{:.1}\" text-anchor=\"end\">× {ratio}</text>\n<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{:.1e}</text>",
            WIDTH - 100.0,
            HEIGHT - 40.0,
            up + 4.0,
            HEIGHT - 20.0,
            first.triangles * ratio,
        );
    }
    type Value = fn(&Cost) -> f64;
    let curves: [(&str, &str, Value); 4] = [
        ("triangles", "#aaa", |cost| cost.triangles),
        ("time a ray", "#c33", |cost| cost.nanoseconds),
        ("tests a ray", "#36c", |cost| cost.tests),
        ("memory", "#293", |cost| cost.megabytes),
    ];
    for (i, (name, color, value)) in curves.into_iter().enumerate() {
        let points = costs.iter().map(|cost| (x(cost.triangles), y(value(cost) / value(first))));
        let points: Vec<String> = points.map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"/>\n<text x=\"{}\" y=\"{}\" fill=\"{color}\">{name}</text>",
            points.join(" "),
            WIDTH - 92.0,
            30.0 + 18.0 * i as f64,
        );
    }
    svg + "</svg>\n"
}
