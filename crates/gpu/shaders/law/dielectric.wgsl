// Translated from crates/scattering/src/bxdf/dielectric.rs
// by `cargo xtask wgsl`, which translates it again.

// An interface between dielectrics.
struct Dielectric {
    eta: f32,
    distribution: TrowbridgeReitz,
}

// What turns `wo` into `wi`: microfacets of normal `wm` in the upper hemisphere.
struct Facet {
    wm: vec3f,
    reflects: bool,
    eta: f32,
}

fn Dielectric_is_specular(this_: Dielectric) -> bool {
    return (this_.eta == 1.0f) | TrowbridgeReitz_effectively_smooth(this_.distribution);
}

// The facets that turn `wo` into `wi`, and where there are any that are not those of a smooth
// surface and both directions are on their front side.
fn Dielectric_facet(this_: Dielectric, wo: vec3f, wi: vec3f) -> Tuple_Facet_bool {
    let reflects = same_hemisphere(wo, wi);
    let eta = select(1.0f / this_.eta, this_.eta, wo.z > 0.0f);
    let eta_1 = select(eta, 1.0f, reflects);
    let parts = Vec3_normalize_masked((wi * eta_1) + wo);
    let wm = parts.v0;
    let valid = parts.v1;
    let wm_1 = select(wm, -wm, wm.z < 0.0f);
    let valid_1 = ((valid & faces(wm_1, wo)) & faces(wm_1, wi)) & !Dielectric_is_specular(this_);
    return Tuple_Facet_bool(Facet(wm_1, reflects, eta_1), valid_1);
}

// The value at `facet`, which reflects the share `fresnel`.
fn Dielectric_f_facet(this_: Dielectric, wo: vec3f, wi: vec3f, facet: Facet, fresnel: f32, mode: u32) -> f32 {
    let wm = facet.wm;
    let reflects = facet.reflects;
    let eta = facet.eta;
    let facets = (TrowbridgeReitz_d(this_.distribution, wm) * TrowbridgeReitz_g(this_.distribution, wo, wi)) / abs(wi.z * wo.z);
    let fr = (0.25f * facets) * fresnel;
    if (reflects) {
        return fr;
    }
    let cos_i = Vec3_dot(wi, wm);
    let cos_o = Vec3_dot(wo, wm);
    let ft = ((facets * (1.0f - fresnel)) * abs(cos_i * cos_o)) / sqr(cos_i + (cos_o / eta));
    var chosen: f32;
    if (mode == TransportMode_Radiance) {
        chosen = ft / sqr(eta);
    } else {
        chosen = ft;
    }
    let ft_1 = chosen;
    return select(ft_1, fr, reflects);
}

// The density of `wi` where `facet` is sampled and reflects with probability `pr`.
fn Dielectric_pdf_facet(this_: Dielectric, wo: vec3f, wi: vec3f, facet: Facet, pr: f32) -> f32 {
    let wm = facet.wm;
    let reflects = facet.reflects;
    let eta = facet.eta;
    let pdf_wm = TrowbridgeReitz_pdf(this_.distribution, wo, wm);
    let reflection = (pr * pdf_wm) / (4.0f * abs(Vec3_dot(wo, wm)));
    if (reflects) {
        return reflection;
    }
    let cos_i = Vec3_dot(wi, wm);
    let cos_o = Vec3_dot(wo, wm);
    let refraction = (((1.0f - pr) * pdf_wm) * abs(cos_i)) / sqr(cos_i + (cos_o / eta));
    return select(refraction, reflection, reflects);
}

fn Dielectric_sample_specular(this_: Dielectric, wo: vec3f, uc: f32, mode: u32, directions: u32) -> BsdfSample {
    let fresnel = fr_dielectric(wo.z, this_.eta);
    let fresnel_1 = select(fresnel, 0.0f, this_.eta == 1.0f);
    let parts = Directions_probability_of_reflection(directions, fresnel_1, 1.0f - fresnel_1);
    let pr = parts.v0;
    let valid = parts.v1;
    let reflects = uc < pr;
    let mirrored_1 = vec3f(-wo.x, -wo.y, wo.z);
    let parts_1 = fresnel_refract(wo, Vec3_Z, this_.eta);
    let refracted = parts_1.v0;
    let eta = parts_1.v1;
    let not_total = parts_1.v2;
    let wi = select(refracted, mirrored_1, reflects);
    var chosen: f32;
    if (mode == TransportMode_Radiance) {
        chosen = 1.0f / sqr(eta);
    } else {
        chosen = 1.0f;
    }
    let scale_1 = chosen;
    let share_1 = select(scale_1 * (1.0f - fresnel_1), fresnel_1, reflects);
    let lobe = BxdfFlags_choose(reflects, BxdfFlags_SPECULAR_REFLECTION, BxdfFlags_SPECULAR_TRANSMISSION);
    let f = SampledSpectrum_splat(share_1 / abs(wi.z));
    let pdf = select(1.0f - pr, pr, reflects);
    let eta_1 = select(eta, 1.0f, reflects);
    let rest = BsdfSample_new(f, wi, pdf, lobe);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, eta_1, rest.pdf_is_proportional, valid & (reflects | not_total));
}

