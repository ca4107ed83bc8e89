// Translated from crates/scene/src/camera/minimum_differentials.rs
// by `cargo xtask wgsl`, which translates it again.

// The smallest differences between rays of neighbouring pixels, in the frame of the ray.
struct MinimumDifferentials {
    origin: array<vec3f, 2>,
    direction: array<vec3f, 2>,
}

// ∂p/∂x and ∂p/∂y in camera space, on the plane with normal `n` that the ray along the unit
// direction `d` hits at `distance`; zero where that plane is seen edge-on.
fn MinimumDifferentials_dp_dxy(this_: MinimumDifferentials, d: vec3f, distance_1: f32, n: vec3f) -> array<vec3f, 2> {
    let frame = Frame_from_z(d);
    let n_1 = Frame_to_local(frame, n);
    let p = vec3f(0.0f, 0.0f, distance_1);
    return array<vec3f, 2>(MinimumDifferentials_dp(this_, 0, frame, p, n_1), MinimumDifferentials_dp(this_, 1, frame, p, n_1));
}

// ∂p along an axis of the film.
fn MinimumDifferentials_dp(this_: MinimumDifferentials, axis: u32, frame: Frame, p: vec3f, n: vec3f) -> vec3f {
    let o = this_.origin[axis];
    let d = Vec3_Z + this_.direction[axis];
    let t = Vec3_dot(n, p - o) / Vec3_dot(n, d);
    let dp = (o + (d * t)) - p;
    return select(vec3f(0.0f), Frame_from_local(frame, dp), Vec3_are_finite(dp));
}
