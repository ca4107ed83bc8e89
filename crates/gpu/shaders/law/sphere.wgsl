// Translated from crates/sampling/src/warp/sphere.rs
// by `cargo xtask wgsl`, which translates it again.

// A direction of the sphere.
fn sample_uniform_sphere(u: vec2f) -> vec3f {
    let z = 1.0f - (2.0f * u.x);
    return spherical_direction(2.0f * safe_sqrt(u.x * (1.0f - u.x)), z, u.y * 6.2831855f);
}

// A direction of the hemisphere z ≥ 0.
fn sample_uniform_hemisphere(u: vec2f) -> vec3f {
    return spherical_direction(safe_sqrt(1.0f - (u.x * u.x)), u.x, u.y * 6.2831855f);
}

// Density of [`sample_uniform_hemisphere`] where z ≥ 0.
fn uniform_hemisphere_pdf() -> f32 {
    return 0.5f * 0.31830987f;
}

// A direction of the hemisphere z ≥ 0 with density proportional to z.
fn sample_cosine_hemisphere(u: vec2f) -> vec3f {
    let d = sample_uniform_disk_concentric(u);
    return vec3f(d.x, d.y, safe_sqrt(1.0f - Vec2_length_squared(d)));
}

// Density of [`sample_cosine_hemisphere`] at a direction with this z; 0 below the horizon.
fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    return real_max(cos_theta, 0.0f) * 0.31830987f;
}

// A direction whose angle with +z has at least the cosine `cos_theta_max`.
fn sample_uniform_cone(u: vec2f, cos_theta_max: f32) -> vec3f {
    let lost = u.x * (1.0f - cos_theta_max);
    return spherical_direction(safe_sqrt(lost * (2.0f - lost)), 1.0f - lost, u.y * 6.2831855f);
}

// Density of [`sample_uniform_cone`] inside the cone.
fn uniform_cone_pdf(cos_theta_max: f32) -> f32 {
    return 1.0f / ((2.0f * 3.1415927f) * (1.0f - cos_theta_max));
}
