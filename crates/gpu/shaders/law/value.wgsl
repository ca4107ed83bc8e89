// Translated from crates/scattering/src/bxdf/openpbr/value.rs
// by `cargo xtask wgsl`, which translates it again.

// Absorption in the coat on paths of these lengths, in units of its thickness.
fn OpenPbr_absorbed(this_: OpenPbr, lengths: f32) -> vec4f {
    let one = SampledSpectrum_splat(1.0f);
    let is_clear = SampledSpectrum_is_black(this_.coat_color - one);
    let absorbs = (this_.stack.coat_weight > 0.0f) & !is_clear;
    if (!absorbs) {
        return one;
    }
    let passed = Absorption_run(Absorption(this_.coat_color, lengths));
    return SampledSpectrum_select(absorbs, SampledSpectrum_lerp(one, passed, this_.stack.coat_weight), one);
}

// The length of a path through the coat.
fn OpenPbr_coat_length(this_: OpenPbr, cosine: f32) -> f32 {
    let squared = 1.0f - ((1.0f - sqr(cosine)) / sqr(this_.stack.coat_ior));
    return 1.0f / real_max(sqrt(squared), 1e-3f);
}

// The reflectance of the facets of the base met from above at a cosine.
fn OpenPbr_reflectance(this_: OpenPbr, cosine: f32, weights_1: Weights) -> vec4f {
    var reflected = SampledSpectrum_zero();
    var glass = weights_1.glass;
    if (this_.stack.is_thin) {
        if (glass > 0.0f) {
            let parts = OpenPbr_sheet_shares(this_, cosine);
            let sheet = parts[0];
            reflected += (sheet * this_.specular_color) * glass;
        }
        glass = 0.0f;
    }
    if (weights_1.metal > 0.0f) {
        reflected += (OpenPbr_metal(this_, cosine) * this_.darkening) * weights_1.metal;
    }
    if ((weights_1.diffuse + glass) > 0.0f) {
        let dielectric = Stack_dielectrics(this_.stack, cosine, this_.waves) * this_.specular_color;
        reflected += dielectric * ((this_.darkening * weights_1.diffuse) + SampledSpectrum_splat(glass));
    }
    return reflected;
}

// The value for two directions above of what `weights` say.
fn OpenPbr_reflected(this_: OpenPbr, argument_1: array<Shares, 2>, rests: Rests, argument_3: array<vec3f, 2>, mode: u32, weights_1: Weights) -> vec4f {
    let o = argument_1[0];
    let i = argument_1[1];
    let wo = argument_3[0];
    let wi = argument_3[1];
    let black = SampledSpectrum_zero();
    var f = black;
    let has_fuzz = this_.stack.fuzz_weight > 0.0f;
    if (has_fuzz) {
        let fuzz = OpenPbr_fuzz(this_, array<Shares, 2>(o, i), rests, array<vec3f, 2>(wo, wi), weights_1);
        f += SampledSpectrum_select(has_fuzz, fuzz, black);
    }
    let is_coated = this_.stack.coat_weight > 0.0f;
    if (is_coated) {
        var below_fuzz = real_min(Shares_below_fuzz(o), Shares_below_fuzz(i));
        let is_tilted = OpenPbr_is_tilted(this_);
        if (is_tilted) {
            let seen = of_viewer(vec2f(Shares_below_fuzz(o), Shares_below_fuzz(i)), mode);
            below_fuzz = select(below_fuzz, seen, is_tilted);
        }
        let coat = OpenPbr_coat(this_, wo, wi, mode) * below_fuzz;
        let coat_1 = (coat * this_.stack.coat_weight) * weights_1.layers;
        f += SampledSpectrum_splat(select(0.0f, coat_1, is_coated));
    }
    let mirror = Mirror_new(this_.stack.base, wo, wi);
    let white = mirror.f * real_min(o.taken.below_coat, i.taken.below_coat);
    var base = black;
    if (white > 0.0f) {
        base += OpenPbr_reflectance(this_, mirror.cosine, weights_1) * white;
    }
    if (weights_1.diffuse > 0.0f) {
        base += OpenPbr_diffuse(this_, array<Shares, 2>(o, i), rests, array<vec3f, 2>(wo, wi), weights_1);
    }
    let has_metal_rest = (weights_1.metal > 0.0f) & (rests.metal > 0.0f);
    if (has_metal_rest) {
        let left = (Shares_metal_rest(o) * Shares_metal_rest(i)) / (3.1415927f * rests.metal);
        let left_1 = select(0.0f, left * weights_1.metal, has_metal_rest);
        base += (this_.metal.again * this_.darkening) * left_1;
    }
    let has_glass_rest = (weights_1.glass > 0.0f) & (rests.glass_above > 0.0f);
    if (has_glass_rest) {
        let left_2 = (o.glass_rest * i.glass_rest) / (3.1415927f * rests.glass_above);
        let again = (left_2 * (1.0f - rests.through_above)) * weights_1.glass;
        base += SampledSpectrum_splat(select(0.0f, again, has_glass_rest));
    }
    let seen_1 = of_viewer(vec2f(o.seen, i.seen), mode);
    return f + ((base * OpenPbr_absorbed(this_, OpenPbr_coat_length(this_, wo.z) + OpenPbr_coat_length(this_, wi.z))) * seen_1);
}

