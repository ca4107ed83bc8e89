// Translated from crates/scattering/src/bxdf/openpbr/coat.rs
// by `cargo xtask wgsl`, which translates it again.

// Whether the normal of the coat is another than that of the base.
fn OpenPbr_is_tilted(this_: OpenPbr) -> bool {
    let parts = this_.coat_normal;
    let x = parts.x;
    let y = parts.y;
    let z = parts.z;
    return ((x != 0.0f) | (y != 0.0f)) | (z != 1.0f);
}

// The frame of a tilted coat.
fn OpenPbr_coat_frame(this_: OpenPbr) -> Frame {
    return Frame_from_z_and_x(this_.coat_normal, Vec3_X);
}

// A direction above, as the coat has it.
fn OpenPbr_on_coat(this_: OpenPbr, w: vec3f) -> vec3f {
    let is_tilted = OpenPbr_is_tilted(this_);
    if (!is_tilted) {
        return w;
    }
    return select(w, Frame_to_local(OpenPbr_coat_frame(this_), w), is_tilted);
}

// The share of light from a tilted coat that is mirrored above the base, by its cosine there.
fn OpenPbr_mirrored_above(this_: OpenPbr, z: f32) -> f32 {
    let width_1 = 0.5f * sqrt(1.0f - sqr(this_.coat_normal.z));
    return real_min(real_max(z / real_max(width_1, 1e-3f), 0.0f), 1.0f);
}

// The value for two directions above, of light that has passed the fuzz.
fn OpenPbr_coat(this_: OpenPbr, wo: vec3f, wi: vec3f, mode: u32) -> f32 {
    let coat_wo = OpenPbr_on_coat(this_, wo);
    let coat_wi = OpenPbr_on_coat(this_, wi);
    let is_above_1 = is_above(coat_wo) & is_above(coat_wi);
    let mirror = Mirror_new(this_.stack.coat, coat_wo, coat_wi);
    let f = fr_dielectric(mirror.cosine, this_.stack.coat_ior) * mirror.f;
    let f_1 = select(0.0f, f, is_above_1);
    let is_tilted = OpenPbr_is_tilted(this_);
    if (!is_tilted) {
        return f_1;
    }
    var chosen: f32;
    if (mode == TransportMode_Radiance) {
        chosen = ((f_1 * coat_wi.z) / wi.z) * OpenPbr_mirrored_above(this_, wi.z);
    } else {
        chosen = ((f_1 * coat_wo.z) / wo.z) * OpenPbr_mirrored_above(this_, wo.z);
    }
    let tilted = chosen;
    return select(f_1, tilted, is_tilted);
}

// What a smooth coat reflects of the light from a direction above into its mirror image, times
// the cosine of that.
fn OpenPbr_specular_coat(this_: OpenPbr, wo: vec3f, wi: vec3f, mode: u32) -> f32 {
    let reflected = fr_dielectric(OpenPbr_on_coat(this_, wo).z, this_.stack.coat_ior);
    let is_tilted = OpenPbr_is_tilted(this_);
    if (!is_tilted) {
        return reflected;
    }
    var chosen: f32;
    if (mode == TransportMode_Radiance) {
        chosen = reflected * OpenPbr_mirrored_above(this_, wi.z);
    } else {
        chosen = ((reflected * wi.z) / wo.z) * OpenPbr_mirrored_above(this_, wo.z);
    }
    let tilted = chosen;
    return select(reflected, tilted, is_tilted);
}

// A direction in which the coat reflects light, as `mirrored` has it, for one above.
fn OpenPbr_sample_coat(this_: OpenPbr, wo: vec3f, u: vec2f) -> BsdfSample {
    let is_tilted = OpenPbr_is_tilted(this_);
    let coat_wo = OpenPbr_on_coat(this_, wo);
    let sample = mirrored(this_.stack.coat, coat_wo, u);
    if (!is_tilted) {
        return sample;
    }
    let wi = select(sample.wi, Frame_from_local(OpenPbr_coat_frame(this_), sample.wi), is_tilted);
    let valid = sample.valid & (!is_tilted | (is_above(coat_wo) & is_above(wi)));
    return BsdfSample(sample.f, wi, sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, valid);
}

// The density of [`Self::sample_coat`] for two directions above.
fn OpenPbr_pdf_coat(this_: OpenPbr, wo: vec3f, wi: vec3f) -> f32 {
    let wo_1 = OpenPbr_on_coat(this_, wo);
    let wi_1 = OpenPbr_on_coat(this_, wi);
    let mirror = Mirror_new(this_.stack.coat, wo_1, wi_1);
    return select(0.0f, mirror.pdf, is_above(wo_1) & is_above(wi_1));
}

// The shares of a direction off the horizon, with those of a coat that is tilted.
fn OpenPbr_under_coat(this_: OpenPbr, shares: Shares, w: vec3f) -> Shares {
    let is_tilted = OpenPbr_is_tilted(this_);
    if (!is_tilted) {
        return shares;
    }
    let w_1 = upright(w.z < 0.0f, w);
    let on_coat = OpenPbr_on_coat(this_, w_1);
    let at_coat = OpenPbrTable_taken(this_.table, this_.location, this_.waves.x, on_coat);
    let mirrored_1 = OpenPbr_mirrored_above(this_, ((2.0f * on_coat.z) * this_.coat_normal.z) - w_1.z);
    let reflected = (at_coat.coat / real_max(at_coat.left + at_coat.coat, 1.1754944e-38f)) * mirrored_1;
    let reflected_1 = select(0.0f, reflected, is_above(on_coat));
    let taken = shares.taken;
    let coat = select(taken.coat, Shares_below_fuzz(shares) * reflected_1, is_tilted);
    let left = select(taken.left, Shares_below_fuzz(shares) - coat, is_tilted);
    let scale_1 = select(1.0f, left / real_max(taken.left, 1.1754944e-38f), is_tilted);
    let taken_1 = Taken(taken.fuzz_once, taken.fuzz_more, coat, taken.below_coat * scale_1, taken.metal * scale_1, taken.dielectric * scale_1, taken.refracted * scale_1, left);
    return Shares(taken_1, shares.dielectric * scale_1, shares.diffuse_rest * scale_1, shares.reflected * scale_1, shares.refracted * scale_1, shares.glass_rest * scale_1, shares.inside);
}

// Whether a direction is above a surface, and off its horizon.
fn is_above(w: vec3f) -> bool {
    return (w.z > 0.0f) & is_off_horizon(w);
}
