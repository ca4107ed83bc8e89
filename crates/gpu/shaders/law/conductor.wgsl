// Translated from crates/scattering/src/bxdf/conductor.rs
// by `cargo xtask wgsl`, which translates it again.

// A metal of index `eta` + i `k`.
struct Conductor {
    distribution: TrowbridgeReitz,
    eta: vec4f,
    k: vec4f,
}

// The value where microfacets of normal `wm` turn `wo` into `wi`, on one side of the surface
// and off the horizon.
fn Conductor_f_microfacet(this_: Conductor, wo: vec3f, wi: vec3f, wm: vec3f) -> vec4f {
    let fresnel = fr_conductor(abs(Vec3_dot(wo, wm)), this_.eta, this_.k);
    let facets = TrowbridgeReitz_d(this_.distribution, wm) * TrowbridgeReitz_g(this_.distribution, wo, wi);
    return fresnel * (facets / ((4.0f * wi.z) * wo.z));
}

// The density of the reflection of `wo` in sampled microfacets of normal `wm`.
fn Conductor_pdf_microfacet(this_: Conductor, wo: vec3f, wm: vec3f) -> f32 {
    return TrowbridgeReitz_pdf(this_.distribution, wo, wm) / (4.0f * abs(Vec3_dot(wo, wm)));
}

// The normal of microfacets that turn `wo` into `wi`, and where there are any that are not
// those of a smooth surface.
fn Conductor_facet(this_: Conductor, wo: vec3f, wi: vec3f) -> Tuple_Vec3_bool {
    let parts = Vec3_normalize_masked(wo + wi);
    let wm = parts.v0;
    let valid = parts.v1;
    return Tuple_Vec3_bool(wm, (valid & same_hemisphere(wo, wi)) & !TrowbridgeReitz_effectively_smooth(this_.distribution));
}

fn Conductor_sample_specular(this_: Conductor, wo: vec3f) -> BsdfSample {
    let wi = vec3f(-wo.x, -wo.y, wo.z);
    let f = fr_conductor(abs(wi.z), this_.eta, this_.k) / abs(wi.z);
    return BsdfSample_new(f, wi, 1.0f, BxdfFlags_splat(BxdfFlags_SPECULAR_REFLECTION));
}

fn Conductor_sample_glossy(this_: Conductor, wo: vec3f, u: vec2f) -> BsdfSample {
    let wm = TrowbridgeReitz_sample_wm(this_.distribution, wo, u);
    let wi = fresnel_reflect(wo, wm);
    let valid = same_hemisphere(wo, wi);
    if (!valid) {
        return BsdfSample_invalid();
    }
    let f = Conductor_f_microfacet(this_, wo, wi, wm);
    let pdf = Conductor_pdf_microfacet(this_, wo, wm);
    let lobe = BxdfFlags_splat(BxdfFlags_GLOSSY_REFLECTION);
    let rest = BsdfSample_new(f, wi, pdf, lobe);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, rest.pdf_is_proportional, valid);
}

fn Conductor_flags(this_: Conductor) -> u32 {
    return BxdfFlags_choose(TrowbridgeReitz_effectively_smooth(this_.distribution), BxdfFlags_SPECULAR_REFLECTION, BxdfFlags_GLOSSY_REFLECTION);
}

fn Conductor_f(this_: Conductor, wo: vec3f, wi: vec3f, unused_3: u32) -> vec4f {
    let parts = Conductor_facet(this_, wo, wi);
    let wm = parts.v0;
    let valid = parts.v1;
    if (!valid) {
        return SampledSpectrum_zero();
    }
    return SampledSpectrum_select(valid, Conductor_f_microfacet(this_, wo, wi, wm), SampledSpectrum_zero());
}

fn Conductor_sample_f(this_: Conductor, wo: vec3f, unused_2: f32, u: vec2f, unused_4: u32, directions: u32) -> BsdfSample {
    if (!Directions_reflection(directions)) {
        return BsdfSample_invalid();
    }
    let smooth_1 = TrowbridgeReitz_effectively_smooth(this_.distribution);
    var chosen_1: BsdfSample;
    if (smooth_1) {
        chosen_1 = Conductor_sample_specular(this_, wo);
    } else {
        let glossy = Conductor_sample_glossy(this_, wo, u);
        var chosen: BsdfSample;
        if (smooth_1) {
            chosen = BsdfSample_select(smooth_1, Conductor_sample_specular(this_, wo), glossy);
        } else {
            chosen = glossy;
        }
        chosen_1 = chosen;
    }
    let sample = chosen_1;
    return BsdfSample(sample.f, sample.wi, sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, sample.valid & (wo.z != 0.0f));
}

fn Conductor_pdf(this_: Conductor, wo: vec3f, wi: vec3f, unused_3: u32, directions: u32) -> f32 {
    let parts = Conductor_facet(this_, wo, wi);
    let wm = parts.v0;
    let valid = parts.v1;
    if (!Directions_reflection(directions) || !valid) {
        return 0.0f;
    }
    return select(0.0f, Conductor_pdf_microfacet(this_, wo, wm), valid);
}