// The value of the fibres.
fn OpenPbr_fuzz(this_: OpenPbr, argument_1: array<Shares, 2>, rests: Rests, directions: array<vec3f, 2>, weights_1: Weights) -> vec4f {
    let o = argument_1[0];
    let i = argument_1[1];
    let more_0 = o.taken.fuzz_more;
    let more_1 = i.taken.fuzz_more;
    let fuzz = value(this_.fuzz_color, this_.stack.fuzz_roughness, rests.fuzz, directions, vec2f(more_0, more_1));
    return fuzz * (this_.stack.fuzz_weight * weights_1.layers);
}

// The value of the diffuse base, below the coat.
fn OpenPbr_diffuse(this_: OpenPbr, argument_1: array<Shares, 2>, rests: Rests, argument_3: array<vec3f, 2>, weights_1: Weights) -> vec4f {
    let o = argument_1[0];
    let i = argument_1[1];
    let wo = argument_3[0];
    let wi = argument_3[1];
    let left = SampledSpectrum_safe_div(o.diffuse_rest * i.diffuse_rest, rests.diffuse);
    let goes_under = weights_1.under > 0.0f;
    let color_1 = SampledSpectrum_select(goes_under, this_.diffuse_base.over, this_.diffuse_base.color);
    let over = 1.0f - weights_1.under;
    var diffuse = oren_nayar(color_1, this_.diffuse_base.roughness, wo, wi) * over;
    if (this_.stack.is_thin) {
        let reflected = OpenPbr_scattered(this_, 1.0f - this_.diffuse_base.forward, wo, wi);
        diffuse = (diffuse * this_.diffuse_base.weight) + reflected;
    }
    return ((diffuse * left) * this_.darkening) * weights_1.diffuse;
}

// The value for two directions off the horizon, of which `shares` are.
fn OpenPbr_value(this_: OpenPbr, shares: array<Shares, 2>, rests: Rests, directions: array<vec3f, 2>, mode: u32) -> vec4f {
    return ValueOf_run(ValueOf(this_, shares, rests, directions, mode));
}

// The value of the lobe that a specular sample has chosen.
fn OpenPbr_specular(this_: OpenPbr, shares: Shares, wo: vec3f, lobe: u32, sample: BsdfSample, mode: u32) -> vec4f {
    let wi = sample.wi;
    let is_coat = lobe == u32(chances_COAT);
    let is_glass = lobe == u32(chances_GLASS);
    var value_1 = OpenPbr_specular_base(this_, shares, wo, is_glass, sample);
    var seen = shares.seen;
    var below_fuzz = Shares_below_fuzz(shares);
    let is_tilted = OpenPbr_is_tilted(this_);
    if ((mode == TransportMode_Importance) && is_tilted) {
        let there = OpenPbr_shares(this_, wi);
        seen = there.seen;
        below_fuzz = select(below_fuzz, Shares_below_fuzz(there), is_tilted);
    }
    if (!this_.stack.is_thin) {
        let is_inside = is_glass & (of_viewer(vec2f(wo.z, wi.z), mode) < 0.0f);
        seen = select(seen, 1.0f, is_inside);
    }
    value_1 *= seen;
    if (is_coat) {
        let is_above_1 = wo.z > 0.0f;
        let up = upright(!is_above_1, wo);
        let out = upright(!is_above_1, wi);
        let coat = OpenPbr_specular_coat(this_, up, out, mode) * below_fuzz;
        let layers = OpenPbr_weights(this_, wo.z).layers;
        let coat_1 = SampledSpectrum_splat((coat * this_.stack.coat_weight) * layers);
        value_1 = SampledSpectrum_select(is_coat, coat_1, value_1);
    }
    var chosen: f32;
    if (mode == TransportMode_Radiance) {
        chosen = 1.0f / sqr(sample.eta);
    } else {
        chosen = 1.0f;
    }
    let scale_1 = chosen;
    return value_1 * (scale_1 / abs(wi.z));
}

