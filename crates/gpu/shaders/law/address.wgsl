// Translated from crates/sampling/src/sampler/address.rs
// by `cargo xtask wgsl`, which translates it again.

// Which coordinate of which sample, in each lane.
struct Address {
    pixel: array<u32, 2>,
    index: u32,
    dimension: u32,
}

// Continues after `dimensions` more.
fn Address_skip(this_: ptr<function, Address>, dimensions: u32) {
    (*this_).dimension = (*this_).dimension + u32(dimensions);
}
