// Translated from crates/scattering/src/bxdf/openpbr/mod.rs
// by `cargo xtask wgsl`, which translates it again.

const openpbr_HORIZON: f32 = 1e-6f;

// A principled surface.
struct OpenPbr {
    table: OpenPbrTable,
    location: array<f32, 12>,
    stack: Stack,
    waves: vec4f,
    metalness: f32,
    transmission: f32,
    metal: Metal,
    diffuse_base: DiffuseBase,
    specular_color: vec4f,
    transmission_color: vec4f,
    subsurface_color: vec4f,
    subsurface_weight: f32,
    interior: Interior,
    part: u32,
    coat_color: vec4f,
    coat_normal: vec3f,
    darkening: vec4f,
    fuzz_color: vec4f,
}

// The base of metal.
struct Metal {
    weight: f32,
    color: vec4f,
    again: vec4f,
}

// The diffuse base.
struct DiffuseBase {
    roughness: f32,
    color: vec4f,
    weight: f32,
    over: vec4f,
    scattered: vec4f,
    forward: f32,
}

// Weights of the lobes that directions on one side of the surface meet.
struct Weights {
    layers: f32,
    metal: f32,
    diffuse: f32,
    under: f32,
    glass: f32,
}

// The surface at the wavelengths of a path, of a material with a table for its numbers.
fn OpenPbr_new(table: OpenPbrTable, p: OpenPbrParameters, lambda: SampledWavelengths) -> OpenPbr {
    let black = SampledSpectrum_zero();
    let white = SampledSpectrum_splat(1.0f);
    let base_color = p.base_color * p.base_weight;
    var surface = OpenPbr(table, OpenPbrTable_locate(table, p), Stack_new(p), black, p.base_metalness, p.transmission_weight, Metal(real_min(p.specular_weight, 1.0f), base_color, black), DiffuseBase(p.base_diffuse_roughness, SampledSpectrum_lerp(base_color, p.subsurface_color, p.subsurface_weight), 1.0f, base_color, black, 0.0f), p.specular_color, p.transmission_color, p.subsurface_color, p.subsurface_weight, interior(p), Part_Whole, p.coat_color, p.geometry_coat_normal, white, p.fuzz_color);
    if (p.geometry_thin_walled) {
        surface.diffuse_base.color = base_color;
        surface.diffuse_base.weight = 1.0f - p.subsurface_weight;
        surface.diffuse_base.scattered = p.subsurface_color * p.subsurface_weight;
        surface.diffuse_base.forward = 0.5f * (1.0f + p.subsurface_scatter_anisotropy);
    }
    let is_filmed = p.thin_film_weight > 0.0f;
    if (is_filmed) {
        let thickness = (1000.0f * p.thin_film_thickness) * p.thin_film_ior;
        for (var i = 0u; i < sampled_N; i++) {
            surface.waves[i] = select(0.0f, thickness / SampledWavelengths_lambda(lambda)[i], is_filmed);
        }
    }
    let is_darkened = (p.coat_weight > 0.0f) & (p.coat_darkening > 0.0f);
    if (is_darkened) {
        let darkened = SampledSpectrum_lerp(white, OpenPbr_darkened(surface), p.coat_weight * p.coat_darkening);
        surface.darkening = SampledSpectrum_select(is_darkened, darkened, white);
    }
    let has_rest = (p.base_metalness > 0.0f) & Stack_spreads(surface.stack);
    if (has_rest) {
        let kept = OpenPbrTable_means(table, surface.location, surface.waves.x).white;
        var again = OpenPbr_mean_metal(surface);
        {
            again[0] = (sqr(again[0]) * kept) / (1.0f - (again[0] * (1.0f - kept)));
        }
        {
            again[1] = (sqr(again[1]) * kept) / (1.0f - (again[1] * (1.0f - kept)));
        }
        {
            again[2] = (sqr(again[2]) * kept) / (1.0f - (again[2] * (1.0f - kept)));
        }
        {
            again[3] = (sqr(again[3]) * kept) / (1.0f - (again[3] * (1.0f - kept)));
        }
        surface.metal.again = SampledSpectrum_select(has_rest, again, black);
    }
    return surface;
}