// The share of light that the smooth base, below the layers, reflects or, where a sample is of
// the lobe of glass, scatters into its direction.
fn OpenPbr_specular_base(this_: OpenPbr, shares: Shares, wo: vec3f, is_glass: bool, sample: BsdfSample) -> vec4f {
    let cosine = abs(wo.z);
    let parts = OpenPbr_weights(this_, wo.z);
    let layers = parts.layers;
    let metal = parts.metal;
    let diffuse = parts.diffuse;
    let under = parts.under;
    let glass = parts.glass;
    var glass_here = glass;
    if (!this_.stack.is_thin) {
        glass_here = select(0.0f, glass, is_glass);
    }
    let here = Weights(layers, select(metal, 0.0f, is_glass), select(diffuse, 0.0f, is_glass), under, glass_here);
    let tint = OpenPbr_absorbed(this_, 2.0f * OpenPbr_coat_length(this_, cosine));
    var value_1 = OpenPbr_reflectance(this_, cosine, here) * (tint * shares.taken.below_coat);
    if (is_glass) {
        if (this_.stack.is_thin) {
            let parts_1 = OpenPbr_sheet_shares(this_, cosine);
            let passed = parts_1[1];
            let through = (passed * tint) * (shares.taken.below_coat * OpenPbr_glass(this_));
            value_1 = SampledSpectrum_select(is_glass, through, value_1);
        } else {
            let is_inside = is_glass & !(wo.z > 0.0f);
            if (is_inside) {
                let inside = OpenPbr_inner_reflectance(this_, cosine) * OpenPbr_glass(this_);
                value_1 = SampledSpectrum_select(is_inside, inside, value_1);
            }
            let is_refracted = is_glass & BxdfFlags_is_transmissive(sample.flags);
            if (is_refracted) {
                let refracted = OpenPbr_refracted(this_, shares, wo, sample.wi);
                value_1 = SampledSpectrum_select(is_refracted, refracted, value_1);
            }
        }
    }
    return value_1;
}

// The share of light that smooth glass refracts from one direction into another.
fn OpenPbr_refracted(this_: OpenPbr, shares: Shares, wo: vec3f, wi: vec3f) -> vec4f {
    let is_above_1 = wo.z > 0.0f;
    let outside = select(wi.z, wo.z, is_above_1);
    let reflected = Stack_dielectrics(this_.stack, outside, this_.waves);
    let tint = this_.transmission_color * OpenPbr_absorbed(this_, OpenPbr_coat_length(this_, outside));
    var passed = shares.taken.below_coat;
    if (!is_above_1) {
        passed = select(OpenPbr_passed(this_, outside), passed, is_above_1);
    }
    return ((SampledSpectrum_splat(1.0f) - reflected) * tint) * (passed * OpenPbr_glass(this_));
}

// Light that is left after ways through the coat.
struct Absorption {
    color: vec4f,
    lengths: f32,
}

fn Absorption_run(this_: Absorption) -> vec4f {
    var passed = this_.color;
    for (var i = 0u; i < sampled_N; i++) {
        passed[i] = power_pow(passed[i], 0.5f * this_.lengths);
    }
    return passed;
}

// The value for two directions off the horizon.
struct ValueOf {
    surface: OpenPbr,
    shares: array<Shares, 2>,
    rests: Rests,
    directions: array<vec3f, 2>,
    mode: u32,
}

fn ValueOf_run(this_: ValueOf) -> vec4f {
    let surface = this_.surface;
    let shares = this_.shares;
    let rests = this_.rests;
    let directions = this_.directions;
    let mode = this_.mode;
    let wo = directions[0];
    let wi = directions[1];
    let black = SampledSpectrum_zero();
    let is_below = wo.z < 0.0f;
    let is_same = same_hemisphere(wo, wi);
    let up_0 = upright(is_below, wo);
    let up_1 = upright(is_below, wi);
    let glass = OpenPbr_glass(surface);
    let is_glass = glass > 0.0f;
    var f = black;
    if (surface.stack.is_thin) {
        if (is_same) {
            f = OpenPbr_reflected(surface, shares, rests, array<vec3f, 2>(up_0, up_1), mode, OpenPbr_weights(surface, 1.0f));
        }
        if (!is_same) {
            let through = OpenPbr_passed_through(surface, shares, rests, array<vec3f, 2>(up_0, up_1), mode);
            f = SampledSpectrum_select(is_same, f, through);
        }
        return f;
    }
    let reflects = is_same & (!is_below | (glass < 1.0f));
    if (reflects) {
        let reflected = OpenPbr_reflected(surface, shares, rests, array<vec3f, 2>(up_0, up_1), mode, OpenPbr_weights(surface, wo.z));
        f = SampledSpectrum_select(reflects, reflected, black);
    }
    let reflects_inside = (is_same & is_below) & is_glass;
    if (reflects_inside) {
        let inside = OpenPbr_reflected_inside(surface, shares, rests, wo, wi);
        f += SampledSpectrum_select(reflects_inside, inside, black);
    }
    let transmits = !is_same & is_glass;
    if (transmits) {
        let through_1 = OpenPbr_transmitted(surface, shares, rests, array<vec3f, 2>(wo, wi), mode);
        f = SampledSpectrum_select(transmits, through_1, f);
    }
    return f;
}
