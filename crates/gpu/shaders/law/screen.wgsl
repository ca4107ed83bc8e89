// Translated from crates/scene/src/camera/screen.rs
// by `cargo xtask wgsl`, which translates it again.

// The mapping from film positions to positions on the screen.
struct Screen {
    top_left: vec2f,
    per_pixel: vec2f,
}

// The point of the screen at a film position in pixels.
fn Screen_at(this_: Screen, film: vec2f) -> vec2f {
    return this_.top_left + (film * this_.per_pixel);
}

// A lens without thickness.
struct ThinLens {
    radius: f32,
    focal_distance: f32,
}

// Refracts the pinhole ray (`o`, `d`) at the point of the lens that `u` in [0, 1)² selects.
fn ThinLens_refract(this_: ThinLens, o: vec3f, d: vec3f, u: vec2f) -> Tuple_Vec3_Vec3 {
    if (this_.radius <= 0.0f) {
        return Tuple_Vec3_Vec3(o, Vec3_normalize(d));
    }
    let focus = o + (d * (this_.focal_distance / d.z));
    let on_lens = ThinLens_at(this_, u);
    return Tuple_Vec3_Vec3(on_lens, Vec3_normalize(focus - on_lens));
}

// The point of the lens that `u` in [0, 1)² selects.
fn ThinLens_at(this_: ThinLens, u: vec2f) -> vec3f {
    let p = sample_uniform_disk_concentric(u) * real_max(this_.radius, 0.0f);
    return vec3f(p.x, p.y, 0.0f);
}
