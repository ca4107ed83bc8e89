// Translated from crates/scattering/src/bxdf/openpbr/glass.rs
// by `cargo xtask wgsl`, which translates it again.

// The reflectance of facets of glass from inside: what the base reflects, and what the layers
// outside do of the rest. Beyond the critical angle all light is reflected.
fn OpenPbr_inner_reflectance(this_: OpenPbr, cosine: f32) -> vec4f {
    return InnerReflectance_run(InnerReflectance(this_, cosine));
}

// The probability that a sample of glass with facets of normal `wm` is reflected.
fn OpenPbr_reflects(this_: OpenPbr, wo: vec3f, wm: vec3f, directions: u32) -> f32 {
    if (directions == Directions_Reflection) {
        return 1.0f;
    } else if (directions == Directions_Transmission) {
        return 0.0f;
    } else {
        let cosine = abs(Vec3_dot(wo, wm));
        let outside = SampledSpectrum_average(Stack_dielectrics(this_.stack, cosine, this_.waves));
        let is_below = !(wo.z > 0.0f);
        if (!is_below) {
            return outside;
        }
        return select(outside, SampledSpectrum_average(OpenPbr_inner_reflectance(this_, cosine)), is_below);
    }
}

// A direction sampled by the facets of glass, without its value, and of the density only that
// of a smooth surface.
fn OpenPbr_sample_glass(this_: OpenPbr, wo: vec3f, uc: f32, u: vec2f, directions: u32) -> BsdfSample {
    let is_smooth = TrowbridgeReitz_effectively_smooth(this_.stack.base);
    let wm = TrowbridgeReitz_sample_wm(this_.stack.base, wo, u);
    let wm_1 = select(wm, Vec3_Z, is_smooth);
    let share_1 = OpenPbr_reflects(this_, wo, wm_1, directions);
    let reflects = uc < share_1;
    let parts = fresnel_refract(wo, wm_1, this_.stack.index);
    let refracted = parts.v0;
    let eta = parts.v1;
    let is_refracted = parts.v2;
    let wi = select(refracted, fresnel_reflect(wo, wm_1), reflects);
    let on_its_side = !(same_hemisphere(wo, wi) != reflects) & (wi.z != 0.0f);
    let width_1 = BxdfFlags_choose(is_smooth, BxdfFlags_SPECULAR, BxdfFlags_GLOSSY);
    let side = BxdfFlags_choose(reflects, BxdfFlags_REFLECTION, BxdfFlags_TRANSMISSION);
    let pdf = select(1.0f - share_1, share_1, reflects);
    let sample = BsdfSample_new(SampledSpectrum_zero(), wi, pdf, width_1 | side);
    let valid = (reflects | is_refracted) & on_its_side;
    return BsdfSample(sample.f, sample.wi, sample.pdf, sample.flags, select(eta, 1.0f, reflects), sample.pdf_is_proportional, valid);
}

// The density of [`Self::sample_glass`].
fn OpenPbr_pdf_glass(this_: OpenPbr, wo: vec3f, wi: vec3f, directions: u32) -> f32 {
    let boundary = OpenPbr_boundary(this_);
    let parts = Dielectric_facet(boundary, wo, wi);
    let facet = parts.v0;
    let is_met = parts.v1;
    if (!is_met) {
        return 0.0f;
    }
    let is_reflected = same_hemisphere(wo, wi);
    let share_1 = OpenPbr_reflects(this_, wo, facet.wm, directions);
    let chance = select(1.0f - share_1, share_1, is_reflected);
    let side = select(0.0f, 1.0f, is_reflected);
    return select(0.0f, chance * Dielectric_pdf_facet(boundary, wo, wi, facet, side), is_met);
}

