// Translated from crates/scattering/src/bxdf/diffuse_transmission.rs
// by `cargo xtask wgsl`, which translates it again.

// Lambertian reflection and transmission. Energy is conserved if the sum of both is at most 1.
struct DiffuseTransmission {
    reflectance: vec4f,
    transmittance: vec4f,
}

fn DiffuseTransmission_probability_of_reflection(this_: DiffuseTransmission, directions: u32) -> Tuple_f32_bool {
    let r = SampledSpectrum_max_component(this_.reflectance);
    let t = SampledSpectrum_max_component(this_.transmittance);
    return Directions_probability_of_reflection(directions, r, t);
}

fn DiffuseTransmission_flags(this_: DiffuseTransmission) -> u32 {
    return BxdfFlags_only_where(!SampledSpectrum_is_black(this_.reflectance), BxdfFlags_DIFFUSE_REFLECTION) | BxdfFlags_only_where(!SampledSpectrum_is_black(this_.transmittance), BxdfFlags_DIFFUSE_TRANSMISSION);
}

fn DiffuseTransmission_f(this_: DiffuseTransmission, wo: vec3f, wi: vec3f, unused_3: u32) -> vec4f {
    let reflects = same_hemisphere(wo, wi);
    return SampledSpectrum_select(reflects, this_.reflectance, this_.transmittance) * 0.31830987f;
}

fn DiffuseTransmission_sample_f(this_: DiffuseTransmission, wo: vec3f, uc: f32, u: vec2f, unused_4: u32, directions: u32) -> BsdfSample {
    let parts = DiffuseTransmission_probability_of_reflection(this_, directions);
    let pr = parts.v0;
    let valid = parts.v1;
    if (!valid) {
        return BsdfSample_invalid();
    }
    var wi = sample_cosine_hemisphere(u);
    let pdf = cosine_hemisphere_pdf(wi.z);
    let reflects = uc < pr;
    wi.z = copysign(wi.z, select(-wo.z, wo.z, reflects));
    let share_1 = SampledSpectrum_select(reflects, this_.reflectance, this_.transmittance);
    let probability = select(1.0f - pr, pr, reflects);
    let lobe = BxdfFlags_choose(reflects, BxdfFlags_DIFFUSE_REFLECTION, BxdfFlags_DIFFUSE_TRANSMISSION);
    let f = share_1 * 0.31830987f;
    let rest = BsdfSample_new(f, wi, pdf * probability, lobe);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, rest.pdf_is_proportional, valid);
}

fn DiffuseTransmission_pdf(this_: DiffuseTransmission, wo: vec3f, wi: vec3f, unused_3: u32, directions: u32) -> f32 {
    let parts = DiffuseTransmission_probability_of_reflection(this_, directions);
    let pr = parts.v0;
    let valid = parts.v1;
    let probability = select(1.0f - pr, pr, same_hemisphere(wo, wi));
    return select(0.0f, probability * cosine_hemisphere_pdf(abs(wi.z)), valid);
}
