// Translated from crates/scene/src/light_sampler/cluster.rs
// by `cargo xtask wgsl`, which translates it again.

// [`LightBounds`] with what does not depend on the point computed once.
struct Cluster {
    centroid: vec3f,
    radius2: f32,
    w: vec3f,
    phi: f32,
    cos_theta_o: f32,
    sin_theta_o: f32,
    cos_theta_e: f32,
    two_sided: bool,
}

// cos(max(0, a − b)) of angles in [0, π] given by their sines and cosines.
fn cos_sub_clamped(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> f32 {
    return select((cos_a * cos_b) + (sin_a * sin_b), 1.0f, cos_a > cos_b);
}

// sin(max(0, a − b)).
fn sin_sub_clamped(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> f32 {
    return select((sin_a * cos_b) - (cos_a * sin_b), 0.0f, cos_a > cos_b);
}

// An estimate ≥ 0 of the unoccluded contribution to `p`. A nonzero `n` is the surface normal
// there, and includes the cosine of incidence.
fn Cluster_importance(this_: Cluster, p: vec3f, n: vec3f) -> f32 {
    let to = p - this_.centroid;
    let distance2 = Vec3_length_squared(to);
    let parts = Vec3_normalize_masked(to);
    let wi = parts.v0;
    let is_apart = parts.v1;
    let wi_1 = select(vec3f(0.0f, 0.0f, 1.0f), wi, is_apart);
    let cos_w = Vec3_dot(this_.w, wi_1);
    let cos_w_1 = select(cos_w, abs(cos_w), this_.two_sided);
    let sin_w = safe_sqrt(1.0f - (cos_w_1 * cos_w_1));
    let sin2_b = this_.radius2 / distance2;
    let is_outside = sin2_b < 1.0f;
    let sin_b = select(0.0f, sqrt(sin2_b), is_outside);
    let cos_b = select(-1.0f, sqrt(1.0f - sin2_b), is_outside);
    let cos_x = cos_sub_clamped(sin_w, cos_w_1, this_.sin_theta_o, this_.cos_theta_o);
    let sin_x = sin_sub_clamped(sin_w, cos_w_1, this_.sin_theta_o, this_.cos_theta_o);
    let cos_p = cos_sub_clamped(sin_x, cos_x, sin_b, cos_b);
    let is_dark = cos_p <= this_.cos_theta_e;
    if (is_dark) {
        return 0.0f;
    }
    var importance = (this_.phi * cos_p) / real_max(distance2, this_.radius2);
    let has_normal = ((n.x != 0.0f) | (n.y != 0.0f)) | (n.z != 0.0f);
    if (has_normal) {
        let cos_i = abs(Vec3_dot(wi_1, n));
        let sin_i = safe_sqrt(1.0f - (cos_i * cos_i));
        let cosine = cos_sub_clamped(sin_i, cos_i, sin_b, cos_b);
        importance = select(importance, importance * cosine, has_normal);
    }
    let importance_1 = real_min(real_max(importance, 0.0f), 3.4028234e38f / 4.0f);
    return select(importance_1, 0.0f, is_dark);
}