// The share of light that reflections in the coat leave of an opaque base.
fn OpenPbr_darkened(this_: OpenPbr) -> vec4f {
    let stack = this_.stack;
    let mean_1 = real_max(mean_fresnel(stack.below / stack.above), 0.0f);
    let parts = this_.diffuse_base;
    let color_1 = parts.color;
    let weight_1 = parts.weight;
    let scattered_1 = parts.scattered;
    let diffuse = (color_1 * weight_1) + scattered_1;
    let dielectric = SampledSpectrum_splat(mean_1) + (diffuse * (1.0f - mean_1));
    let outer = mean_fresnel(stack.coat_ior);
    let inner = 1.0f - ((1.0f - outer) / sqr(stack.coat_ior));
    let roughness = lerp(this_.metalness, 1.0f, sqrt(TrowbridgeReitz_mean_alpha(stack.base)));
    let k = lerp(roughness, outer, inner);
    var darkened = SampledSpectrum_lerp(dielectric, this_.metal.color, this_.metalness);
    {
        darkened[0] = (1.0f - k) / (1.0f - (k * darkened[0]));
    }
    {
        darkened[1] = (1.0f - k) / (1.0f - (k * darkened[1]));
    }
    {
        darkened[2] = (1.0f - k) / (1.0f - (k * darkened[2]));
    }
    {
        darkened[3] = (1.0f - k) / (1.0f - (k * darkened[3]));
    }
    return darkened;
}

// Whether the diffuse base is that of a thin wall which transmits light.
fn OpenPbr_transmits_diffusely(this_: OpenPbr) -> bool {
    return (this_.diffuse_base.forward > 0.0f) & !SampledSpectrum_is_black(this_.diffuse_base.scattered);
}

// What the diffuse base reflects of the light that is left for it.
fn OpenPbr_diffuse_albedo(this_: OpenPbr, weights_1: Weights) -> vec4f {
    if (this_.stack.is_thin) {
        let parts = this_.diffuse_base;
        let color_1 = parts.color;
        let weight_1 = parts.weight;
        let scattered_1 = parts.scattered;
        let forward = parts.forward;
        return (color_1 * weight_1) + (scattered_1 * (1.0f - forward));
    }
    let over = this_.diffuse_base.over * (1.0f - weights_1.under);
    return SampledSpectrum_select(weights_1.under > 0.0f, over, this_.diffuse_base.color);
}

// The share of the surface that is glass.
fn OpenPbr_glass(this_: OpenPbr) -> f32 {
    return (1.0f - this_.metalness) * this_.transmission;
}

// The boundary of the base.
fn OpenPbr_boundary(this_: OpenPbr) -> Dielectric {
    return Dielectric(this_.stack.index, this_.stack.base);
}

// What is met from the side of `z`.
fn OpenPbr_weights(this_: OpenPbr, z: f32) -> Weights {
    let glass = OpenPbr_glass(this_);
    let diffuse = (1.0f - this_.metalness) * (1.0f - this_.transmission);
    let whole = (z > 0.0f) | this_.stack.is_thin;
    return Weights(select(1.0f - glass, 1.0f, whole), this_.metalness, diffuse, OpenPbr_share_under(this_, z), select(0.0f, glass, whole));
}

// The index of refraction that light meets from above.
fn OpenPbr_outer_index(this_: OpenPbr) -> f32 {
    if (this_.stack.is_thin) {
        return 1.0f;
    } else {
        return this_.stack.index;
    }
}

// `w` on the side of z > 0 where `below`.
fn upright(below: bool, w: vec3f) -> vec3f {
    return select(w, -w, below);
}

// Of what belongs to `wo` and to `wi` that of the direction from which light is seen.
fn of_viewer(argument_0: vec2f, mode: u32) -> f32 {
    let o = argument_0.x;
    let i = argument_0.y;
    if (mode == TransportMode_Radiance) {
        return o;
    } else {
        return i;
    }
}

// A direction mirrored by the plane of the surface.
fn turned(w: vec3f) -> vec3f {
    return vec3f(w.x, w.y, -w.z);
}

