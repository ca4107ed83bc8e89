// Translated from crates/scattering/src/bxdf/openpbr/oren_nayar.rs
// by `cargo xtask wgsl`, which translates it again.

// A in dependence of the roughness.
fn amplitude(roughness: f32) -> f32 {
    return 1.0f / (1.0f + ((0.5f - (2.0f / (3.0f * 3.1415927f))) * roughness));
}

// E: the albedo of white facets by single scattering.
fn single_albedo(roughness: f32, cosine: f32) -> f32 {
    let cosine_1 = real_min(real_max(cosine, 0.0f), 1.0f);
    let sine = sqrt(1.0f - sqr(cosine_1));
    let theta = arc_atan2(sine, cosine_1);
    let steep = ((sine * cosine_1) * ((1.0f + sine) + sqr(sine))) / (1.0f + sine);
    let g = (sine * (theta - (sine * cosine_1))) + ((2.0f / 3.0f) * (steep - sine));
    return amplitude(roughness) * (1.0f + ((roughness * 0.31830987f) * g));
}

// The value for two directions above, of an `albedo` and a `roughness` in [0, 1].
fn oren_nayar(albedo_1: vec4f, roughness: f32, wo: vec3f, wi: vec3f) -> vec4f {
    let smooth_1 = albedo_1 * 0.31830987f;
    let is_rough = roughness > 0.0f;
    if (!is_rough) {
        return smooth_1;
    }
    let s = Vec3_dot(wo, wi) - (wo.z * wi.z);
    let t = select(1.0f, real_max(wo.z, wi.z), s > 0.0f);
    let single_1 = albedo_1 * (amplitude(roughness) * (1.0f + ((roughness * s) / t)));
    let mean_1 = amplitude(roughness) * (1.0f + (((2.0f / 3.0f) - (28.0f / (15.0f * 3.1415927f))) * roughness));
    let lost = (1.0f - single_albedo(roughness, wo.z)) * (1.0f - single_albedo(roughness, wi.z));
    var again = albedo_1;
    {
        again[0] = (sqr(again[0]) * mean_1) / (1.0f - (again[0] * (1.0f - mean_1)));
    }
    {
        again[1] = (sqr(again[1]) * mean_1) / (1.0f - (again[1] * (1.0f - mean_1)));
    }
    {
        again[2] = (sqr(again[2]) * mean_1) / (1.0f - (again[2] * (1.0f - mean_1)));
    }
    {
        again[3] = (sqr(again[3]) * mean_1) / (1.0f - (again[3] * (1.0f - mean_1)));
    }
    let rough = (single_1 + (again * (lost / (1.0f - mean_1)))) * 0.31830987f;
    return SampledSpectrum_select(is_rough, rough, smooth_1);
}
