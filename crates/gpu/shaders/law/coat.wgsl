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

// h: the share of the surface that a tilted coat is for a viewer above.
fn OpenPbr_coat_share(this_: OpenPbr, w: vec3f, on_coat: vec3f) -> f32 {
    let mirrored_1 = ((2.0f * on_coat.z) * this_.coat_normal.z) - w.z;
    let width_1 = 0.5f * sqrt(1.0f - sqr(this_.coat_normal.z));
    let share_1 = real_min(real_max(mirrored_1 / real_max(width_1, 1e-3f), 0.0f), 1.0f);
    return select(0.0f, share_1, is_above(on_coat));
}

// What facets of the coat reflect between two directions as the coat has them, if they are
// above it.
fn OpenPbr_coat_facets(this_: OpenPbr, wo: vec3f, wi: vec3f) -> f32 {
    let mirror = Mirror_new(this_.stack.coat, wo, wi);
    let f = fr_dielectric(mirror.cosine, this_.stack.coat_ior) * mirror.f;
    return select(0.0f, f, is_above(wo) & is_above(wi));
}

// The value for two directions above, of light that has passed the fuzz.
fn OpenPbr_coat(this_: OpenPbr, wo: vec3f, wi: vec3f, mode: u32) -> f32 {
    let f = OpenPbr_coat_facets(this_, OpenPbr_on_coat(this_, wo), OpenPbr_on_coat(this_, wi));
    let is_tilted = OpenPbr_is_tilted(this_);
    if (!is_tilted) {
        return f;
    }
    var chosen: f32;
    if (mode == TransportMode_Radiance) {
        chosen = OpenPbr_tilted_coat(this_, wo, wi);
    } else {
        chosen = OpenPbr_tilted_coat(this_, wi, wo);
    }
    let tilted = chosen;
    return select(f, tilted, is_tilted);
}

// The value of a tilted coat for a viewer and light from another direction, both above.
fn OpenPbr_tilted_coat(this_: OpenPbr, viewer: vec3f, light: vec3f) -> f32 {
    let on_coat = OpenPbr_on_coat(this_, viewer);
    let direct = OpenPbr_on_coat(this_, light);
    let mirrored_1 = OpenPbr_on_coat(this_, turned(light));
    let direct_1 = OpenPbr_coat_facets(this_, on_coat, direct) * direct.z;
    let mirrored_2 = OpenPbr_coat_facets(this_, on_coat, mirrored_1) * mirrored_1.z;
    return ((direct_1 + mirrored_2) / light.z) * OpenPbr_coat_share(this_, viewer, on_coat);
}

// What a smooth coat reflects of the light from a direction above into its mirror image, times
// the cosine of that.
fn OpenPbr_specular_coat(this_: OpenPbr, wo: vec3f, wi: vec3f, mode: u32) -> f32 {
    let on_coat = OpenPbr_on_coat(this_, wo);
    let reflected = fr_dielectric(on_coat.z, this_.stack.coat_ior);
    let is_tilted = OpenPbr_is_tilted(this_);
    if (!is_tilted) {
        return reflected;
    }
    var chosen: f32;
    if (mode == TransportMode_Radiance) {
        chosen = reflected * OpenPbr_coat_share(this_, wo, on_coat);
    } else {
        chosen = ((reflected * wi.z) / wo.z) * OpenPbr_coat_share(this_, wi, OpenPbr_on_coat(this_, wi));
    }
    let tilted = chosen;
    return select(reflected, tilted, is_tilted);
}

// The probability that light from a direction above meets a tilted coat there, and not from
// where the base mirrors it.
fn OpenPbr_meets_coat(this_: OpenPbr, w: vec3f) -> f32 {
    let direct = real_max(OpenPbr_on_coat(this_, w).z, 0.0f);
    let mirrored_1 = real_max(OpenPbr_on_coat(this_, turned(w)).z, 0.0f);
    let is_smooth = TrowbridgeReitz_effectively_smooth(this_.stack.coat);
    let chance = direct / real_max(direct + mirrored_1, 1.1754944e-38f);
    return select(chance, 1.0f, is_smooth);
}

// A direction in which the coat reflects light, as `mirrored` has it, for one above.
fn OpenPbr_sample_coat(this_: OpenPbr, wo: vec3f, uc: f32, u: vec2f, mode: u32) -> BsdfSample {
    let is_tilted = OpenPbr_is_tilted(this_);
    var coat_wo = OpenPbr_on_coat(this_, wo);
    if (is_tilted && (mode == TransportMode_Importance)) {
        let is_direct = !is_tilted | (uc < OpenPbr_meets_coat(this_, wo));
        coat_wo = select(OpenPbr_on_coat(this_, turned(wo)), coat_wo, is_direct);
    }
    let sample = mirrored(this_.stack.coat, coat_wo, u);
    if (!is_tilted) {
        return sample;
    }
    var wi = Frame_from_local(OpenPbr_coat_frame(this_), sample.wi);
    if (mode == TransportMode_Radiance) {
        let is_rough = !TrowbridgeReitz_effectively_smooth(this_.stack.coat);
        wi = select(wi, turned(wi), is_rough & (wi.z < 0.0f));
    }
    let valid = sample.valid & (!is_tilted | (is_above(coat_wo) & is_above(wi)));
    return BsdfSample(sample.f, select(sample.wi, wi, is_tilted), sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, valid);
}

// The density of [`Self::sample_coat`] for two directions above.
fn OpenPbr_pdf_coat(this_: OpenPbr, wo: vec3f, wi: vec3f, mode: u32) -> f32 {
    let coat_wo = OpenPbr_on_coat(this_, wo);
    let coat_wi = OpenPbr_on_coat(this_, wi);
    let direct = OpenPbr_pdf_on_coat(this_, coat_wo, coat_wi);
    let is_tilted = OpenPbr_is_tilted(this_);
    if (!is_tilted) {
        return direct;
    }
    var chosen: f32;
    if (mode == TransportMode_Radiance) {
        chosen = direct + OpenPbr_pdf_on_coat(this_, coat_wo, OpenPbr_on_coat(this_, turned(wi)));
    } else {
        let mirrored_1 = OpenPbr_pdf_on_coat(this_, OpenPbr_on_coat(this_, turned(wo)), coat_wi);
        chosen = lerp(OpenPbr_meets_coat(this_, wo), mirrored_1, direct);
    }
    let tilted = chosen;
    return select(direct, tilted, is_tilted);
}

// The density of the facets of the coat for two directions as the coat has them.
fn OpenPbr_pdf_on_coat(this_: OpenPbr, wo: vec3f, wi: vec3f) -> f32 {
    let mirror = Mirror_new(this_.stack.coat, wo, wi);
    return select(0.0f, mirror.pdf, is_above(wo) & is_above(wi));
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
    let passed = at_coat.below_coat / real_max(at_coat.left + at_coat.coat, 1.1754944e-38f);
    let reflected = (1.0f - passed) * OpenPbr_coat_share(this_, w_1, on_coat);
    let coat = select(shares.coat, Shares_below_fuzz(shares) * reflected, is_tilted);
    let left = Shares_below_fuzz(shares) * (1.0f - reflected);
    let seen = select(1.0f, left / real_max(shares.taken.left, 1.1754944e-38f), is_tilted);
    return Shares(shares.taken, coat, seen, shares.dielectric, shares.diffuse_rest, shares.reflected, shares.refracted, shares.glass_rest, shares.inside);
}

// Whether a direction is above a surface, and off its horizon.
fn is_above(w: vec3f) -> bool {
    return (w.z > 0.0f) & is_off_horizon(w);
}
