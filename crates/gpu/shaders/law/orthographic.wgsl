// Translated from crates/scene/src/camera/orthographic.rs
// by `cargo xtask wgsl`, which translates it again.

// Parallel rays.
struct Orthographic {
    screen: Screen,
    lens: ThinLens,
}

// Origin and unit direction, in camera space.
fn Orthographic_ray(this_: Orthographic, film: vec2f, lens: vec2f) -> Tuple_Vec3_Vec3 {
    let parts = Screen_at(this_.screen, film);
    let x = parts.x;
    let y = parts.y;
    return ThinLens_refract(this_.lens, vec3f(x, y, 0.0f), Vec3_Z, lens);
}
