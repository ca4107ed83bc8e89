// Translated from crates/scattering/src/phase.rs
// by `cargo xtask wgsl`, which translates it again.

// The phase function of Henyey and Greenstein.
struct HenyeyGreenstein {
    g: f32,
}

// The value, which is the density of [`Self::sample_p`], too.
fn HenyeyGreenstein_p(this_: HenyeyGreenstein, wo: vec3f, wi: vec3f) -> f32 {
    return HenyeyGreenstein_p_of_cos(this_, Vec3_dot(wo, wi));
}

fn HenyeyGreenstein_p_of_cos(this_: HenyeyGreenstein, cos_theta: f32) -> f32 {
    let square = real_max((1.0f + sqr(this_.g)) + ((2.0f * this_.g) * cos_theta), 1e-12f);
    return ((0.25f * 0.31830987f) * (1.0f - sqr(this_.g))) / (square * sqrt(square));
}

// A direction `wi` and its density.
fn HenyeyGreenstein_sample_p(this_: HenyeyGreenstein, wo: vec3f, u: vec2f) -> Tuple_Vec3_f32 {
    let g = this_.g;
    let ratio = (1.0f - sqr(g)) / ((1.0f + g) - ((2.0f * g) * u.x));
    let peaked = ((sqr(ratio) - 1.0f) - sqr(g)) / (2.0f * g);
    let cos_theta = select(peaked, 1.0f - (2.0f * u.x), abs(g) < 1e-3f);
    let cos_theta_1 = real_min(real_max(cos_theta, -1.0f), 1.0f);
    let sin_theta_1 = safe_sqrt(1.0f - sqr(cos_theta_1));
    let wi = spherical_direction(sin_theta_1, cos_theta_1, u.y * 6.2831855f);
    return Tuple_Vec3_f32(Frame_from_local(Frame_from_z(wo), wi), HenyeyGreenstein_p_of_cos(this_, cos_theta_1));
}
