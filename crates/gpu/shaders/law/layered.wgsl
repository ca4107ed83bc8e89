// Translated from crates/scattering/src/bxdf/layered/mod.rs
// by `cargo xtask wgsl`, which translates it again.

// A dielectric coat over an opaque base.
struct Layered_Conductor {
    base: Conductor,
    interface_: Dielectric,
    thickness: f32,
    albedo: vec4f,
    phase: HenyeyGreenstein,
    inner: f32,
    max_depth: u32,
    samples: u32,
    seed: u32,
}

// A dielectric coat over an opaque base.
struct Layered_Diffuse {
    base: Diffuse,
    interface_: Dielectric,
    thickness: f32,
    albedo: vec4f,
    phase: HenyeyGreenstein,
    inner: f32,
    max_depth: u32,
    samples: u32,
    seed: u32,
}

fn Diffuse_even_albedo(this_: Diffuse) -> Tuple_SampledSpectrum_bool {
    return Tuple_SampledSpectrum_bool(this_.reflectance, true);
}

// Uniform radiance below the coat leaves it as T(cos θ), by the reciprocity of T.
fn Diffuse_pdf_through(this_: Diffuse, interface_1: Dielectric, unused_2: vec3f, wi: vec3f) -> f32 {
    let transmitted = 1.0f - fr_dielectric(wi.z, interface_1.eta);
    return (cosine_hemisphere_pdf(wi.z) * transmitted) / (1.0f - mean_fresnel(interface_1.eta));
}

fn Conductor_even_albedo(this_: Conductor) -> Tuple_SampledSpectrum_bool {
    return Tuple_SampledSpectrum_bool(SampledSpectrum_zero(), false);
}

// A reflection off microfacets of slope s turns light by 2s, a refraction by (1 − 1/η)s.
fn Conductor_pdf_through(this_: Conductor, interface_1: Dielectric, wo: vec3f, wi: vec3f) -> f32 {
    let parts = fresnel_refract(wo, Vec3_Z, interface_1.eta);
    let inner_o = parts.v0;
    let eta = parts.v1;
    let enters = parts.v2;
    let parts_1 = fresnel_refract(wi, Vec3_Z, interface_1.eta);
    let inner_i = parts_1.v0;
    let leaves = parts_1.v2;
    let turn_1 = 1.0f - (1.0f / eta);
    let distribution_1 = TrowbridgeReitz_widened(this_.distribution, interface_1.distribution, sqr(turn_1) * 0.5f);
    let lobe = Conductor(distribution_1, this_.eta, this_.k);
    let pdf = Conductor_pdf(lobe, -inner_o, -inner_i, TransportMode_Radiance, Directions_All);
    let squeeze = wi.z / (sqr(eta) * abs(inner_i.z));
    return select(0.0f, pdf * squeeze, (enters & leaves) & (inner_i.z != 0.0f));
}

fn Layered_Conductor_has_medium(this_: Layered_Conductor) -> bool {
    return !SampledSpectrum_is_black(this_.albedo);
}

fn Layered_Diffuse_has_medium(this_: Layered_Diffuse) -> bool {
    return !SampledSpectrum_is_black(this_.albedo);
}

// The random numbers of walk `index` of a value.
fn Layered_Conductor_random(this_: Layered_Conductor, index: u32) -> HashSequence {
    let words_0 = this_.seed;
    let words_1 = u32(index);
    var state = 0x6a09e667u;
    {
        state = mix_word(state ^ words_0) + 0x3c6ef372u;
    }
    {
        state = mix_word(state ^ words_1) + 0x3c6ef372u;
    }
    return HashSequence(state);
}

// The random numbers of walk `index` of a value.
fn Layered_Diffuse_random(this_: Layered_Diffuse, index: u32) -> HashSequence {
    let words_0 = this_.seed;
    let words_1 = u32(index);
    var state = 0x6a09e667u;
    {
        state = mix_word(state ^ words_0) + 0x3c6ef372u;
    }
    {
        state = mix_word(state ^ words_1) + 0x3c6ef372u;
    }
    return HashSequence(state);
}