// A sample of the mirror images of a direction above in facets, without its value, and of the
// density only that of a smooth surface.
fn mirrored(facets: TrowbridgeReitz, wo: vec3f, u: vec2f) -> BsdfSample {
    let is_smooth = TrowbridgeReitz_effectively_smooth(facets);
    let turned_1 = vec3f(-wo.x, -wo.y, wo.z);
    let wi = select(fresnel_reflect(wo, TrowbridgeReitz_sample_wm(facets, wo, u)), turned_1, is_smooth);
    let lobe = BxdfFlags_choose(is_smooth, BxdfFlags_SPECULAR_REFLECTION, BxdfFlags_GLOSSY_REFLECTION);
    let rest = BsdfSample_new(SampledSpectrum_zero(), wi, 1.0f, lobe);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, rest.pdf_is_proportional, wi.z > 0.0f);
}

// Whether a direction is off the horizon.
fn is_off_horizon(w: vec3f) -> bool {
    return abs(w.z) > openpbr_HORIZON;
}

// The width of facets.
fn openpbr_width(facets: TrowbridgeReitz) -> u32 {
    return BxdfFlags_choose(TrowbridgeReitz_effectively_smooth(facets), BxdfFlags_SPECULAR, BxdfFlags_GLOSSY);
}

// `flags` where the mask is true, else no scattering.
fn only(mask: bool, flags: u32) -> u32 {
    return BxdfFlags_select(mask, flags, BxdfFlags_splat(BxdfFlags_NONE));
}

fn OpenPbr_flags(this_: OpenPbr) -> u32 {
    if (OpenPbr_is_lobe(this_)) {
        return BxdfFlags_splat(BxdfFlags_DIFFUSE_REFLECTION);
    }
    let weights_1 = OpenPbr_weights(this_, 1.0f);
    let is_glass = OpenPbr_glass(this_) > 0.0f;
    var flags = BxdfFlags_splat(BxdfFlags_REFLECTION) | openpbr_width(this_.stack.base);
    flags |= only(this_.stack.coat_weight > 0.0f, openpbr_width(this_.stack.coat));
    if (this_.stack.is_thin) {
        flags |= only(is_glass, openpbr_width(Stack_sheet(this_.stack)));
    }
    let transmits = is_glass | ((weights_1.diffuse > 0.0f) & OpenPbr_transmits_diffusely(this_));
    flags |= BxdfFlags_only_where(transmits, BxdfFlags_TRANSMISSION);
    flags |= BxdfFlags_only_where(Stack_spreads(this_.stack), BxdfFlags_GLOSSY);
    let over = weights_1.diffuse * (1.0f - weights_1.under);
    let is_diffuse = (over > 0.0f) | (this_.stack.fuzz_weight > 0.0f);
    return flags | BxdfFlags_only_where(is_diffuse, BxdfFlags_DIFFUSE);
}

fn OpenPbr_f(this_: OpenPbr, wo: vec3f, wi: vec3f, mode: u32) -> vec4f {
    return OpenPbrValue_run(OpenPbrValue(this_, wo, wi, mode));
}

fn OpenPbr_sample_f(this_: OpenPbr, wo: vec3f, uc: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    return OpenPbrSample_run(OpenPbrSample(this_, wo, uc, u, mode, directions));
}

fn OpenPbr_pdf(this_: OpenPbr, wo: vec3f, wi: vec3f, mode: u32, directions: u32) -> f32 {
    return OpenPbrDensity_run(OpenPbrDensity(this_, wo, wi, mode, directions));
}

// The layers pass on what they did before: what is wider loses a little.
fn OpenPbr_regularize(this_: ptr<function, OpenPbr>, mask: bool) {
    var base = (*this_).stack.base;
    var coat = (*this_).stack.coat;
    TrowbridgeReitz_regularize(&base, mask);
    TrowbridgeReitz_regularize(&coat, mask);
    let part = base;
    let part_1 = coat;
    (*this_).stack.base = part;
    (*this_).stack.coat = part_1;
}

// The value for two directions.
struct OpenPbrValue {
    surface: OpenPbr,
    wo: vec3f,
    wi: vec3f,
    mode: u32,
}

