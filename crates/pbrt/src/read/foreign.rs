//! Scene formats that are not read, recognised so that a message can name them.

use description::{Diagnostic, Span};

/// What is said of a file where a scene of pbrt-v4 is read; `None` if it may be one.
pub(crate) fn refused(name: &str, bytes: &[u8], span: Span) -> Option<Diagnostic> {
    let what = recognise(name, bytes)?;
    let (message, help) = match what {
        USD if cfg!(not(feature = "usd")) => (
            format!("`{name}` is {what}, which this program was built without"),
            "packages of alhazen read USD; a build from source does with `--features usd`",
        ),
        USD => (
            format!("`{name}` is {what}, not one of pbrt-v4"),
            "names of USD scenes end in .usd, .usda, .usdc or .usdz; no other scene can include them",
        ),
        _ => (format!("`{name}` is {what}, not one of pbrt-v4"), SCENES),
    };
    Some(Diagnostic::error("foreign-format", message, span).with_help(help))
}

const USD: &str = "a USD scene";
const SCENES: &str = match cfg!(feature = "usd") {
    true => "scenes are pbrt-v4, glTF, USD, PLY, OBJ or STL files",
    false => "scenes are pbrt-v4, glTF, PLY, OBJ or STL files",
};

/// The kind of a file, with its article, if it is of a known format other than those that are read.
/// `name` is its path.
fn recognise(name: &str, bytes: &[u8]) -> Option<&'static str> {
    by_content(bytes).or_else(|| by_name(name))
}

fn by_content(bytes: &[u8]) -> Option<&'static str> {
    /// Bytes that files begin with.
    const SIGNATURES: [(&[u8], &str); 11] = [
        (b"glTF", "a glTF scene"),
        (b"PXR-USDC", USD),
        (b"#usda", USD),
        (b"BLENDER", "a Blender scene"),
        (b"Kaydara FBX", "an FBX scene"),
        (b"Ogawa", "an Alembic scene"),
        (b"#VRML", "a VRML scene"),
        (b"##RenderMan", "a RenderMan scene"),
        (b"//Maya", "a Maya scene"),
        (b"solid ", "an STL mesh"),
        (b"PK\x03\x04", "a ZIP archive"),
    ];
    /// Tags of XML formats.
    const TAGS: [(&[u8], &str); 3] =
        [(b"<scene", "a Mitsuba scene"), (b"<COLLADA", "a COLLADA scene"), (b"<X3D", "an X3D scene")];
    /// How far into a text its format is looked for.
    const HEAD: usize = 1 << 16;

    let signature = SIGNATURES.iter().find(|(start, _)| bytes.starts_with(start));
    if let Some(&(start, what)) = signature {
        // USD scenes are also packed into ZIP archives, which begin with a file of theirs.
        let head = &bytes[..bytes.len().min(HEAD)];
        let is_usd = start == b"PK\x03\x04" && contains(head, b".usd");
        return Some(if is_usd { USD } else { what });
    }
    if image::Format::from_content(bytes).is_some() {
        return Some("a picture");
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let head = &text[..text.len().min(HEAD)];
    match head.first() {
        Some(b'<') => {
            Some(TAGS.iter().find(|(tag, _)| contains(head, tag)).map_or("an XML file", |&(_, what)| what))
        }
        Some(b'{') if contains(head, b"\"asset\"") => Some("a glTF scene"),
        Some(b'{') => Some("a JSON file"),
        _ => None,
    }
}

fn by_name(name: &str) -> Option<&'static str> {
    let name = name.to_ascii_lowercase();
    let (_, extension) = name.rsplit_once('.')?;
    Some(match extension {
        "gltf" | "glb" => "a glTF scene",
        "usd" | "usda" | "usdc" | "usdz" => USD,
        "blend" => "a Blender scene",
        "fbx" => "an FBX scene",
        "abc" => "an Alembic scene",
        "stl" => "an STL mesh",
        "dae" => "a COLLADA scene",
        "3ds" | "max" => "a 3ds Max scene",
        "ma" | "mb" => "a Maya scene",
        "c4d" => "a Cinema 4D scene",
        "rib" => "a RenderMan scene",
        "ass" => "an Arnold scene",
        _ => return None,
    })
}

fn contains(text: &[u8], part: &[u8]) -> bool {
    text.windows(part.len()).any(|window| window == part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_recognised_by_content_or_name() {
        for (name, bytes, what) in [
            ("a", &b"glTF\x02\0\0\0"[..], Some("a glTF scene")),
            ("a.json", b" {\n\"asset\": {\"version\": \"2.0\"}}", Some("a glTF scene")),
            ("a.gltf", b"", Some("a glTF scene")),
            ("a.pbrt", b"PXR-USDC\0", Some("a USD scene")),
            ("a.usd", b"#usda 1.0\n", Some("a USD scene")),
            ("a.usdz", b"PK\x03\x04\0\0room.usdc", Some("a USD scene")),
            ("a.zip", b"PK\x03\x04\0\0room.pbrt", Some("a ZIP archive")),
            (
                "a.xml",
                b"\xef\xbb\xbf<?xml version='1.0'?>\n<scene version=\"3.0.0\">",
                Some("a Mitsuba scene"),
            ),
            ("a.xml", b"<html>", Some("an XML file")),
            ("a.BLEND", b"\x28\xb5\x2f\xfd", Some("a Blender scene")),
            ("a.fbx", b"; FBX 7.3.0 project file", Some("an FBX scene")),
            ("a.png", b"\x89PNG\r\n", Some("a picture")),
            ("a.pbrt", b"# <scene\nWorldBegin", None),
            ("a", b"", None),
        ] {
            assert_eq!(recognise(name, bytes), what, "{name}");
        }
    }
}
