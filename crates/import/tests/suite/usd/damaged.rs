//! Damaged files are refused or read in part, without a panic of ours, in bounded time and memory.

use std::time::{Duration, Instant};

use super::{QUAD, read, text};
use alhazen_import::import;
use assets::MemoryAssets;
use openusd::usd;

/// The longest that a file of this size may take.
const LONGEST: Duration = Duration::from_secs(20);

/// A text with most kinds of values.
fn sample() -> String {
    text(&format!(
        "def Xform \"g\" (prepend apiSchemas = [\"MaterialBindingAPI\"]) {{
            double3 xformOp:translate.timeSamples = {{ 0: (0, 0, 0), 10: (10, 0, 0) }}
            uniform token[] xformOpOrder = [\"xformOp:translate\"]
            rel material:binding = </mat>
            def Mesh \"m\" {{ {QUAD} color3f[] primvars:displayColor = [(1, 0, 0)] }}
        }}
        def Material \"mat\" {{
            token outputs:surface.connect = </mat/s.outputs:surface>
            def Shader \"s\" {{
                uniform token info:id = \"UsdPreviewSurface\"
                color3f inputs:diffuseColor = (0.1, 0.2, 0.3)
                asset inputs:file = @a.png@
            }}
        }}
        def BasisCurves \"c\" {{
            int[] curveVertexCounts = [4]
            point3f[] points = [(0, 0, 0), (1, 0, 0), (2, 1, 0), (3, 1, 0)]
            float[] widths = [0.5] (interpolation = \"constant\")
        }}
        def SphereLight \"l\" {{ float inputs:intensity = 3 }}"
    ))
}

/// A binary layer of what a text says.
fn binary(text: &str) -> Vec<u8> {
    let folder = std::env::temp_dir().join(format!("alhazen-usd-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let [source, packed] = ["a.usda", "a.usdc"].map(|name| folder.join(name));
    std::fs::write(&source, text).unwrap();
    let stage = usd::Stage::open(source.to_str().unwrap()).unwrap();
    stage.root_layer().export(packed.to_str().unwrap()).unwrap();
    let bytes = std::fs::read(&packed).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    bytes
}

/// Reads bytes; whether the reader met a panic.
fn panics(name: &str, bytes: Vec<u8>) -> bool {
    let start = Instant::now();
    let imported = import(name, &MemoryAssets::default().with(name, bytes));
    assert!(start.elapsed() < LONGEST, "{:?}", start.elapsed());
    imported.diagnostics.iter().any(|found| found.message.contains("is damaged so that it cannot be read"))
}

/// The same bytes with changes that a simple generator of random numbers chooses.
fn damaged(bytes: &[u8], count: usize) -> impl Iterator<Item = Vec<u8>> {
    let mut state = 1_u64;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below.max(1)
    };
    (0..count).map(move |_| {
        let mut bytes = bytes.to_vec();
        for _ in 0..=random(3) {
            let at = random(bytes.len());
            bytes[at] = match random(3) {
                0 => 0xff,
                1 => bytes[at] ^ (1 << random(8)),
                _ => random(256) as u8,
            };
        }
        bytes
    })
}

#[test]
fn damaged_texts_are_refused() {
    let text = sample();
    assert!(!read("def Xform \"g\" {}").has_errors());
    for end in (0..text.len()).step_by(7).filter(|&end| text.is_char_boundary(end)) {
        assert!(!panics("a.usda", text.as_bytes()[..end].to_vec()), "{end}");
    }
    for bytes in damaged(text.as_bytes(), 300) {
        assert!(!panics("a.usda", bytes.clone()), "{:?}", String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn damaged_binary_layers_are_refused() {
    let bytes = binary(&sample());
    assert!(!panics("a.usdc", bytes.clone()));
    let imported = import("a.usdc", &MemoryAssets::default().with("a.usdc", bytes.clone()));
    assert_eq!(super::shapes(&imported.desc).len(), 3, "{:?}", imported.diagnostics);
    for end in (0..bytes.len()).step_by(61) {
        panics("a.usdc", bytes[..end].to_vec());
    }
    for bytes in damaged(&bytes, 600) {
        panics("a.usdc", bytes);
    }
}

#[test]
fn damaged_packages_are_refused() {
    let package = super::files::package(&[("root.usda", sample().as_bytes())]);
    assert!(!panics("a.usdz", package.clone()));
    for end in (0..package.len()).step_by(97) {
        assert!(!panics("a.usdz", package[..end].to_vec()), "{end}");
    }
    for bytes in damaged(&package, 200) {
        assert!(!panics("a.usdz", bytes));
    }
    let holder = super::files::package(&[("inner.usdz", &package)]);
    assert!(import("a.usdz", &MemoryAssets::default().with("a.usdz", holder)).has_errors());
}

#[test]
fn deep_texts_do_not_overflow_the_stack() {
    let deep = |count: usize| format!("{}{}", "def Xform \"a\" {\n".repeat(count), "}".repeat(count));
    assert!(!read(&deep(200)).has_errors());
    let imported = read(&deep(100_000));
    assert!(imported.diagnostics[0].message.contains("brackets are nested more than 512 deep"));
}

/// The composition of such paths would not end.
#[test]
fn stray_braces_are_refused() {
    for prims in [
        "def Xform \"a}b\" {}",
        "def \"a\" (references = </x}b>) {}",
        "def \"a\" (inherits = </x}b>) {}",
        "def \"a\" { rel material:binding = </x\n{ a = b }\n} c.d> }",
    ] {
        let imported = read(prims);
        let message = &imported.diagnostics[0].message;
        assert!(message.contains("a brace too many"), "{prims}: {message}");
    }
}

#[test]
fn circles_end() {
    for prims in [
        "def \"a\" (references = </b>) {} def \"b\" (references = </a>) {}",
        "def \"a\" (references = @a.usda@</a>) {}",
        "def \"a\" { def \"b\" (references = </a>) {} }",
    ] {
        let start = Instant::now();
        let imported = read(prims);
        assert!(start.elapsed() < LONGEST, "{prims}");
        assert!(imported.has_errors(), "{prims}: {:?}", imported.diagnostics);
    }
    let text = text("").replace("upAxis", "subLayers = [@a.usda@] upAxis");
    import("a.usda", &MemoryAssets::default().with("a.usda", text));
}

#[test]
fn damaged_files_of_other_authors_are_refused() {
    let Some(folder) = crate::corpora::data("usd/parse-ok-usdc") else { return };
    for path in crate::corpora::files(&folder, "usdc") {
        let bytes = std::fs::read(&path).unwrap();
        for damaged in damaged(&bytes, 12) {
            panics("a.usdc", damaged);
        }
    }
}