fn OpenPbrValue_run(this_: OpenPbrValue) -> vec4f {
    let surface = this_.surface;
    let wo = this_.wo;
    let wi = this_.wi;
    let mode = this_.mode;
    let black = SampledSpectrum_zero();
    var valid = is_off_horizon(wo) & is_off_horizon(wi);
    if (OpenPbr_is_lobe(surface)) {
        valid = (valid & (wo.z > 0.0f)) & (wi.z > 0.0f);
    }
    if (!valid) {
        return black;
    }
    if (OpenPbr_is_lobe(surface)) {
        return SampledSpectrum_select(valid, OpenPbr_lobe(surface, wi), black);
    }
    let o = OpenPbr_shares(surface, wo);
    let i = OpenPbr_shares(surface, wi);
    let rests = OpenPbr_rests(surface);
    return SampledSpectrum_select(valid, OpenPbr_value(surface, array<Shares, 2>(o, i), rests, array<vec3f, 2>(wo, wi), mode), black);
}

// The density of a direction.
struct OpenPbrDensity {
    surface: OpenPbr,
    wo: vec3f,
    wi: vec3f,
    mode: u32,
    directions: u32,
}

fn OpenPbrDensity_run(this_: OpenPbrDensity) -> f32 {
    let surface = this_.surface;
    let wo = this_.wo;
    let wi = this_.wi;
    let mode = this_.mode;
    let directions = this_.directions;
    let valid = is_off_horizon(wo) & is_off_horizon(wi);
    if (!valid) {
        return 0.0f;
    }
    if (OpenPbr_is_lobe(surface)) {
        if (directions == Directions_Transmission) {
            return 0.0f;
        }
        let valid_1 = (valid & (wo.z > 0.0f)) & (wi.z > 0.0f);
        return select(0.0f, cosine_hemisphere_pdf(wi.z), valid_1);
    }
    let shares = OpenPbr_shares(surface, wo);
    let rests = OpenPbr_rests(surface);
    let chances = Chances_new(surface, shares, rests, wo, mode, directions);
    return select(0.0f, Chances_pdf(chances, surface, array<vec3f, 2>(wo, wi), mode, directions), valid);
}

// A sample of directions.
struct OpenPbrSample {
    surface: OpenPbr,
    wo: vec3f,
    uc: f32,
    u: vec2f,
    mode: u32,
    directions: u32,
}

fn OpenPbrSample_run(this_: OpenPbrSample) -> BsdfSample {
    let surface = this_.surface;
    let wo = this_.wo;
    let uc = this_.uc;
    let u = this_.u;
    let mode = this_.mode;
    let directions = this_.directions;
    var valid = is_off_horizon(wo);
    if (!valid) {
        return BsdfSample_invalid();
    }
    if (OpenPbr_is_lobe(surface)) {
        let wi = sample_cosine_hemisphere(u);
        valid = (valid & is_off_horizon(wi)) & (wo.z > 0.0f);
        if (directions == Directions_Transmission) {
            return BsdfSample_invalid();
        }
        let lobe = BxdfFlags_splat(BxdfFlags_DIFFUSE_REFLECTION);
        let sample = BsdfSample_new(OpenPbr_lobe(surface, wi), wi, cosine_hemisphere_pdf(wi.z), lobe);
        return BsdfSample(sample.f, sample.wi, sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, valid);
    }
    let shares = OpenPbr_shares(surface, wo);
    let rests = OpenPbr_rests(surface);
    let chances = Chances_new(surface, shares, rests, wo, mode, directions);
    let choice = Chances_choose(chances, uc);
    let sample_1 = OpenPbr_direction(surface, wo, choice, u, mode, directions);
    valid = (valid & (choice.chance > 0.0f)) & sample_1.valid;
    let is_under = choice.lobe == u32(chances_UNDER);
    let is_specular = BxdfFlags_is_specular(sample_1.flags);
    var f = sample_1.f;
    var pdf = sample_1.pdf * choice.chance;
    if (valid & is_specular) {
        let specular = OpenPbr_specular(surface, shares, wo, choice.lobe, sample_1, mode);
        f = SampledSpectrum_select(is_specular, specular, f);
    }
    if (valid & is_under) {
        let under = OpenPbr_goes_under(surface, shares, wo) * 0.31830987f;
        f = SampledSpectrum_select(is_under, under, f);
        pdf = select(pdf, choice.chance * cosine_hemisphere_pdf(abs(sample_1.wi.z)), is_under);
        valid = valid & (!is_under | is_off_horizon(sample_1.wi));
    }
    let is_wide = valid & !(is_specular | is_under);
    if (is_wide) {
        let there = OpenPbr_shares(surface, sample_1.wi);
        let value_1 = OpenPbr_value(surface, array<Shares, 2>(shares, there), rests, array<vec3f, 2>(wo, sample_1.wi), mode);
        f = SampledSpectrum_select(is_wide, value_1, f);
        pdf = select(pdf, Chances_pdf(chances, surface, array<vec3f, 2>(wo, sample_1.wi), mode, directions), is_wide);
        valid = valid & (!is_wide | ((pdf > 0.0f) & is_off_horizon(sample_1.wi)));
    }
    return BsdfSample(f, sample_1.wi, pdf, sample_1.flags, sample_1.eta, sample_1.pdf_is_proportional, valid);
}

