// Translated from crates/scattering/src/bxdf/openpbr/chances.rs
// by `cargo xtask wgsl`, which translates it again.

const chances_FUZZ: u32 = 0;

const chances_COAT: u32 = 1;

const chances_FACETS: u32 = 2;

const chances_GLASS: u32 = 3;

const chances_REST: u32 = 4;

const chances_THROUGH: u32 = 5;

const chances_UNDER: u32 = 6;

const chances_NEGLIGIBLE: f32 = 1e-6f;

// The probabilities of all lobes.
struct Chances {
    of_: array<f32, 7>,
}

// A lobe that is chosen.
struct ChosenLobe {
    lobe: u32,
    chance: f32,
    u: f32,
}

// For light to `wo`, off the horizon. All are zero if nothing is scattered.
fn Chances_new(surface: OpenPbr, shares: Shares, rests: Rests, wo: vec3f, mode: u32, directions: u32) -> Chances {
    let cosine = abs(wo.z);
    let taken = shares.taken;
    let weights_1 = OpenPbr_weights(surface, wo.z);
    let upwards = taken.fuzz_once + (0.5f * taken.fuzz_more);
    let fuzz = (surface.stack.fuzz_weight * upwards) * SampledSpectrum_average(surface.fuzz_color);
    var reflected = SampledSpectrum_zero();
    var rest = SampledSpectrum_zero();
    if (weights_1.diffuse > 0.0f) {
        reflected += (shares.dielectric * surface.specular_color) * weights_1.diffuse;
        rest += (shares.diffuse_rest * OpenPbr_diffuse_albedo(surface, weights_1)) * weights_1.diffuse;
    }
    if (weights_1.metal > 0.0f) {
        reflected += OpenPbr_metal(surface, cosine) * (taken.metal * weights_1.metal);
        let has_rest = rests.metal > 0.0f;
        let left = select(0.0f, Shares_metal_rest(shares) * weights_1.metal, has_rest);
        rest += surface.metal.again * left;
    }
    var seen = shares.seen;
    var coat = weights_1.layers * shares.coat;
    let is_tilted = OpenPbr_is_tilted(surface);
    if ((mode == TransportMode_Importance) && is_tilted) {
        let least = ((0.1f * weights_1.layers) * Shares_below_fuzz(shares)) * surface.stack.coat_weight;
        coat = select(coat, real_max(coat, least), is_tilted);
        seen = 1.0f;
    }
    let is_coated = surface.stack.coat_weight > 0.0f;
    if (is_coated) {
        let length_1 = 2.0f * OpenPbr_coat_length(surface, cosine);
        let opaque = (surface.darkening * OpenPbr_absorbed(surface, length_1)) * seen;
        reflected = SampledSpectrum_select(is_coated, reflected * opaque, reflected);
        rest = SampledSpectrum_select(is_coated, rest * opaque, rest);
    }
    var of_1 = array<f32, 7>(0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f);
    of_1[u32(chances_FUZZ)] = weights_1.layers * fuzz;
    of_1[u32(chances_COAT)] = coat;
    of_1[u32(chances_FACETS)] = SampledSpectrum_average(reflected);
    of_1[u32(chances_REST)] = SampledSpectrum_average(rest);
    if (OpenPbr_glass(surface) > 0.0f) {
        let glass = OpenPbr_scattered_by_glass(surface, shares, rests, wo, seen);
        if (surface.stack.is_thin) {
            of_1[u32(chances_FACETS)] += glass.reflected;
            of_1[u32(chances_GLASS)] = glass.refracted;
        } else {
            of_1[u32(chances_GLASS)] = glass.reflected + glass.refracted;
        }
        of_1[u32(chances_REST)] += glass.rest;
        of_1[u32(chances_THROUGH)] = glass.through;
    }
    if (surface.stack.is_thin) {
        let transmitted = (shares.diffuse_rest * surface.diffuse_base.scattered) * surface.darkening;
        of_1[u32(chances_THROUGH)] += SampledSpectrum_average(transmitted) * ((surface.diffuse_base.forward * weights_1.diffuse) * seen);
    }
    if ((mode == TransportMode_Radiance) && (weights_1.under > 0.0f)) {
        let color_1 = surface.subsurface_color;
        let goes_under = SampledSpectrum_average(OpenPbr_goes_under(surface, shares, wo) * color_1);
        of_1[u32(chances_UNDER)] = select(0.0f, goes_under, weights_1.under > 0.0f);
    }
    var chances = Chances(of_1);
    Chances_restrict(&chances, directions, surface.stack.is_thin);
    Chances_normalize(&chances);
    return chances;
}

