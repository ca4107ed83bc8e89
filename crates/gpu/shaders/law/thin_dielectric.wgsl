// Translated from crates/scattering/src/bxdf/thin_dielectric.rs
// by `cargo xtask wgsl`, which translates it again.

// Two parallel smooth interfaces as one.
struct ThinDielectric {
    eta: f32,
}

fn ThinDielectric_flags(this_: ThinDielectric) -> u32 {
    return BxdfFlags_splat(BxdfFlags_SPECULAR_REFLECTION | BxdfFlags_SPECULAR_TRANSMISSION);
}

fn ThinDielectric_f(this_: ThinDielectric, unused_1: vec3f, unused_2: vec3f, unused_3: u32) -> vec4f {
    return SampledSpectrum_zero();
}

fn ThinDielectric_sample_f(this_: ThinDielectric, wo: vec3f, uc: f32, unused_3: vec2f, unused_4: u32, directions: u32) -> BsdfSample {
    let fresnel = fr_dielectric(abs(wo.z), this_.eta);
    let r = (fresnel * 2.0f) / (1.0f + fresnel);
    let parts = Directions_probability_of_reflection(directions, r, 1.0f - r);
    let pr = parts.v0;
    let valid = parts.v1;
    let reflects = uc < pr;
    let wi = select(-wo, vec3f(-wo.x, -wo.y, wo.z), reflects);
    let share_1 = select(1.0f - r, r, reflects);
    let probability = select(1.0f - pr, pr, reflects);
    let lobe = BxdfFlags_choose(reflects, BxdfFlags_SPECULAR_REFLECTION, BxdfFlags_SPECULAR_TRANSMISSION);
    let f = SampledSpectrum_splat(share_1 / abs(wi.z));
    let valid_1 = valid & (wo.z != 0.0f);
    let rest = BsdfSample_new(f, wi, probability, lobe);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, rest.pdf_is_proportional, valid_1);
}

fn ThinDielectric_pdf(this_: ThinDielectric, unused_1: vec3f, unused_2: vec3f, unused_3: u32, unused_4: u32) -> f32 {
    return 0.0f;
}
