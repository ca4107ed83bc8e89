//! Layers, references, variants and packages; files of other authors.

use std::io::{Cursor, Write};

use super::{QUAD, corners, scene, shape, shapes, text, without_errors};
use crate::corpora::{data, files, shown};
use alhazen_import::import;
use assets::{Files, MemoryAssets};
use description::Imported;
use description::{Severity, ShapeKind};
use zip::write::{SimpleFileOptions, ZipWriter};

/// A text whose default prim `a` is a quadrilateral at an x.
fn part(x: i32) -> String {
    text(&format!(
        "def Mesh \"a\" {{ {QUAD} double3 xformOp:translate = ({x}, 0, 0)
            uniform token[] xformOpOrder = [\"xformOp:translate\"] }}"
    ))
    .replace("upAxis", "defaultPrim = \"a\" upAxis")
}

/// The least x of the only shape.
fn x(imported: Imported) -> i64 {
    corners(shape(&without_errors(imported)))[0][0] / 1000
}

#[test]
fn layers_are_composed() {
    let assets = MemoryAssets::default().with("parts/a.usda", part(3)).with("parts/b.usd", part(5));
    let read = |root: &str| import("s/a.usda", &assets.clone().with("s/a.usda", root));
    assert_eq!(x(read(&text("def \"r\" (references = @../parts/a.usda@) {}"))), 2);
    assert_eq!(x(read(&text("def \"r\" (payload = @../parts/b.usd@) {}"))), 4);
    let sublayer = text("").replace("upAxis", "subLayers = [@../parts/a.usda@] upAxis");
    assert_eq!(x(read(&sublayer)), 2);
    let stronger = format!("{sublayer} over \"a\" {{ double3 xformOp:translate = (9, 0, 0) }}");
    assert_eq!(x(read(&stronger)), 8);
}

#[test]
fn variants_are_those_that_are_selected() {
    let of = |selected: &str| {
        let desc = scene(&format!(
            "def Xform \"v\" (variants = {{ string size = \"{selected}\" }} prepend variantSets = \"size\") {{
                variantSet \"size\" = {{
                    \"none\" {{ }}
                    \"one\" {{ def Mesh \"m\" {{ {QUAD} }} }}
                }}
            }}"
        ));
        shapes(&desc).len()
    };
    assert_eq!((of("one"), of("none")), (1, 0));
}

#[test]
fn what_is_missing_is_an_error() {
    let imported = super::read("def \"r\" (references = @none.usda@) {}");
    let errors: Vec<_> = imported.diagnostics.iter().filter(|d| d.severity == Severity::Error).collect();
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert!(
        errors[0].message.contains("none.usda") && errors[0].message.contains("/r"),
        "{}",
        errors[0].message
    );
    let imported = import("none.usda", &MemoryAssets::default());
    assert!(imported.diagnostics[0].message.contains("cannot read `none.usda`"));
}

#[test]
fn texts_that_are_no_usd_have_a_line() {
    let text = super::text("def Xform \"a\" {\n    float b = = 3\n}");
    let assets = MemoryAssets::default().with("a.usda", text.as_str());
    let imported = import("a.usda", &assets);
    assert_eq!(imported.diagnostics.len(), 1, "{}", shown(&imported));
    assert!(imported.diagnostics[0].message.starts_with("a.usda:7:"), "{}", imported.diagnostics[0].message);
    let root = super::text("def \"r\" (references = @a.usda@) {}");
    let imported = import("b.usda", &assets.clone().with("b.usda", root));
    assert!(shown(&imported).contains("a.usda:7:"), "{}", shown(&imported));
    let imported = import("c.usda", &assets.with("c.usda", b"#usda 1.0\n\xff\xfe".to_vec()));
    assert!(shown(&imported).contains("c.usda:2: this is no UTF-8"), "{}", shown(&imported));
}

/// A package of files.
pub(super) fn package(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        let options = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
        zip.start_file(*name, options).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

#[test]
fn packages_hold_layers_and_images() {
    let root = text(
        "def \"r\" (references = @./parts/a.usda@) {
             rel material:binding = </mat>
         }
         def Material \"mat\" {
             token outputs:surface.connect = </mat/s.outputs:surface>
             def Shader \"s\" {
                 uniform token info:id = \"UsdPreviewSurface\"
                 color3f inputs:diffuseColor.connect = </mat/t.outputs:rgb>
             }
             def Shader \"t\" { uniform token info:id = \"UsdUVTexture\" asset inputs:file = @wood.png@ }
         }",
    );
    let picture = image::Image::from_fn(1, 1, ["R", "G", "B"], |_, _| [1.0; 3]);
    let png = image::encode(&picture, image::Format::Png, &image::WriteOptions::default()).unwrap();
    let a = part(3);
    let bytes =
        package(&[("root.usda", root.as_bytes()), ("parts/a.usda", a.as_bytes()), ("wood.png", &png)]);
    let assets = MemoryAssets::default().with("s/a.usdz", bytes);
    let desc = without_errors(import("s/a.usdz", &assets));
    assert_eq!(corners(shape(&desc))[0][0], 2000);
    assert!(desc.images.iter().any(|(_, image)| image.name == "s/a.usdz[wood.png]"));
    // A reference to a package is one to its first layer.
    let outer = text("def \"q\" (references = @a.usdz@</r>) {}");
    let imported = import("s/b.usda", &assets.with("s/b.usda", outer));
    assert_eq!(x(imported), 2);
}

#[test]
fn binary_layers_say_the_same_as_texts() {
    for name in ["models/cube-previewsurface", "models/texture-cat-plane"] {
        let Some(folder) = data("usd") else { return };
        let of = |extension: &str| {
            let imported = import(folder.join(format!("{name}.{extension}")), &Files);
            assert!(!imported.has_errors(), "{}", shown(&imported));
            let shapes = shapes(&imported.desc).into_iter();
            let meshes = shapes.filter(|shape| matches!(shape.kind, ShapeKind::Triangles(_)));
            let counts = meshes.map(|shape| super::mesh(shape).indices.len()).collect::<Vec<_>>();
            assert!(!counts.is_empty());
            counts
        };
        assert_eq!(of("usda"), of("usdc"), "{name}");
    }
}

#[test]
fn scenes_of_other_authors_are_read_without_errors() {
    for folder in ["usd/hdmitsuba", "usd/models"] {
        let Some(folder) = data(folder) else { return };
        for extension in ["usda", "usdc", "usdz"] {
            for path in files(&folder, extension) {
                let imported = import(&path, &Files);
                assert!(!imported.has_errors(), "{}: {}", path.display(), shown(&imported));
                assert!(!imported.desc.shapes.is_empty(), "{}", path.display());
            }
        }
    }
}

#[test]
fn layers_of_other_authors_are_read_or_refused() {
    for folder in ["usd/parse-ok", "usd/parse-ok-usdc", "malformed/usda"] {
        let Some(folder) = data(folder) else { return };
        let paths = [files(&folder, "usda"), files(&folder, "usdc")].concat();
        assert!(!paths.is_empty());
        for path in paths {
            let imported = import(&path, &Files);
            let says = |text: &str| imported.diagnostics.iter().any(|found| found.message.contains(text));
            assert!(!says("is damaged so that it cannot be read"), "{}: a panic", path.display());
        }
    }
}