// `w` turned around where `below`.
fn flip(below: bool, w: vec3f) -> vec3f {
    return select(w, -w, below);
}

fn Layered_Conductor_flags(this_: Layered_Conductor) -> u32 {
    let coat = Dielectric_flags(this_.interface_);
    let base = Conductor_flags(this_.base);
    let smooth_1 = BxdfFlags_is_specular(coat);
    let diffuse = BxdfFlags_is_diffuse(base) | Layered_Conductor_has_medium(this_);
    return ((BxdfFlags_splat(BxdfFlags_REFLECTION) | BxdfFlags_only_where(smooth_1, BxdfFlags_SPECULAR)) | BxdfFlags_only_where(diffuse, BxdfFlags_DIFFUSE)) | BxdfFlags_only_where(!smooth_1 | BxdfFlags_is_glossy(base), BxdfFlags_GLOSSY);
}

fn Layered_Diffuse_flags(this_: Layered_Diffuse) -> u32 {
    let coat = Dielectric_flags(this_.interface_);
    let base = Diffuse_flags(this_.base);
    let smooth_1 = BxdfFlags_is_specular(coat);
    let diffuse = BxdfFlags_is_diffuse(base) | Layered_Diffuse_has_medium(this_);
    return ((BxdfFlags_splat(BxdfFlags_REFLECTION) | BxdfFlags_only_where(smooth_1, BxdfFlags_SPECULAR)) | BxdfFlags_only_where(diffuse, BxdfFlags_DIFFUSE)) | BxdfFlags_only_where(!smooth_1 | BxdfFlags_is_glossy(base), BxdfFlags_GLOSSY);
}

fn Layered_Conductor_f(this_: Layered_Conductor, wo: vec3f, wi: vec3f, mode: u32) -> vec4f {
    let below = wo.z < 0.0f;
    return Value_Conductor_run(Value_Conductor(this_, flip(below, wo), flip(below, wi), mode));
}

fn Layered_Diffuse_f(this_: Layered_Diffuse, wo: vec3f, wi: vec3f, mode: u32) -> vec4f {
    let below = wo.z < 0.0f;
    return Value_Diffuse_run(Value_Diffuse(this_, flip(below, wo), flip(below, wi), mode));
}

fn Layered_Conductor_sample_f(this_: Layered_Conductor, wo: vec3f, uc: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    if (!Directions_reflection(directions)) {
        return BsdfSample_invalid();
    }
    let below = wo.z < 0.0f;
    let sample = Sample_Conductor_run(Sample_Conductor(this_, flip(below, wo), uc, u, mode));
    let valid = sample.valid & (wo.z != 0.0f);
    return BsdfSample(sample.f, flip(below, sample.wi), sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, valid);
}

fn Layered_Diffuse_sample_f(this_: Layered_Diffuse, wo: vec3f, uc: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    if (!Directions_reflection(directions)) {
        return BsdfSample_invalid();
    }
    let below = wo.z < 0.0f;
    let sample = Sample_Diffuse_run(Sample_Diffuse(this_, flip(below, wo), uc, u, mode));
    let valid = sample.valid & (wo.z != 0.0f);
    return BsdfSample(sample.f, flip(below, sample.wi), sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, valid);
}

fn Layered_Conductor_pdf(this_: Layered_Conductor, wo: vec3f, wi: vec3f, mode: u32, directions: u32) -> f32 {
    if (!Directions_reflection(directions)) {
        return 0.0f;
    }
    let below = wo.z < 0.0f;
    return Density_Conductor_run(Density_Conductor(this_, flip(below, wo), flip(below, wi), mode));
}

fn Layered_Diffuse_pdf(this_: Layered_Diffuse, wo: vec3f, wi: vec3f, mode: u32, directions: u32) -> f32 {
    if (!Directions_reflection(directions)) {
        return 0.0f;
    }
    let below = wo.z < 0.0f;
    return Density_Diffuse_run(Density_Diffuse(this_, flip(below, wo), flip(below, wi), mode));
}

