// Translated from crates/scattering/src/bxdf/diffuse.rs
// by `cargo xtask wgsl`, which translates it again.

// Lambertian reflection.
struct Diffuse {
    reflectance: vec4f,
}

const diffuse_LOBE: u32 = BxdfFlags_DIFFUSE_REFLECTION;

fn Diffuse_flags(this_: Diffuse) -> u32 {
    return BxdfFlags_only_where(!SampledSpectrum_is_black(this_.reflectance), diffuse_LOBE);
}

fn Diffuse_f(this_: Diffuse, wo: vec3f, wi: vec3f, unused_3: u32) -> vec4f {
    let f = this_.reflectance * 0.31830987f;
    return SampledSpectrum_select(same_hemisphere(wo, wi), f, SampledSpectrum_zero());
}

fn Diffuse_sample_f(this_: Diffuse, wo: vec3f, unused_2: f32, u: vec2f, unused_4: u32, directions: u32) -> BsdfSample {
    if (!Directions_reflection(directions)) {
        return BsdfSample_invalid();
    }
    var wi = sample_cosine_hemisphere(u);
    let pdf = cosine_hemisphere_pdf(wi.z);
    wi.z = copysign(wi.z, wo.z);
    let f = this_.reflectance * 0.31830987f;
    return BsdfSample_new(f, wi, pdf, BxdfFlags_splat(diffuse_LOBE));
}

fn Diffuse_pdf(this_: Diffuse, wo: vec3f, wi: vec3f, unused_3: u32, directions: u32) -> f32 {
    if (!Directions_reflection(directions)) {
        return 0.0f;
    }
    return select(0.0f, cosine_hemisphere_pdf(abs(wi.z)), same_hemisphere(wo, wi));
}