// Leaves out lobes that scatter in no direction that is asked for.
fn Chances_restrict(this_: ptr<function, Chances>, directions: u32, is_thin: bool) {
    if (directions == Directions_Reflection) {
        (*this_).of_[u32(chances_THROUGH)] = 0.0f;
        (*this_).of_[u32(chances_UNDER)] = 0.0f;
        if (is_thin) {
            (*this_).of_[u32(chances_GLASS)] = 0.0f;
        }
    }
    if (directions == Directions_Transmission) {
        (*this_).of_[u32(chances_FUZZ)] = 0.0f;
        (*this_).of_[u32(chances_COAT)] = 0.0f;
        (*this_).of_[u32(chances_FACETS)] = 0.0f;
        (*this_).of_[u32(chances_REST)] = 0.0f;
    }
}

// Makes probabilities of them.
fn Chances_normalize(this_: ptr<function, Chances>) {
    var sum = 0.0f;
    for (var i = 0u; i < 7; i++) {
        sum += (*this_).of_[i];
    }
    for (var i_1 = 0u; i_1 < 7; i_1++) {
        let is_sampled = (*this_).of_[i_1] > (chances_NEGLIGIBLE * sum);
        (*this_).of_[i_1] = select(0.0f, (*this_).of_[i_1] / sum, is_sampled);
    }
}

// A lobe.
fn Chances_choose(this_: Chances, u: f32) -> ChosenLobe {
    var choice = ChosenLobe(0u, 0.0f, u);
    var left = u;
    var is_found = false;
    let parts = this_.of_;
    {
        let chance = parts[0];
        let is_here = !is_found & (chance > 0.0f);
        let rest = real_min(left / chance, float_ONE_MINUS_EPSILON);
        choice.lobe = select(choice.lobe, u32(u32(0)), is_here);
        choice.chance = select(choice.chance, chance, is_here);
        choice.u = select(choice.u, rest, is_here);
        is_found = is_found | (is_here & (left < chance));
        left = select(left, left - chance, is_here);
    }
    {
        let chance_1 = parts[1];
        let is_here_1 = !is_found & (chance_1 > 0.0f);
        let rest_1 = real_min(left / chance_1, float_ONE_MINUS_EPSILON);
        choice.lobe = select(choice.lobe, u32(u32(1)), is_here_1);
        choice.chance = select(choice.chance, chance_1, is_here_1);
        choice.u = select(choice.u, rest_1, is_here_1);
        is_found = is_found | (is_here_1 & (left < chance_1));
        left = select(left, left - chance_1, is_here_1);
    }
    {
        let chance_2 = parts[2];
        let is_here_2 = !is_found & (chance_2 > 0.0f);
        let rest_2 = real_min(left / chance_2, float_ONE_MINUS_EPSILON);
        choice.lobe = select(choice.lobe, u32(u32(2)), is_here_2);
        choice.chance = select(choice.chance, chance_2, is_here_2);
        choice.u = select(choice.u, rest_2, is_here_2);
        is_found = is_found | (is_here_2 & (left < chance_2));
        left = select(left, left - chance_2, is_here_2);
    }
    {
        let chance_3 = parts[3];
        let is_here_3 = !is_found & (chance_3 > 0.0f);
        let rest_3 = real_min(left / chance_3, float_ONE_MINUS_EPSILON);
        choice.lobe = select(choice.lobe, u32(u32(3)), is_here_3);
        choice.chance = select(choice.chance, chance_3, is_here_3);
        choice.u = select(choice.u, rest_3, is_here_3);
        is_found = is_found | (is_here_3 & (left < chance_3));
        left = select(left, left - chance_3, is_here_3);
    }
    {
        let chance_4 = parts[4];
        let is_here_4 = !is_found & (chance_4 > 0.0f);
        let rest_4 = real_min(left / chance_4, float_ONE_MINUS_EPSILON);
        choice.lobe = select(choice.lobe, u32(u32(4)), is_here_4);
        choice.chance = select(choice.chance, chance_4, is_here_4);
        choice.u = select(choice.u, rest_4, is_here_4);
        is_found = is_found | (is_here_4 & (left < chance_4));
        left = select(left, left - chance_4, is_here_4);
    }
    {
        let chance_5 = parts[5];
        let is_here_5 = !is_found & (chance_5 > 0.0f);
        let rest_5 = real_min(left / chance_5, float_ONE_MINUS_EPSILON);
        choice.lobe = select(choice.lobe, u32(u32(5)), is_here_5);
        choice.chance = select(choice.chance, chance_5, is_here_5);
        choice.u = select(choice.u, rest_5, is_here_5);
        is_found = is_found | (is_here_5 & (left < chance_5));
        left = select(left, left - chance_5, is_here_5);
    }
    {
        let chance_6 = parts[6];
        let is_here_6 = !is_found & (chance_6 > 0.0f);
        let rest_6 = real_min(left / chance_6, float_ONE_MINUS_EPSILON);
        choice.lobe = select(choice.lobe, u32(u32(6)), is_here_6);
        choice.chance = select(choice.chance, chance_6, is_here_6);
        choice.u = select(choice.u, rest_6, is_here_6);
        is_found = is_found | (is_here_6 & (left < chance_6));
        left = select(left, left - chance_6, is_here_6);
    }
    return choice;
}

