// Translated from crates/scattering/src/bxdf/openpbr/shares.rs
// by `cargo xtask wgsl`, which translates it again.

// Shares of the light from one direction above, as they were if nothing absorbed.
struct Shares {
    taken: Taken,
    coat: f32,
    seen: f32,
    dielectric: vec4f,
    diffuse_rest: vec4f,
    reflected: f32,
    refracted: f32,
    glass_rest: f32,
    inside: Inside,
}

// What passes the fuzz.
fn Shares_below_fuzz(this_: Shares) -> f32 {
    return this_.taken.left + this_.taken.coat;
}

// What is left for scattering between the facets of metal.
fn Shares_metal_rest(this_: Shares) -> f32 {
    return real_max(this_.taken.left - this_.taken.metal, 0.0f);
}

// Means of what is left for the last layer, over directions by their cosine; zero where nothing
// spreads light.
struct Rests {
    fuzz: f32,
    metal: f32,
    diffuse: vec4f,
    glass_above: f32,
    glass_below: f32,
    through_above: f32,
    through_below: f32,
}

// The shares of a direction.
struct SharesAt {
    surface: OpenPbr,
    w: vec3f,
}

fn SharesAt_run(this_: SharesAt) -> Shares {
    let surface = this_.surface;
    let w = this_.w;
    var shares = OpenPbr_bulk_shares(surface, w);
    let is_glass = OpenPbr_glass(surface) > 0.0f;
    if (surface.stack.is_thin) {
        if (is_glass) {
            let sheet = OpenPbrTable_inside(surface.table, surface.location, surface.waves, w);
            shares.reflected = sheet.reflected;
            shares.refracted = sheet.refracted;
            shares.glass_rest = sheet.left;
        }
    } else {
        if (is_glass & (w.z < 0.0f)) {
            shares.inside = OpenPbrTable_inside(surface.table, surface.location, surface.waves, w);
        }
    }
    return OpenPbr_under_coat(surface, shares, w);
}

// The shares of a direction above or, if it is below, of its opposite.
fn OpenPbr_shares(this_: OpenPbr, w: vec3f) -> Shares {
    return SharesAt_run(SharesAt(this_, w));
}

// The same where glass is no sheet, without what is inside.
fn OpenPbr_bulk_shares(this_: OpenPbr, w: vec3f) -> Shares {
    let taken = OpenPbrTable_taken(this_.table, this_.location, this_.waves.x, w);
    var shares = Shares(taken, taken.coat, 1.0f, SampledSpectrum_splat(taken.dielectric), SampledSpectrum_splat(real_max(taken.left - taken.dielectric, 0.0f)), taken.dielectric, taken.refracted, real_max((taken.left - taken.dielectric) - taken.refracted, 0.0f), Inside(0.0f, 0.0f, 0.0f));
    if (OpenPbrTable_has_film(this_.table)) {
        var refracted = shares.diffuse_rest;
        var rest = shares.diffuse_rest;
        for (var i = 0u; i < sampled_N; i++) {
            let taken_1 = OpenPbrTable_taken(this_.table, this_.location, this_.waves[i], w);
            shares.dielectric[i] = taken_1.dielectric;
            shares.diffuse_rest[i] = real_max(taken_1.left - taken_1.dielectric, 0.0f);
            refracted[i] = taken_1.refracted;
            rest[i] = real_max((taken_1.left - taken_1.dielectric) - taken_1.refracted, 0.0f);
        }
        shares.reflected = SampledSpectrum_average(shares.dielectric);
        shares.refracted = SampledSpectrum_average(refracted);
        shares.glass_rest = SampledSpectrum_average(rest);
    }
    return shares;
}

// What the layers over the base pass on at a cosine, for a middle azimuth.
fn OpenPbr_passed(this_: OpenPbr, cosine: f32) -> f32 {
    let across = safe_sqrt(0.5f * (1.0f - sqr(cosine)));
    return OpenPbrTable_taken(this_.table, this_.location, 0.0f, vec3f(across, across, cosine)).below_coat;
}

// The means of what is left.
fn OpenPbr_rests(this_: OpenPbr) -> Rests {
    let means = OpenPbrTable_means(this_.table, this_.location, this_.waves.x);
    let spreads = Stack_spreads(this_.stack);
    let above = select(0.0f, means.glass_above, spreads);
    let below = select(0.0f, means.glass_below, spreads);
    var rests = Rests(means.fuzz, select(0.0f, means.metal, spreads), SampledSpectrum_splat(means.diffuse), above, below, 0.0f, 0.0f);
    if (OpenPbrTable_has_film(this_.table)) {
        for (var i = 0u; i < sampled_N; i++) {
            rests.diffuse[i] = OpenPbrTable_means(this_.table, this_.location, this_.waves[i]).diffuse;
        }
    }
    if (this_.stack.is_thin) {
        let rest = rests;
        return Rests(rest.fuzz, rest.metal, rest.diffuse, rest.glass_above, rest.glass_below, 0.5f, 0.5f);
    }
    let is_glass = ((above > 0.0f) & (below > 0.0f)) & (OpenPbr_glass(this_) > 0.0f);
    if (is_glass) {
        let most = (sqr(this_.stack.index) * below) / above;
        let through = real_min(1.0f - mean_fresnel(this_.stack.index), most);
        rests.through_above = select(0.0f, through, is_glass);
        rests.through_below = select(0.0f, through / most, is_glass);
    }
    return rests;
}
