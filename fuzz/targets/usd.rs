//! Any bytes as a USD file: a text, a binary layer, or a package.

#![no_main]

use alhazen_assets::MemoryAssets;
use alhazen_import::import;
use libfuzzer_sys::fuzz_target;

fuzz_target!(
    // A panic of the crate that parses USD is a fault of the file: its thread alone ends. Those of
    // this thread still end the fuzzer, which catches them.
    init: std::panic::set_hook(Box::new(|_| ())),
    |bytes: &[u8]| {
        let name = match bytes {
            [b'P', b'K', ..] => "a.usdz",
            [b'P', ..] => "a.usdc",
            _ => "a.usda",
        };
        import(name, &MemoryAssets::default().with(name, bytes));
    }
);
