// Translated from crates/lanes/src/function/power.rs
// by `cargo xtask wgsl`, which translates it again.

// 1/√x of a positive normal number with a relative error below 5·10⁻⁶, in a fraction of the time
// of root and quotient; any finite numbers elsewhere.
fn coarse_inverse_sqrt(x: f32) -> f32 {
    let half = 0.5f * x;
    var root = bitcast<f32>(0x5f375a86u - (bitcast<u32>(x) >> 1));
    for (var i = 0u; i < 2; i++) {
        root = root * (1.5f - ((half * root) * root));
    }
    return root;
}