// The density of `wi`, off the horizon.
fn Chances_pdf(this_: Chances, surface: OpenPbr, argument_2: array<vec3f, 2>, mode: u32, directions: u32) -> f32 {
    let wo = argument_2[0];
    let wi = argument_2[1];
    return DensityOf_run(DensityOf(this_, surface, wo, wi, mode, directions));
}

// Light that the glass of a surface scatters from a direction.
struct GlassShares {
    reflected: f32,
    refracted: f32,
    rest: f32,
    through: f32,
}

// Light to `wo` that glass scatters, of which from above this share is seen.
fn OpenPbr_scattered_by_glass(this_: OpenPbr, shares: Shares, rests: Rests, wo: vec3f, seen: f32) -> GlassShares {
    let is_inside = (wo.z < 0.0f) & !this_.stack.is_thin;
    let outside = shares.reflected * SampledSpectrum_average(this_.specular_color);
    let reflects = select(outside, shares.inside.reflected, is_inside);
    let refracts = select(shares.refracted, shares.inside.refracted, is_inside);
    let left = select(shares.glass_rest, shares.inside.left, is_inside);
    let mean_1 = select(rests.glass_above, rests.glass_below, is_inside);
    let passes = select(rests.through_above, rests.through_below, is_inside);
    let left_1 = select(0.0f, left, mean_1 > 0.0f);
    let glass = select(OpenPbr_glass(this_) * seen, OpenPbr_glass(this_), is_inside);
    let tint = glass * SampledSpectrum_average(this_.transmission_color);
    return GlassShares(glass * reflects, tint * refracts, (glass * left_1) * (1.0f - passes), (tint * left_1) * passes);
}

// The density of a direction.
struct DensityOf {
    chances: Chances,
    surface: OpenPbr,
    wo: vec3f,
    wi: vec3f,
    mode: u32,
    directions: u32,
}

fn DensityOf_run(this_: DensityOf) -> f32 {
    let chances = this_.chances;
    let surface = this_.surface;
    let wo = this_.wo;
    let wi = this_.wi;
    let mode = this_.mode;
    let directions = this_.directions;
    let parts = chances.of_;
    let fuzz = parts[0];
    let coat = parts[1];
    let facets = parts[2];
    let glass = parts[3];
    let rest = parts[4];
    let through = parts[5];
    let is_same = same_hemisphere(wo, wi);
    let is_below = wo.z < 0.0f;
    let up = upright(is_below, wo);
    let out = upright(is_below, wi);
    var pdf = 0.0f;
    if (glass > 0.0f) {
        if (surface.stack.is_thin) {
            pdf = select(glass * OpenPbr_pdf_sheet(surface, up, out), 0.0f, is_same);
        } else {
            pdf = select(0.0f, glass * OpenPbr_pdf_glass(surface, wo, wi, directions), glass > 0.0f);
        }
    }
    let cosine = cosine_hemisphere_pdf(abs(wi.z));
    let across = pdf + (through * cosine);
    if (!is_same) {
        return across;
    }
    if (coat > 0.0f) {
        pdf += select(0.0f, coat * OpenPbr_pdf_coat(surface, up, out, mode), coat > 0.0f);
    }
    if (facets > 0.0f) {
        pdf += facets * Mirror_new(surface.stack.base, up, out).pdf;
    }
    let same = (pdf + (rest * cosine)) + (fuzz * uniform_hemisphere_pdf());
    return select(across, same, is_same);
}
