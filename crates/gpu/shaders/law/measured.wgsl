// Translated from crates/scattering/src/bxdf/measured/mod.rs
// by `cargo xtask wgsl`, which translates it again.

// Scattering by a measured surface.
struct Measured {
    table: MeasuredTable,
    lambda: SampledWavelengths,
}

// The material of a table at four wavelengths.
fn Measured_new(table: MeasuredTable, lambda: SampledWavelengths) -> Measured {
    return Measured(table, lambda);
}

// The side of `wo` as the upper one.
fn Measured_outgoing(this_: Measured, wo: vec3f) -> OutgoingDirection {
    let w = select(wo, -wo, wo.z < 0.0f);
    let theta = spherical_theta(w);
    let phi = arc_atan2(w.y, w.x);
    var chosen: f32;
    if (MeasuredTable_is_isotropic(this_.table)) {
        chosen = phi;
    } else {
        chosen = 0.0f;
    }
    let turn_1 = chosen;
    return OutgoingDirection(w, in_square(theta, phi), turn_1, MeasuredTable_between(this_.table, phi, theta));
}

// The normal of microfacets that turn a direction into `wi`, on its side.
fn Measured_microfacet(this_: Measured, outgoing: OutgoingDirection, wo: vec3f, wi: vec3f) -> Microfacet {
    let parts = Vec3_normalize_masked(wo + wi);
    let wm = parts.v0;
    let is_some = parts.v1;
    let wm_1 = select(wm, -wm, wm.z < 0.0f);
    let at = in_square(spherical_theta(wm_1), arc_atan2(wm_1.y, wm_1.x) - outgoing.turn);
    let at_1 = vec2f(at.x, at.y - floor(at.y));
    let exists = is_some & same_hemisphere(wo, wi);
    return Microfacet(at_1, Vec3_dot(outgoing.w, wm_1), sqrt(sqr(wm_1.x) + sqr(wm_1.y)), exists);
}

// The direction of light that leaves.
struct OutgoingDirection {
    w: vec3f,
    at: vec2f,
    turn: f32,
    between: LayerWeights,
}

// A microfacet normal.
struct Microfacet {
    at: vec2f,
    cosine: f32,
    sin_theta: f32,
    exists: bool,
}

// The point of the square of a direction.
fn in_square(theta: f32, phi: f32) -> vec2f {
    let x = real_min(sqrt(theta * (1.0f / 1.5707964f)), 1.0f);
    return vec2f(x, (phi * (1.0f / 6.2831855f)) + 0.5f);
}

fn Measured_flags(this_: Measured) -> u32 {
    return BxdfFlags_splat(BxdfFlags_GLOSSY_REFLECTION);
}

fn Measured_f(this_: Measured, wo: vec3f, wi: vec3f, mode: u32) -> vec4f {
    var chosen: Tuple_Vec3_Vec3;
    if (mode == TransportMode_Radiance) {
        chosen = Tuple_Vec3_Vec3(wo, wi);
    } else {
        chosen = Tuple_Vec3_Vec3(wi, wo);
    }
    let parts = chosen;
    let wo_1 = parts.v0;
    let wi_1 = parts.v1;
    return MeasuredValue_run(MeasuredValue(this_, wo_1, wi_1));
}

fn Measured_sample_f(this_: Measured, wo: vec3f, unused_2: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    if (!Directions_reflection(directions)) {
        return BsdfSample_invalid();
    }
    let outgoing = Measured_outgoing(this_, wo);
    let u_1 = MeasuredTable_sample_luminance(this_.table, u, outgoing.between);
    let at = MeasuredTable_sample_normal(this_.table, u_1, outgoing.between);
    let theta = sqr(at.x) * 1.5707964f;
    let phi = ((at.y - 0.5f) * 6.2831855f) + outgoing.turn;
    let parts = sin_cos(theta);
    let sin_theta_1 = parts.v0;
    let cos_theta = parts.v1;
    let wi = fresnel_reflect(outgoing.w, spherical_direction(sin_theta_1, cos_theta, phi));
    let wi_1 = select(wi, -wi, wo.z < 0.0f);
    let pdf = Measured_pdf(this_, wo, wi_1, mode, directions);
    let lobe = BxdfFlags_splat(BxdfFlags_GLOSSY_REFLECTION);
    let sample = BsdfSample_new(Measured_f(this_, wo, wi_1, mode), wi_1, pdf, lobe);
    return BsdfSample(sample.f, sample.wi, sample.pdf, sample.flags, sample.eta, sample.pdf_is_proportional, pdf > 0.0f);
}

fn Measured_pdf(this_: Measured, wo: vec3f, wi: vec3f, unused_3: u32, directions: u32) -> f32 {
    if (!Directions_reflection(directions)) {
        return 0.0f;
    }
    return MeasuredDensity_run(MeasuredDensity(this_, wo, wi));
}

// A value of the BRDF, which its samples have, too.
struct MeasuredValue {
    surface: Measured,
    wo: vec3f,
    wi: vec3f,
}

fn MeasuredValue_run(this_: MeasuredValue) -> vec4f {
    let surface = this_.surface;
    let wo = this_.wo;
    let wi = this_.wi;
    let table = surface.table;
    let lambda = surface.lambda;
    let outgoing = Measured_outgoing(surface, wo);
    let facet = Measured_microfacet(surface, outgoing, wo, wi);
    let parts = MeasuredTable_invert_normal(table, facet.at, outgoing.between);
    let u = parts.v0;
    let area = (4.0f * MeasuredTable_sigma(table, outgoing.at)) * abs(wi.z);
    let f = MeasuredTable_values(table, u, outgoing.between, lambda) * (MeasuredTable_ndf(table, facet.at) / area);
    return SampledSpectrum_select(facet.exists, f, SampledSpectrum_zero());
}

// The density of a sample.
struct MeasuredDensity {
    surface: Measured,
    wo: vec3f,
    wi: vec3f,
}

fn MeasuredDensity_run(this_: MeasuredDensity) -> f32 {
    let surface = this_.surface;
    let wo = this_.wo;
    let wi = this_.wi;
    let outgoing = Measured_outgoing(surface, wo);
    let facet = Measured_microfacet(surface, outgoing, wo, wi);
    let parts = MeasuredTable_invert_normal(surface.table, facet.at, outgoing.between);
    let u = parts.v0;
    let density = parts.v1;
    let solid_angle = (((2.0f * 3.1415927f) * 3.1415927f) * facet.at.x) * facet.sin_theta;
    let solid_angle_1 = (4.0f * facet.cosine) * real_max(solid_angle, 1e-6f);
    let pdf = (density * MeasuredTable_luminance_pdf(surface.table, u, outgoing.between)) / solid_angle_1;
    return select(0.0f, pdf, facet.exists);
}