// The value of glass for two directions below.
fn OpenPbr_reflected_inside(this_: OpenPbr, shares: array<Shares, 2>, rests: Rests, wo: vec3f, wi: vec3f) -> vec4f {
    let boundary = OpenPbr_boundary(this_);
    let parts = Dielectric_facet(boundary, wo, wi);
    let facet = parts.v0;
    let is_met = parts.v1;
    var f = SampledSpectrum_zero();
    if (is_met) {
        let white = Dielectric_f_facet(boundary, wo, wi, facet, 1.0f, TransportMode_Radiance);
        let white_1 = select(0.0f, white, is_met);
        f += OpenPbr_inner_reflectance(this_, abs(Vec3_dot(wo, facet.wm))) * white_1;
    }
    let has_rest = rests.glass_below > 0.0f;
    if (has_rest) {
        let left = shares[0].inside.left * shares[1].inside.left;
        let again = (left / (3.1415927f * rests.glass_below)) * (1.0f - rests.through_below);
        f += SampledSpectrum_splat(select(0.0f, again, has_rest));
    }
    return f * OpenPbr_glass(this_);
}

// The value of glass for directions on both sides.
fn OpenPbr_transmitted(this_: OpenPbr, shares: array<Shares, 2>, rests: Rests, argument_3: array<vec3f, 2>, mode: u32) -> vec4f {
    let wo = argument_3[0];
    let wi = argument_3[1];
    let is_above_1 = wo.z > 0.0f;
    let outside = select(wi, wo, is_above_1);
    let o = shares[0];
    let i = shares[1];
    let boundary = OpenPbr_boundary(this_);
    let parts = Dielectric_facet(boundary, wo, wi);
    let facet = parts.v0;
    let is_met = parts.v1;
    var f = SampledSpectrum_zero();
    if (is_met) {
        let outer = abs(Vec3_dot(outside, facet.wm));
        var white = Dielectric_f_facet(boundary, wo, wi, facet, 0.0f, mode);
        let has_layers = Stack_has_layers(this_.stack);
        if (has_layers) {
            let below_coat = select(i.taken.below_coat, o.taken.below_coat, is_above_1);
            let passed = real_min(below_coat, OpenPbr_passed(this_, outer));
            white = select(white, white * passed, has_layers);
        }
        let white_1 = select(0.0f, white, is_met);
        let reflected = Stack_dielectrics(this_.stack, outer, this_.waves);
        f += (SampledSpectrum_splat(1.0f) - reflected) * white_1;
    }
    let has_rest = rests.glass_below > 0.0f;
    if (has_rest) {
        let above = select(i.glass_rest, o.glass_rest, is_above_1);
        let below = select(o.inside.left, i.inside.left, is_above_1);
        let down = ((above * below) * rests.through_above) / (3.1415927f * rests.glass_below);
        let scale_1 = 1.0f / sqr(this_.stack.index);
        var chosen: f32;
        if (mode == TransportMode_Radiance) {
            chosen = select(1.0f, scale_1, is_above_1);
        } else {
            chosen = select(scale_1, 1.0f, is_above_1);
        }
        let scale_2 = chosen;
        f += SampledSpectrum_splat(select(0.0f, down * scale_2, has_rest));
    }
    let is_outside = of_viewer(vec2f(wo.z, wi.z), mode) > 0.0f;
    let seen = select(1.0f, of_viewer(vec2f(o.seen, i.seen), mode), is_outside);
    return ((f * this_.transmission_color) * OpenPbr_absorbed(this_, OpenPbr_coat_length(this_, outside.z))) * (OpenPbr_glass(this_) * seen);
}

// The reflectance of glass from inside.
struct InnerReflectance {
    surface: OpenPbr,
    cosine: f32,
}

fn InnerReflectance_run(this_: InnerReflectance) -> vec4f {
    let surface = this_.surface;
    let cosine = this_.cosine;
    let one = SampledSpectrum_splat(1.0f);
    let squared = 1.0f - ((1.0f - sqr(cosine)) * sqr(surface.stack.index));
    let outer = sqrt(real_max(squared, 0.0f));
    var reflected = Stack_dielectrics(surface.stack, outer, surface.waves);
    let has_layers = Stack_has_layers(surface.stack);
    if (has_layers) {
        let kept = 1.0f - OpenPbr_passed(surface, outer);
        let with_layers = reflected + ((one - reflected) * kept);
        reflected = SampledSpectrum_select(has_layers, with_layers, reflected);
    }
    return SampledSpectrum_select(squared > 0.0f, reflected, one);
}
