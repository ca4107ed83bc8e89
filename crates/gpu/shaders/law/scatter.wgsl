// Translated from crates/scattering/src/bxdf/scatter.rs
// by `cargo xtask wgsl`, which translates it again.

// A sampled direction of scattering, for each lane.
struct BsdfSample {
    f: vec4f,
    wi: vec3f,
    pdf: f32,
    flags: u32,
    eta: f32,
    pdf_is_proportional: bool,
    valid: bool,
}

// A valid sample of `lobe` in a medium that does not change.
fn BsdfSample_new(f: vec4f, wi: vec3f, pdf: f32, lobe: u32) -> BsdfSample {
    return BsdfSample(f, wi, pdf, lobe, 1.0f, false, true);
}

// No sample in any lane.
fn BsdfSample_invalid() -> BsdfSample {
    let black = SampledSpectrum_zero();
    let wi = vec3f(0.0f);
    let lobe = BxdfFlags_splat(BxdfFlags_NONE);
    let rest = BsdfSample_new(black, wi, 0.0f, lobe);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, rest.pdf_is_proportional, false);
}

// `a` where the mask is true, else `b`. Does not say whether a density is proportional.
fn BsdfSample_select(mask: bool, a: BsdfSample, b: BsdfSample) -> BsdfSample {
    return BsdfSample(SampledSpectrum_select(mask, a.f, b.f), select(b.wi, a.wi, mask), select(b.pdf, a.pdf, mask), BxdfFlags_select(mask, a.flags, b.flags), select(b.eta, a.eta, mask), false, (mask & a.valid) | (!mask & b.valid));
}