// The value for `wo` above. Like samples and densities it is called, because kernels of several
// algorithms have it.
struct Value_Conductor {
    layers: Layered_Conductor,
    wo: vec3f,
    wi: vec3f,
    mode: u32,
}

// The value for `wo` above. Like samples and densities it is called, because kernels of several
// algorithms have it.
struct Value_Diffuse {
    layers: Layered_Diffuse,
    wo: vec3f,
    wi: vec3f,
    mode: u32,
}

fn Value_Conductor_run(this_: Value_Conductor) -> vec4f {
    let layers = this_.layers;
    let wo = this_.wo;
    let wi = this_.wi;
    let mode = this_.mode;
    let valid = ((wo.z > 0.0f) & (wi.z > 0.0f)) & BxdfFlags_is_non_specular(Layered_Conductor_flags(layers));
    if (!valid) {
        return SampledSpectrum_zero();
    }
    var f = SampledSpectrum_zero();
    let parts = Layered_Conductor_closed_form(layers);
    let albedo_1 = parts.v0;
    let closed = parts.v1;
    if (closed) {
        f = Layered_Conductor_f_closed(layers, albedo_1, wo, wi);
    }
    let estimated = valid & !closed;
    if (estimated) {
        var sum = SampledSpectrum_zero();
        for (var index = 0u; index < layers.samples; index++) {
            sum += Estimate_Conductor_run(Estimate_Conductor(layers, wo, wi, mode, Layered_Conductor_random(layers, index)));
        }
        let estimate = Dielectric_f(layers.interface_, wo, wi, mode) + (sum / f32(layers.samples));
        f = SampledSpectrum_select(estimated, estimate, f);
    }
    return SampledSpectrum_select(valid, f, SampledSpectrum_zero());
}

fn Value_Diffuse_run(this_: Value_Diffuse) -> vec4f {
    let layers = this_.layers;
    let wo = this_.wo;
    let wi = this_.wi;
    let mode = this_.mode;
    let valid = ((wo.z > 0.0f) & (wi.z > 0.0f)) & BxdfFlags_is_non_specular(Layered_Diffuse_flags(layers));
    if (!valid) {
        return SampledSpectrum_zero();
    }
    var f = SampledSpectrum_zero();
    let parts = Layered_Diffuse_closed_form(layers);
    let albedo_1 = parts.v0;
    let closed = parts.v1;
    if (closed) {
        f = Layered_Diffuse_f_closed(layers, albedo_1, wo, wi);
    }
    let estimated = valid & !closed;
    if (estimated) {
        var sum = SampledSpectrum_zero();
        for (var index = 0u; index < layers.samples; index++) {
            sum += Estimate_Diffuse_run(Estimate_Diffuse(layers, wo, wi, mode, Layered_Diffuse_random(layers, index)));
        }
        let estimate = Dielectric_f(layers.interface_, wo, wi, mode) + (sum / f32(layers.samples));
        f = SampledSpectrum_select(estimated, estimate, f);
    }
    return SampledSpectrum_select(valid, f, SampledSpectrum_zero());
}

// A sample for `wo` above.
struct Sample_Conductor {
    layers: Layered_Conductor,
    wo: vec3f,
    uc: f32,
    u: vec2f,
    mode: u32,
}

// A sample for `wo` above.
struct Sample_Diffuse {
    layers: Layered_Diffuse,
    wo: vec3f,
    uc: f32,
    u: vec2f,
    mode: u32,
}

fn Sample_Conductor_run(this_: Sample_Conductor) -> BsdfSample {
    let layers = this_.layers;
    let wo = this_.wo;
    let uc = this_.uc;
    let u = this_.u;
    let mode = this_.mode;
    let parts = Layered_Conductor_closed_form(layers);
    let albedo_1 = parts.v0;
    let closed = parts.v1;
    if (!closed) {
        return SampleWalk_Conductor_run(SampleWalk_Conductor(layers, wo, uc, u, mode));
    }
    let exact = Layered_Conductor_sample_closed(layers, albedo_1, wo, uc, u, mode);
    if (closed) {
        return exact;
    }
    let walk = SampleWalk_Conductor_run(SampleWalk_Conductor(layers, wo, uc, u, mode));
    let rest = BsdfSample_select(closed, exact, walk);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, true, rest.valid);
}