fn Dielectric_sample_glossy(this_: Dielectric, wo: vec3f, uc: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    let wm = TrowbridgeReitz_sample_wm(this_.distribution, wo, u);
    let fresnel = fr_dielectric(Vec3_dot(wo, wm), this_.eta);
    let parts = Directions_probability_of_reflection(directions, fresnel, 1.0f - fresnel);
    let pr = parts.v0;
    let valid = parts.v1;
    let reflects = uc < pr;
    let parts_1 = fresnel_refract(wo, wm, this_.eta);
    let refracted = parts_1.v0;
    let eta = parts_1.v1;
    let not_total = parts_1.v2;
    let wi = select(refracted, fresnel_reflect(wo, wm), reflects);
    let eta_1 = select(eta, 1.0f, reflects);
    let on_its_side = !(same_hemisphere(wo, wi) != reflects) & (wi.z != 0.0f);
    let valid_1 = (valid & (reflects | not_total)) & on_its_side;
    if (!valid_1) {
        return BsdfSample_invalid();
    }
    let facet = Facet(wm, reflects, eta_1);
    let f = SampledSpectrum_splat(Dielectric_f_facet(this_, wo, wi, facet, fresnel, mode));
    let pdf = Dielectric_pdf_facet(this_, wo, wi, facet, pr);
    let lobe = BxdfFlags_choose(reflects, BxdfFlags_GLOSSY_REFLECTION, BxdfFlags_GLOSSY_TRANSMISSION);
    let rest = BsdfSample_new(f, wi, pdf, lobe);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, eta_1, rest.pdf_is_proportional, valid_1);
}

fn Dielectric_flags(this_: Dielectric) -> u32 {
    let width_1 = BxdfFlags_choose(Dielectric_is_specular(this_), BxdfFlags_SPECULAR_TRANSMISSION, BxdfFlags_GLOSSY_TRANSMISSION);
    return width_1 | BxdfFlags_only_where(this_.eta != 1.0f, BxdfFlags_REFLECTION);
}

fn Dielectric_f(this_: Dielectric, wo: vec3f, wi: vec3f, mode: u32) -> vec4f {
    let parts = Dielectric_facet(this_, wo, wi);
    let facet = parts.v0;
    let valid = parts.v1;
    if (!valid) {
        return SampledSpectrum_zero();
    }
    let fresnel = fr_dielectric(Vec3_dot(wo, facet.wm), this_.eta);
    let f = Dielectric_f_facet(this_, wo, wi, facet, fresnel, mode);
    return SampledSpectrum_splat(select(0.0f, f, valid));
}

fn Dielectric_sample_f(this_: Dielectric, wo: vec3f, uc: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    let specular = Dielectric_is_specular(this_);
    var chosen_1: BsdfSample;
    if (specular) {
        chosen_1 = Dielectric_sample_specular(this_, wo, uc, mode, directions);
    } else {
        let glossy = Dielectric_sample_glossy(this_, wo, uc, u, mode, directions);
        var chosen: BsdfSample;
        if (specular) {
            chosen = BsdfSample_select(specular, Dielectric_sample_specular(this_, wo, uc, mode, directions), glossy);
        } else {
            chosen = glossy;
        }
        chosen_1 = chosen;
    }
    let sample = chosen_1;
    return BsdfSample(sample.f, sample.wi, sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, sample.valid & (wo.z != 0.0f));
}

fn Dielectric_pdf(this_: Dielectric, wo: vec3f, wi: vec3f, unused_3: u32, directions: u32) -> f32 {
    let parts = Dielectric_facet(this_, wo, wi);
    let facet = parts.v0;
    let valid = parts.v1;
    if (!valid) {
        return 0.0f;
    }
    let fresnel = fr_dielectric(Vec3_dot(wo, facet.wm), this_.eta);
    let parts_1 = Directions_probability_of_reflection(directions, fresnel, 1.0f - fresnel);
    let pr = parts_1.v0;
    let scatters = parts_1.v1;
    return select(0.0f, Dielectric_pdf_facet(this_, wo, wi, facet, pr), valid & scatters);
}

// Whether `w` lies on the same side of a microfacet as of the surface.
fn faces(wm: vec3f, w: vec3f) -> bool {
    return (w.z != 0.0f) & ((Vec3_dot(wm, w) * w.z) >= 0.0f);
}
