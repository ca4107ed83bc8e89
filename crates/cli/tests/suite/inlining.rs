//! Inlining in kernels: the operations of vectors are instructions, not calls.
//!
//! An operation of AVX-512 can be inlined only into functions compiled for AVX-512. Where a kernel
//! calls a function that is not inlined into it, the operations in that function are calls, too,
//! and their symbols are in the program. So a symbol of such an operation tells of a slow function,
//! whatever the profile of the build.

#![cfg(all(target_arch = "x86_64", target_os = "linux"))]

use std::process::Command;

/// Modules of the standard library with operations of vectors of 512 bits, as parts of mangled
/// names.
const OPERATIONS: [&str; 3] = ["3x867avx512f", "3x868avx512bw", "3x868avx512dq"];

#[test]
fn kernels_inline_all_operations_of_vectors() {
    let program = env!("CARGO_BIN_EXE_alhazen");
    let Ok(listed) = Command::new("nm").args(["--defined-only", program]).output() else {
        println!("skipped: there is no `nm` to list the symbols of a program");
        return;
    };
    let listed = String::from_utf8(listed.stdout).unwrap();
    let symbols: Vec<&str> = listed.lines().filter_map(|line| line.split(' ').nth(2)).collect();
    let kernels = symbols.iter().filter(|name| name.contains("alhazen_lanes15instruction_set6avx5123run"));
    assert!(kernels.count() > 50, "the program's symbols are not listed");
    let is_operation = |name: &&&str| OPERATIONS.iter().any(|module| name.contains(module));
    let called: Vec<&&str> = symbols.iter().filter(is_operation).collect();
    assert!(called.is_empty(), "not inlined (`objdump -d` shows who calls them): {called:#?}");
}