fn Sample_Diffuse_run(this_: Sample_Diffuse) -> BsdfSample {
    let layers = this_.layers;
    let wo = this_.wo;
    let uc = this_.uc;
    let u = this_.u;
    let mode = this_.mode;
    let parts = Layered_Diffuse_closed_form(layers);
    let albedo_1 = parts.v0;
    let closed = parts.v1;
    if (!closed) {
        return SampleWalk_Diffuse_run(SampleWalk_Diffuse(layers, wo, uc, u, mode));
    }
    let exact = Layered_Diffuse_sample_closed(layers, albedo_1, wo, uc, u, mode);
    if (closed) {
        return exact;
    }
    let walk = SampleWalk_Diffuse_run(SampleWalk_Diffuse(layers, wo, uc, u, mode));
    let rest = BsdfSample_select(closed, exact, walk);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, true, rest.valid);
}

// The density for `wo` above.
struct Density_Conductor {
    layers: Layered_Conductor,
    wo: vec3f,
    wi: vec3f,
    mode: u32,
}

// The density for `wo` above.
struct Density_Diffuse {
    layers: Layered_Diffuse,
    wo: vec3f,
    wi: vec3f,
    mode: u32,
}

fn Density_Conductor_run(this_: Density_Conductor) -> f32 {
    let layers = this_.layers;
    let wo = this_.wo;
    let wi = this_.wi;
    let mode = this_.mode;
    let valid = ((wo.z > 0.0f) & (wi.z > 0.0f)) & BxdfFlags_is_non_specular(Layered_Conductor_flags(layers));
    if (!valid) {
        return 0.0f;
    }
    let interface_1 = layers.interface_;
    let reflected = Dielectric_pdf(interface_1, wo, wi, mode, Directions_All);
    let entering = 1.0f - fr_dielectric(wo.z, interface_1.eta);
    let in_medium = 1.0f - exponential_exp(layers.thickness * -2.0f);
    let in_medium_1 = select(0.0f, in_medium, Layered_Conductor_has_medium(layers));
    let even = 0.1f + (0.9f * in_medium_1);
    let through = Conductor_pdf_through(layers.base, interface_1, wo, wi);
    var pdf = reflected + (entering * lerp(even, through, cosine_hemisphere_pdf(wi.z)));
    let parts = Layered_Conductor_closed_form(layers);
    let closed = parts.v1;
    if (closed) {
        pdf = select(pdf, Layered_Conductor_pdf_closed(layers, wo, wi), closed);
    }
    return select(0.0f, pdf, valid);
}

fn Density_Diffuse_run(this_: Density_Diffuse) -> f32 {
    let layers = this_.layers;
    let wo = this_.wo;
    let wi = this_.wi;
    let mode = this_.mode;
    let valid = ((wo.z > 0.0f) & (wi.z > 0.0f)) & BxdfFlags_is_non_specular(Layered_Diffuse_flags(layers));
    if (!valid) {
        return 0.0f;
    }
    let interface_1 = layers.interface_;
    let reflected = Dielectric_pdf(interface_1, wo, wi, mode, Directions_All);
    let entering = 1.0f - fr_dielectric(wo.z, interface_1.eta);
    let in_medium = 1.0f - exponential_exp(layers.thickness * -2.0f);
    let in_medium_1 = select(0.0f, in_medium, Layered_Diffuse_has_medium(layers));
    let even = 0.1f + (0.9f * in_medium_1);
    let through = Diffuse_pdf_through(layers.base, interface_1, wo, wi);
    var pdf = reflected + (entering * lerp(even, through, cosine_hemisphere_pdf(wi.z)));
    let parts = Layered_Diffuse_closed_form(layers);
    let closed = parts.v1;
    if (closed) {
        pdf = select(pdf, Layered_Diffuse_pdf_closed(layers, wo, wi), closed);
    }
    return select(0.0f, pdf, valid);
}