// A direction of the lobe that is chosen, without its value, and of the density only that of
// a smooth surface.
fn OpenPbr_direction(this_: OpenPbr, wo: vec3f, choice: ChosenLobe, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    let is_below = wo.z < 0.0f;
    let up = upright(is_below, wo);
    let is_fuzz = choice.lobe == u32(chances_FUZZ);
    let is_coat = choice.lobe == u32(chances_COAT);
    let is_facets = choice.lobe == u32(chances_FACETS);
    let is_glass = choice.lobe == u32(chances_GLASS);
    let is_through = choice.lobe == u32(chances_THROUGH);
    let is_under = choice.lobe == u32(chances_UNDER);
    let is_diffuse = OpenPbr_weights(this_, 1.0f).diffuse > 0.0f;
    let wi = sample_cosine_hemisphere(u);
    let rest = BxdfFlags_choose(is_diffuse, BxdfFlags_DIFFUSE_REFLECTION, BxdfFlags_GLOSSY_REFLECTION);
    var sample = BsdfSample_new(SampledSpectrum_zero(), wi, 1.0f, rest);
    if (is_fuzz) {
        sample.wi = select(sample.wi, sample_uniform_hemisphere(u), is_fuzz);
        let lobe = BxdfFlags_splat(BxdfFlags_DIFFUSE_REFLECTION);
        sample.flags = BxdfFlags_select(is_fuzz, lobe, sample.flags);
    }
    if (is_through | is_under) {
        let is_diffuse_1 = is_under | (is_diffuse & OpenPbr_transmits_diffusely(this_));
        let lobe_1 = BxdfFlags_choose(is_diffuse_1, BxdfFlags_DIFFUSE_TRANSMISSION, BxdfFlags_GLOSSY_TRANSMISSION);
        let index = OpenPbr_outer_index(this_);
        let met = select(index, 1.0f / index, is_below);
        sample.wi = select(sample.wi, -wi, is_through | is_under);
        sample.flags = BxdfFlags_select(is_through | is_under, lobe_1, sample.flags);
        sample.eta = select(sample.eta, met, is_through);
    }
    if (is_coat) {
        sample = BsdfSample_select(is_coat, OpenPbr_sample_coat(this_, up, choice.u, u, mode), sample);
    }
    if (is_facets) {
        sample = BsdfSample_select(is_facets, mirrored(this_.stack.base, up, u), sample);
    }
    if (is_glass) {
        if (this_.stack.is_thin) {
            sample = BsdfSample_select(is_glass, OpenPbr_sample_sheet(this_, up, u), sample);
        } else {
            let glass = OpenPbr_sample_glass(this_, wo, choice.u, u, directions);
            let wi_1 = upright(is_below, glass.wi);
            sample = BsdfSample_select(is_glass, BsdfSample(glass.f, wi_1, glass.pdf, glass.flags, glass.eta, glass.pdf_is_proportional, glass.valid), sample);
        }
    }
    let rest_1 = sample;
    return BsdfSample(rest_1.f, upright(is_below, sample.wi), rest_1.pdf, rest_1.flags, rest_1.eta, rest_1.pdf_is_proportional, rest_1.valid);
}
