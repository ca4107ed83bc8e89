// Translated from crates/sampling/src/piecewise_bilinear.rs
// by `cargo xtask wgsl`, which translates it again.

// Up to four layers with their weights, of the sum 1, for each lane.
struct LayerWeights {
    layers: array<u32, 4>,
    weights: vec4f,
    count: u32,
}
