// Translated from crates/integrators/src/transport/direct.rs
// by `cargo xtask wgsl`, which translates it again.

// A direction from which the sky lights a surface, distributed by the cosine over the sides that
// scatter to `wo`, and its density.
fn sample_ambient(wo: vec3f, ns: vec3f, flags: u32, u: vec2f) -> Tuple_Vec3_f32 {
    let reflects = BxdfFlags_is_reflective(flags);
    let transmits = BxdfFlags_is_transmissive(flags);
    let has_both = reflects & transmits;
    let is_second = u.x >= 0.5f;
    let of_half = select(u.x + u.x, (u.x + u.x) - 1.0f, is_second);
    let u_1 = vec2f(select(u.x, of_half, has_both), u.y);
    let is_across = transmits & (!reflects | is_second);
    let is_below = Vec3_dot(wo, ns) < 0.0f;
    let axis = select(ns, -ns, is_across != is_below);
    let w = sample_cosine_hemisphere(u_1);
    let pdf = cosine_hemisphere_pdf(w.z);
    return Tuple_Vec3_f32(Frame_from_local(Frame_from_z(axis), w), select(pdf, pdf * 0.5f, has_both));
}

// The power heuristic for a sample of density `p` that another technique finds with density
// `other`.
fn power_heuristic(p: f32, other: f32) -> f32 {
    let ratio = other / p;
    return select(1.0f / (1.0f + (ratio * ratio)), 0.0f, p == 0.0f);
}
