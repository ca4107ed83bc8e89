//! Rules of crates: allowed dependencies, and required lines of manifests.

use super::Finding;
use super::tree::Tree;

/// Every crate and its allowed dependencies, lower layers first: a crate depends only on earlier
/// ones. Tests may use any crate of an earlier line.
const EDGES: [(&str, &[&str]); 26] = [
    ("lanes", &[]),
    ("testkit", &["lanes"]),
    ("math", &["lanes"]),
    ("spectrum", &["lanes", "math"]),
    ("sampling", &["lanes", "math"]),
    ("image", &["lanes", "math", "spectrum"]),
    ("geometry", &["math", "lanes", "sampling"]),
    ("scattering", &["lanes", "math", "spectrum", "sampling"]),
    ("planet", &["lanes", "math", "sampling"]),
    ("description", &["math", "spectrum", "image", "scattering"]),
    ("assets", &["math", "image", "scattering", "description"]),
    ("pbrt", &["math", "spectrum", "image", "scattering", "description", "assets"]),
    ("import", &["math", "spectrum", "image", "description", "assets", "pbrt"]),
    ("scene", &["lanes", "math", "spectrum", "sampling", "image", "geometry", "scattering", "description"]),
    ("film", &["lanes", "math", "spectrum", "sampling", "image", "description"]),
    (
        "integrators",
        &[
            "lanes",
            "math",
            "spectrum",
            "sampling",
            "image",
            "geometry",
            "scattering",
            "description",
            "scene",
            "film",
        ],
    ),
    (
        "gpu",
        &[
            "lanes",
            "math",
            "spectrum",
            "sampling",
            "image",
            "geometry",
            "scattering",
            "description",
            "scene",
            "film",
        ],
    ),
    (
        "alhazen",
        &[
            "math",
            "lanes",
            "spectrum",
            "sampling",
            "image",
            "geometry",
            "scattering",
            "description",
            "assets",
            "pbrt",
            "import",
            "scene",
            "film",
            "integrators",
            "gpu",
        ],
    ),
    ("compare", &["alhazen"]),
    ("view", &["alhazen", "planet"]),
    ("cli", &["alhazen", "compare", "view"]),
    ("python", &["alhazen", "cli"]),
    ("bench", &["lanes", "math", "sampling", "spectrum", "geometry", "scattering", "gpu", "alhazen", "view"]),
    ("translate", &[]),
    ("showcase", &["lanes", "math", "sampling", "planet"]),
    ("xtask", &["image", "spectrum", "showcase", "translate"]),
];

/// Lines that every crate's manifest has: the workspace's lints, licence and edition.
const COMMON: [(&str, &str); 3] = [
    ("lints", "workspace = true"),
    ("package", "license.workspace = true"),
    ("package", "edition.workspace = true"),
];

pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let table = "crates/xtask/src/tidy/crates.rs";
    let architecture = tree.text("docs/ARCHITECTURE.md").unwrap_or_default();
    for name in tree.crates() {
        let path = format!("crates/{name}/Cargo.toml");
        let manifest = tree.text(&path).unwrap_or_default();
        findings.extend(check_manifest(&path, name, manifest));
        if !architecture.contains(&format!("| `{name}` |")) {
            let message = format!("the table of crates has no `{name}`");
            findings.push(Finding::new("docs/ARCHITECTURE.md", 0, message));
        }
    }
    for (name, _) in EDGES.iter().filter(|(name, _)| !tree.exists(&format!("crates/{name}"))) {
        findings.push(Finding::new(
            table,
            0,
            format!("the table of edges has `{name}`, which does not exist"),
        ));
    }
    findings
}

fn check_manifest(path: &str, name: &str, manifest: &str) -> Vec<Finding> {
    let lines = section_lines(manifest);
    let mut findings = Vec::new();
    for (section, text) in COMMON {
        if !lines.iter().any(|&(_, in_section, line)| in_section == section && line == text) {
            findings.push(Finding::new(path, 0, format!("[{section}] lacks `{text}`")));
        }
    }
    let Some(place) = EDGES.iter().position(|(known, _)| *known == name) else {
        findings.push(Finding::new(path, 0, "not in the table of edges of tidy's crates.rs"));
        return findings;
    };
    for (number, section, line) in lines {
        let (kind, inline) = match section.split_once('.') {
            Some((kind, name)) => (kind, Some(name)),
            None => (section, None),
        };
        let used = inline.unwrap_or_else(|| line.split(['.', ' ', '=']).next().unwrap_or_default());
        let Some(used_place) = EDGES.iter().position(|(known, _)| *known == used) else { continue };
        let allowed = match kind {
            "dependencies" | "build-dependencies" => EDGES[place].1.contains(&used),
            "dev-dependencies" => used_place < place,
            _ => true,
        };
        if !allowed {
            let message =
                format!("`{name}` may not use `{used}`: a crate uses lower layers, by the table of edges");
            findings.push(Finding::new(path, number, message));
        }
    }
    findings
}

/// The lines of a manifest with their numbers and sections, without empty ones, comments and heads.
fn section_lines(manifest: &str) -> Vec<(usize, &str, &str)> {
    let mut section = "";
    let mut lines = Vec::new();
    for (number, line) in manifest.lines().enumerate() {
        let line = line.trim();
        if let Some(head) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            section = head;
        } else if !line.is_empty() && !line.starts_with('#') {
            lines.push((number + 1, section, line));
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str =
        "[package]\nedition.workspace = true\nlicense.workspace = true\n[lints]\nworkspace = true\n";

    fn found(name: &str, rest: &str) -> Vec<String> {
        let findings = check_manifest("Cargo.toml", name, &format!("{HEAD}{rest}"));
        findings.iter().map(Finding::to_string).collect()
    }

    #[test]
    fn edges_point_down() {
        for (place, (name, uses)) in EDGES.iter().enumerate() {
            for used in *uses {
                let lower = EDGES[..place].iter().any(|(known, _)| known == used);
                assert!(lower, "{name} uses {used}, which is not in a lower layer");
            }
        }
    }

    #[test]
    fn edges_that_are_not_allowed_are_found() {
        assert!(found("film", "[dependencies]\nmath.workspace = true\nexr = \"1\"\n").is_empty());
        assert_eq!(
            found("geometry", "[dependencies]\nscattering.workspace = true\n"),
            [
                "Cargo.toml:7: `geometry` may not use `scattering`: a crate uses lower layers, by the table of edges"
            ]
        );
        assert_eq!(found("math", "[dependencies.scene]\nworkspace = true\n").len(), 1);
        assert_eq!(found("import", "[dev-dependencies]\nscene = { workspace = true }\n").len(), 1);
        assert!(found("film", "[dev-dependencies]\ntestkit.workspace = true\n").is_empty());
    }

    #[test]
    fn what_manifests_lack_is_found() {
        let findings = check_manifest("Cargo.toml", "math", "[package]\nedition.workspace = true\n");
        assert_eq!(findings.len(), 2);
        assert_eq!(found("nobody", "").len(), 1);
    }
}
