// Translated from crates/scattering/src/bxdf/layered/closed.rs
// by `cargo xtask wgsl`, which translates it again.

// The albedo of the base, and where there is a closed form.
fn Layered_Conductor_closed_form(this_: Layered_Conductor) -> Tuple_SampledSpectrum_bool {
    let parts = Conductor_even_albedo(this_.base);
    let albedo_1 = parts.v0;
    let is_even = parts.v1;
    let is_clear = BxdfFlags_is_specular(Dielectric_flags(this_.interface_)) & !Layered_Conductor_has_medium(this_);
    return Tuple_SampledSpectrum_bool(albedo_1, (is_even & is_clear) & (this_.inner >= 0.0f));
}

// The albedo of the base, and where there is a closed form.
fn Layered_Diffuse_closed_form(this_: Layered_Diffuse) -> Tuple_SampledSpectrum_bool {
    let parts = Diffuse_even_albedo(this_.base);
    let albedo_1 = parts.v0;
    let is_even = parts.v1;
    let is_clear = BxdfFlags_is_specular(Dielectric_flags(this_.interface_)) & !Layered_Diffuse_has_medium(this_);
    return Tuple_SampledSpectrum_bool(albedo_1, (is_even & is_clear) & (this_.inner >= 0.0f));
}

// The share of light that goes through the coat along `w`, which is above it.
fn Layered_Conductor_through(this_: Layered_Conductor, w: vec3f) -> f32 {
    let eta = this_.interface_.eta;
    let cosine = safe_sqrt(1.0f - ((1.0f - sqr(w.z)) / sqr(eta)));
    let absorbed = exponential_exp(-(this_.thickness / cosine));
    let entering = (1.0f - fr_dielectric(w.z, eta)) * absorbed;
    return select(0.0f, entering, cosine > 0.0f);
}

// The share of light that goes through the coat along `w`, which is above it.
fn Layered_Diffuse_through(this_: Layered_Diffuse, w: vec3f) -> f32 {
    let eta = this_.interface_.eta;
    let cosine = safe_sqrt(1.0f - ((1.0f - sqr(w.z)) / sqr(eta)));
    let absorbed = exponential_exp(-(this_.thickness / cosine));
    let entering = (1.0f - fr_dielectric(w.z, eta)) * absorbed;
    return select(0.0f, entering, cosine > 0.0f);
}

// f, for two directions above.
fn Layered_Conductor_f_closed(this_: Layered_Conductor, albedo_1: vec4f, wo: vec3f, wi: vec3f) -> vec4f {
    let rounds = i32(min(this_.max_depth / 2 + u32(this_.max_depth % 2 != 0), u32(2147483647i)));
    var f = albedo_1;
    for (var i = 0u; i < sampled_N; i++) {
        let round_1 = albedo_1[i] * this_.inner;
        f[i] = (albedo_1[i] * (1.0f - powi(round_1, rounds))) / (1.0f - round_1);
    }
    return f * ((Layered_Conductor_through(this_, wo) * Layered_Conductor_through(this_, wi)) / (3.1415927f * sqr(this_.interface_.eta)));
}

// f, for two directions above.
fn Layered_Diffuse_f_closed(this_: Layered_Diffuse, albedo_1: vec4f, wo: vec3f, wi: vec3f) -> vec4f {
    let rounds = i32(min(this_.max_depth / 2 + u32(this_.max_depth % 2 != 0), u32(2147483647i)));
    var f = albedo_1;
    for (var i = 0u; i < sampled_N; i++) {
        let round_1 = albedo_1[i] * this_.inner;
        f[i] = (albedo_1[i] * (1.0f - powi(round_1, rounds))) / (1.0f - round_1);
    }
    return f * ((Layered_Diffuse_through(this_, wo) * Layered_Diffuse_through(this_, wi)) / (3.1415927f * sqr(this_.interface_.eta)));
}

// The density of a direction above, for `wo` above.
fn Layered_Conductor_pdf_closed(this_: Layered_Conductor, wo: vec3f, wi: vec3f) -> f32 {
    return (1.0f - fr_dielectric(wo.z, this_.interface_.eta)) * cosine_hemisphere_pdf(wi.z);
}

// The density of a direction above, for `wo` above.
fn Layered_Diffuse_pdf_closed(this_: Layered_Diffuse, wo: vec3f, wi: vec3f) -> f32 {
    return (1.0f - fr_dielectric(wo.z, this_.interface_.eta)) * cosine_hemisphere_pdf(wi.z);
}

// A sample for `wo` above.
fn Layered_Conductor_sample_closed(this_: Layered_Conductor, albedo_1: vec4f, wo: vec3f, uc: f32, u: vec2f, mode: u32) -> BsdfSample {
    let entrance = Dielectric_sample_f(this_.interface_, wo, uc, u, mode, Directions_All);
    let wi = sample_cosine_hemisphere(u);
    let f = Layered_Conductor_f_closed(this_, albedo_1, wo, wi);
    let pdf = Layered_Conductor_pdf_closed(this_, wo, wi);
    let below = BsdfSample_new(f, wi, pdf, BxdfFlags_splat(BxdfFlags_DIFFUSE_REFLECTION));
    let sample = BsdfSample_select(BxdfFlags_is_reflective(entrance.flags), entrance, below);
    return BsdfSample(sample.f, sample.wi, sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, entrance.valid);
}

// A sample for `wo` above.
fn Layered_Diffuse_sample_closed(this_: Layered_Diffuse, albedo_1: vec4f, wo: vec3f, uc: f32, u: vec2f, mode: u32) -> BsdfSample {
    let entrance = Dielectric_sample_f(this_.interface_, wo, uc, u, mode, Directions_All);
    let wi = sample_cosine_hemisphere(u);
    let f = Layered_Diffuse_f_closed(this_, albedo_1, wo, wi);
    let pdf = Layered_Diffuse_pdf_closed(this_, wo, wi);
    let below = BsdfSample_new(f, wi, pdf, BxdfFlags_splat(BxdfFlags_DIFFUSE_REFLECTION));
    let sample = BsdfSample_select(BxdfFlags_is_reflective(entrance.flags), entrance, below);
    return BsdfSample(sample.f, sample.wi, sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, entrance.valid);
}
