//! Any bytes as a scene of pbrt-v4.

#![no_main]

use alhazen_assets::MemoryAssets;
use alhazen_import::import;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    import("a.pbrt", &MemoryAssets::default().with("a.pbrt", bytes));
});
