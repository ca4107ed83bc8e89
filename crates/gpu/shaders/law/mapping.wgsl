// Translated from crates/scene/src/texture/mapping.rs
// by `cargo xtask wgsl`, which translates it again.

// Texture coordinates in two dimensions, for each lane.
struct TexCoord2d {
    st: vec2f,
    dstdx: vec2f,
    dstdy: vec2f,
}

// Texture coordinates in three dimensions, for each lane.
struct TexCoord3d {
    p: vec3f,
    dpdx: vec3f,
    dpdy: vec3f,
}

// The same point in a texture space that is scaled by `factor`.
fn TexCoord3d_scaled(this_: TexCoord3d, factor: f32) -> TexCoord3d {
    return TexCoord3d(this_.p * factor, this_.dpdx * factor, this_.dpdy * factor);
}
