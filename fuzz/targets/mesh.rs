//! Any bytes as each format of meshes.

#![no_main]

use alhazen_assets::{read_obj, read_ply, read_stl};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let _ = (read_ply(bytes).is_ok(), read_obj(bytes).is_ok(), read_stl(bytes).is_ok());
});
