// Translated from crates/integrators/src/transport/direct.rs
// by `cargo xtask wgsl`, which translates it again.

// The power heuristic for a sample of density `p` that another technique finds with density
// `other`.
fn power_heuristic(p: f32, other: f32) -> f32 {
    let ratio = other / p;
    return select(1.0f / (1.0f + (ratio * ratio)), 0.0f, p == 0.0f);
}
