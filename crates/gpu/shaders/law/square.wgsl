// Translated from crates/sampling/src/warp/square.rs
// by `cargo xtask wgsl`, which translates it again.

// A point of [0, 1]² with density proportional to the bilinear interpolation of weights ≥ 0 at
// (0,0), (1,0), (0,1), (1,1).
fn sample_bilinear(u: vec2f, w: vec4f) -> vec2f {
    let y = sample_linear(u.y, w.x + w.y, w.z + w.w);
    return vec2f(sample_linear(u.x, lerp(y, w.x, w.z), lerp(y, w.y, w.w)), y);
}

// Density of [`sample_bilinear`].
fn bilinear_pdf(p: vec2f, w: vec4f) -> f32 {
    let inside = (((p.x >= 0.0f) & (p.x <= 1.0f)) & (p.y >= 0.0f)) & (p.y <= 1.0f);
    let sum = ((w.x + w.y) + w.z) + w.w;
    let pdf = (4.0f * lerp(p.x, lerp(p.y, w.x, w.z), lerp(p.y, w.y, w.w))) / sum;
    return select(0.0f, select(pdf, 1.0f, sum <= 0.0f), inside);
}
