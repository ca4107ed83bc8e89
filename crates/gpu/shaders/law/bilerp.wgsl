// Translated from crates/scene/src/texture/bilerp.rs
// by `cargo xtask wgsl`, which translates it again.

// The weights of the values at (0, 0), (0, 1), (1, 0), (1, 1) at the point `st`; they sum to one.
fn weights(st: vec2f) -> vec4f {
    let s = st.x;
    let t = st.y;
    return vec4f((1.0f - s) * (1.0f - t), (1.0f - s) * t, s * (1.0f - t), s * t);
}
