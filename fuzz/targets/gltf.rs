//! Any bytes as a glTF file, text or binary, at a time of its animation.

#![no_main]

use alhazen_assets::MemoryAssets;
use alhazen_import::import;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let name = if bytes.starts_with(b"glTF") { "a.glb" } else { "a.gltf" };
    import(format!("{name}#time=0.5,shutter=0.1"), &MemoryAssets::default().with(name, bytes));
});
