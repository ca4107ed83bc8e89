// Translated from crates/scene/src/texture/marble.rs
// by `cargo xtask wgsl`, which translates it again.

// Veins of marble.
struct Marble {
    fractal: Fractal,
    scale: f32,
    variation: f32,
}

// The place on the ramp, from 0 to 1, at a point of texture space.
fn Marble_place(this_: Marble, at: TexCoord3d) -> f32 {
    let at_1 = TexCoord3d_scaled(at, this_.scale);
    let displacement = fbm(at_1, this_.fractal.octaves, this_.fractal.roughness);
    return 0.5f + (0.5f * circular_sin(at_1.p.y + (this_.variation * displacement)));
}
