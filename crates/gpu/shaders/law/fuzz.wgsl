// Translated from crates/scattering/src/bxdf/openpbr/fuzz.rs
// by `cargo xtask wgsl`, which translates it again.

// σ², of a direction with a cosine.
fn area2(width_1: f32, cosine: f32) -> f32 {
    return 1.0f - (sqr(cosine) * (1.0f - sqr(width_1)));
}

// ς of a roughness in [0, 1].
fn fuzz_width(roughness: f32) -> f32 {
    return real_min(real_max(roughness, 0.1f), 1.0f);
}

// The value of single scattering, for two directions above.
fn single(width_1: f32, wo: vec3f, wi: vec3f) -> f32 {
    let parts = Vec3_normalize_masked(wo + wi);
    let h = parts.v0;
    let is_found = parts.v1;
    let ellipse = (1.0f - sqr(h.z)) + sqr(h.z / width_1);
    let cosine = wo.z;
    let cosine_1 = wi.z;
    let o = sqrt(area2(width_1, cosine));
    let i = sqrt(area2(width_1, cosine_1));
    let depth = (o / wo.z) + (i / wi.z);
    let scattered_1 = 1.0f - exponential_exp(-depth);
    let single_1 = scattered_1 / ((((4.0f * 3.1415927f) * width_1) * sqr(ellipse)) * ((o * wi.z) + (i * wo.z)));
    return select(0.0f, single_1, is_found);
}

// The value for two directions above, of which fibres scatter `more` than once; `mean` is X̄.
fn value(color_1: vec4f, roughness: f32, mean_1: f32, argument_3: array<vec3f, 2>, more: vec2f) -> vec4f {
    let wo = argument_3[0];
    let wi = argument_3[1];
    let again = ((0.5f * more.x) * more.y) / (3.1415927f * mean_1);
    return color_1 * ((color_1 * again) + SampledSpectrum_splat(single(fuzz_width(roughness), wo, wi)));
}
