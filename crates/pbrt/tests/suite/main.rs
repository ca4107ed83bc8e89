//! The reader: effects of directives, and messages. The writer: scenes are read back the same.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod directives;
mod messages;
mod plain;
mod programs;
mod scenes;
mod statements;

use alhazen_pbrt::{Exported, export};
use assets::MemoryAssets;
use description::{Imported, SceneDesc};

/// The scene of a text and its assets, which has no errors.
fn read(assets: &MemoryAssets) -> SceneDesc {
    let Imported { desc, diagnostics, .. } = alhazen_pbrt::read("scene.pbrt", assets);
    let errors: Vec<_> = diagnostics.iter().filter(|d| d.is_error()).map(|d| &d.message).collect();
    assert!(errors.is_empty(), "{errors:?}");
    desc
}

/// A scene written, and what is read of that.
fn round_trip(desc: &SceneDesc) -> (Exported, SceneDesc) {
    let mut files = Vec::new();
    let mut sink = |name: &str, bytes: &[u8]| {
        files.push((name.to_owned(), bytes.to_vec()));
        Ok(())
    };
    let exported = export(desc, "files", &mut sink).unwrap();
    let assets = MemoryAssets::default().with("scene.pbrt", exported.text.as_bytes());
    let add =
        |assets: MemoryAssets, (name, bytes): (String, Vec<u8>)| assets.with(format!("files/{name}"), bytes);
    let read = read(&files.into_iter().fold(assets, add));
    (exported, read)
}
