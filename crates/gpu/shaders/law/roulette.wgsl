// Translated from crates/integrators/src/transport/roulette.rs
// by `cargo xtask wgsl`, which translates it again.

const roulette_CERTAIN: f32 = 0.999f;

// Whether a path plays that has been scattered so many times and survives with a probability.
fn plays_roulette(depth: u32, probability: f32) -> bool {
    return !(depth < 2u) & (probability < roulette_CERTAIN);
}

// The survival probability of a camera path with the throughput `carried`; may be above one.
fn camera_path_survival(carried: vec4f) -> f32 {
    return SampledSpectrum_max_component(carried) * 3.0f;
}
