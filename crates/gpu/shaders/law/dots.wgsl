// Translated from crates/scene/src/texture/dots.rs
// by `cargo xtask wgsl`, which translates it again.

const dots_RADIUS: f32 = 0.35f;

// 1 in a dot and 0 elsewhere.
fn coverage(st: vec2f) -> f32 {
    let cell = vec2f(floor(st.x + 0.5f), floor(st.y + 0.5f));
    var random = vec3f(0.0f, 0.0f, 0.0f);
    {
        random[0] = noise(vec3f(cell.x + 0.5f, cell.y + 0.5f, 0.5f));
    }
    {
        random[1] = noise(vec3f(cell.x + 1.5f, cell.y + 2.8f, 0.5f));
    }
    {
        random[2] = noise(vec3f(cell.x + 4.5f, cell.y + 9.8f, 0.5f));
    }
    let parts = random;
    let choice = parts.x;
    let x = parts.y;
    let y = parts.z;
    let center = cell + (vec2f(x, y) * (0.5f - dots_RADIUS));
    let is_inside = Vec2_length_squared(st - center) < (dots_RADIUS * dots_RADIUS);
    return select(0.0f, 1.0f, (choice > 0.0f) & is_inside);
}
