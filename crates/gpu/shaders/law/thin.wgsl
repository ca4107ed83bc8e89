// Translated from crates/scattering/src/bxdf/openpbr/thin.rs
// by `cargo xtask wgsl`, which translates it again.

// What a smooth sheet reflects and transmits of light at a cosine.
fn OpenPbr_sheet_shares(this_: OpenPbr, cosine: f32) -> array<vec4f, 2> {
    let one = SampledSpectrum_splat(1.0f);
    let f = Stack_dielectrics(this_.stack, cosine, this_.waves);
    let a = this_.transmission_color;
    let passed = (one - f) * (one - f);
    let sum = SampledSpectrum_max(one - (((a * a) * f) * f), SampledSpectrum_splat(1e-6f));
    return array<vec4f, 2>(f + ((((a * a) * f) * passed) / sum), (a * passed) / sum);
}

// The value of a share of what is scattered within the wall, for two directions above.
fn OpenPbr_scattered(this_: OpenPbr, share_1: f32, wo: vec3f, wi: vec3f) -> vec4f {
    let white = SampledSpectrum_splat(1.0f);
    return (this_.diffuse_base.scattered * oren_nayar(white, this_.diffuse_base.roughness, wo, wi)) * share_1;
}

// The value of a thin wall for a direction above and one below.
fn OpenPbr_passed_through(this_: OpenPbr, argument_1: array<Shares, 2>, rests: Rests, argument_3: array<vec3f, 2>, mode: u32) -> vec4f {
    let o = argument_1[0];
    let i = argument_1[1];
    let wo = argument_3[0];
    let wi = argument_3[1];
    let wi_1 = turned(wi);
    let weights_1 = OpenPbr_weights(this_, 1.0f);
    var f = SampledSpectrum_zero();
    if (weights_1.glass > 0.0f) {
        let mirror = Mirror_new(Stack_sheet(this_.stack), wo, wi_1);
        let white = mirror.f * real_min(o.taken.below_coat, i.taken.below_coat);
        let parts = OpenPbr_sheet_shares(this_, mirror.cosine);
        let passed = parts[1];
        f += passed * (white * weights_1.glass);
        let has_rest = rests.glass_above > 0.0f;
        let left = (o.glass_rest * i.glass_rest) / (3.1415927f * rests.glass_above);
        let again = select(0.0f, left * rests.through_above, has_rest);
        f += this_.transmission_color * (again * weights_1.glass);
    }
    let is_diffuse = (weights_1.diffuse > 0.0f) & OpenPbr_transmits_diffusely(this_);
    if (is_diffuse) {
        let left_1 = SampledSpectrum_safe_div(o.diffuse_rest * i.diffuse_rest, rests.diffuse);
        f += ((OpenPbr_scattered(this_, this_.diffuse_base.forward, wo, wi_1) * left_1) * this_.darkening) * weights_1.diffuse;
    }
    let seen = of_viewer(vec2f(o.seen, i.seen), mode);
    return (f * OpenPbr_absorbed(this_, OpenPbr_coat_length(this_, wo.z) + OpenPbr_coat_length(this_, wi_1.z))) * seen;
}

// A direction in which a sheet of glass transmits light from one above, without its value, and
// of the density only that of a smooth sheet.
fn OpenPbr_sample_sheet(this_: OpenPbr, wo: vec3f, u: vec2f) -> BsdfSample {
    let sample = mirrored(Stack_sheet(this_.stack), wo, u);
    let flags = BxdfFlags_choose(BxdfFlags_is_specular(sample.flags), BxdfFlags_SPECULAR_TRANSMISSION, BxdfFlags_GLOSSY_TRANSMISSION);
    return BsdfSample(sample.f, turned(sample.wi), sample.pdf, flags, sample.eta, sample.pdf_is_proportional, sample.valid);
}

// The density of [`Self::sample_sheet`] for a direction above and one below.
fn OpenPbr_pdf_sheet(this_: OpenPbr, wo: vec3f, wi: vec3f) -> f32 {
    return Mirror_new(Stack_sheet(this_.stack), wo, turned(wi)).pdf;
}
