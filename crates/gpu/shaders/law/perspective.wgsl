// Translated from crates/scene/src/camera/perspective.rs
// by `cargo xtask wgsl`, which translates it again.

// The projection through one point.
struct Perspective {
    screen: Screen,
    lens: ThinLens,
}

// Origin and unit direction, in camera space.
fn Perspective_ray(this_: Perspective, film: vec2f, lens: vec2f) -> Tuple_Vec3_Vec3 {
    let parts = Screen_at(this_.screen, film);
    let x = parts.x;
    let y = parts.y;
    return ThinLens_refract(this_.lens, vec3f(0.0f), vec3f(x, y, 1.0f), lens);
}
