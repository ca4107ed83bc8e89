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
    return array<vec3f, 2>(MinimumDifferentials_dp(this_, 0, frame, distance_1, n_1), MinimumDifferentials_dp(this_, 1, frame, distance_1, n_1));
}

// ∂p along an axis of the film: the neighbouring ray meets the plane farther by `along`. Both
// rays are hardly apart, so that their points are not subtracted from each other.
fn MinimumDifferentials_dp(this_: MinimumDifferentials, axis: u32, frame: Frame, distance_1: f32, n: vec3f) -> vec3f {
    let o = this_.origin[axis];
    let d = this_.direction[axis];
    let along = (-(Vec3_dot(n, o) + (distance_1 * Vec3_dot(n, d)))) / (n.z + Vec3_dot(n, d));
    var dp = o + (d * (distance_1 + along));
    dp.z += along;
    return select(vec3f(0.0f), Frame_from_local(frame, dp), Vec3_are_finite(dp));
}
