// Translated from crates/sampling/src/warp/disk.rs
// by `cargo xtask wgsl`, which translates it again.

// A point of the unit disk: radius √u₀ at the angle 2π·u₁.
fn sample_uniform_disk_polar(u: vec2f) -> vec2f {
    let parts = sin_cos(u.y * 6.2831855f);
    let sin_1 = parts.v0;
    let cos_1 = parts.v1;
    return vec2f(cos_1, sin_1) * sqrt(u.x);
}

// A point of the unit disk: squares around the centre of the unit square are mapped to circles.
fn sample_uniform_disk_concentric(u: vec2f) -> vec2f {
    let p = (u * 2.0f) - 1.0f;
    let along_x = abs(p.x) > abs(p.y);
    let r = select(p.y, p.x, along_x);
    let slope = select(select(p.x, p.y, along_x) / r, 0.0f, r == 0.0f);
    let turn_1 = slope * 0.7853982f;
    let parts = sin_cos(select(1.5707964f - turn_1, turn_1, along_x));
    let sin_1 = parts.v0;
    let cos_1 = parts.v1;
    return vec2f(cos_1, sin_1) * r;
}
