// Translated from crates/math/src/spherical.rs
// by `cargo xtask wgsl`, which translates it again.

// The unit vector with the given sine and cosine of θ, and φ in radians.
fn spherical_direction(sin_theta_1: f32, cos_theta: f32, phi: f32) -> vec3f {
    let parts = sin_cos(phi);
    let sin_phi_1 = parts.v0;
    let cos_phi_1 = parts.v1;
    return vec3f(sin_theta_1 * cos_phi_1, sin_theta_1 * sin_phi_1, cos_theta);
}

// θ ∈ [0, π] of a unit vector.
fn spherical_theta(v: vec3f) -> f32 {
    return arc_acos(real_min(real_max(v.z, -1.0f), 1.0f));
}

// φ ∈ [0, 2π) of a vector.
fn spherical_phi(v: vec3f) -> f32 {
    let phi = arc_atan2(v.y, v.x);
    return select(phi, phi + 6.2831855f, phi < 0.0f);
}

// Whether two local directions lie on the same side of the surface.
fn same_hemisphere(a: vec3f, b: vec3f) -> bool {
    return (a.z * b.z) > 0.0f;
}

// `v` or −`v`, whichever lies on the side of `reference`.
fn face_forward(v: vec3f, reference: vec3f) -> vec3f {
    return select(v, -v, Vec3_dot(v, reference) < 0.0f);
}
