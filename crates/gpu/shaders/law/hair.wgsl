// Translated from crates/scattering/src/bxdf/hair.rs
// by `cargo xtask wgsl`, which translates it again.

const hair_P_MAX: u32 = 3;

const hair_SQRT_PI_OVER_8: f32 = 0.62665707f;

// Scattering by a fibre.
struct Hair {
    h: f32,
    eta: f32,
    sigma_a: vec4f,
    v: vec4f,
    s: f32,
    tilts: array<Tuple_f32_f32, 3>,
}

// A fibre at the offset `h` in [−1, 1] from its middle, of index `eta` and absorption
// `sigma_a` per radius. Its longitudinal and azimuthal roughness `beta_m` and `beta_n` lie in
// (0, 1]; its scales have the angle `alpha` in degrees.
fn Hair_new(h: f32, eta: f32, sigma_a: vec4f, argument_3: vec2f, alpha: f32) -> Hair {
    let beta_m = argument_3.x;
    let beta_n = argument_3.y;
    let root = ((0.726f * beta_m) + (0.812f * sqr(beta_m))) + (3.7f * powi(beta_m, 20));
    let v = sqr(root);
    let wide = 4.0f * v;
    let s = ((0.265f * beta_n) + (1.194f * sqr(beta_n))) + (5.372f * powi(beta_n, 22));
    let parts = sin_cos(alpha * (3.1415927f / 180.0f));
    let s1 = parts.v0;
    let c1 = parts.v1;
    let parts_1 = double_angle(s1, c1);
    let s2 = parts_1.v0;
    let c2 = parts_1.v1;
    let tilts_2 = double_angle(s2, c2);
    let h_1 = real_min(real_max(h, -1.0f), 1.0f);
    return Hair(h_1, eta, sigma_a, vec4f(v, 0.25f * v, wide, wide), hair_SQRT_PI_OVER_8 * s, array<Tuple_f32_f32, 3>(Tuple_f32_f32(s1, c1), Tuple_f32_f32(s2, c2), tilts_2));
}

// The absorption that gives a volume of hair of azimuthal roughness `beta_n` about the
// `color`, in (0, 1]: a fit of [Chiang 2016 §4.2].
fn Hair_sigma_a_from_reflectance(color_1: vec4f, beta_n: f32) -> vec4f {
    let divisor = 5.574f + (beta_n * 0.245f);
    let divisor_1 = 2.532f + (beta_n * (-10.73f + (beta_n * divisor)));
    let divisor_2 = 5.969f + (beta_n * (-0.215f + (beta_n * divisor_1)));
    var sigma_a = color_1;
    {
        sigma_a[0] = sqr(ln(real_max(sigma_a[0], 1e-4f)) / divisor_2);
    }
    {
        sigma_a[1] = sqr(ln(real_max(sigma_a[1], 1e-4f)) / divisor_2);
    }
    {
        sigma_a[2] = sqr(ln(real_max(sigma_a[2], 1e-4f)) / divisor_2);
    }
    {
        sigma_a[3] = sqr(ln(real_max(sigma_a[3], 1e-4f)) / divisor_2);
    }
    return sigma_a;
}

// Everything that depends on `wo` alone.
fn Hair_outgoing(this_: Hair, wo: vec3f) -> Outgoing {
    let sin_theta_1 = wo.x;
    let cos_theta = safe_sqrt(1.0f - sqr(sin_theta_1));
    let gamma_o = arc_asin(this_.h);
    let index = safe_sqrt(sqr(this_.eta) - sqr(sin_theta_1)) / cos_theta;
    let sin_gamma_t = real_min(real_max(this_.h / index, -1.0f), 1.0f);
    let cos_gamma_t = safe_sqrt(1.0f - sqr(sin_gamma_t));
    let gamma_t = arc_asin(sin_gamma_t);
    let cos_theta_t = safe_sqrt(1.0f - sqr(sin_theta_1 / this_.eta));
    let length_1 = (2.0f * cos_gamma_t) / cos_theta_t;
    var transmittance_1 = this_.sigma_a;
    {
        transmittance_1[0] = exponential_exp(-(transmittance_1[0] * length_1));
    }
    {
        transmittance_1[1] = exponential_exp(-(transmittance_1[1] * length_1));
    }
    {
        transmittance_1[2] = exponential_exp(-(transmittance_1[2] * length_1));
    }
    {
        transmittance_1[3] = exponential_exp(-(transmittance_1[3] * length_1));
    }
    let cos_gamma_o = safe_sqrt(1.0f - sqr(this_.h));
    let fresnel = fr_dielectric(cos_theta * cos_gamma_o, this_.eta);
    let once = transmittance_1 * sqr(1.0f - fresnel);
    let again = transmittance_1 * fresnel;
    let twice = once * again;
    let rest = SampledSpectrum_safe_div(twice * again, SampledSpectrum_splat(1.0f) - again);
    let attenuations_0 = SampledSpectrum_splat(fresnel);
    let b = SampledSpectrum_average(once);
    let c = SampledSpectrum_average(twice);
    let d = SampledSpectrum_average(rest);
    let sum = ((fresnel + b) + c) + d;
    let probabilities_0 = fresnel / sum;
    let probabilities_1 = b / sum;
    let probabilities_2 = c / sum;
    let probabilities_3 = d / sum;
    let phi = arc_atan2(wo.z, wo.y);
    return Outgoing(sin_theta_1, cos_theta, phi, gamma_o, gamma_t, array<vec4f, 4>(attenuations_0, once, twice, rest), vec4f(probabilities_0, probabilities_1, probabilities_2, probabilities_3));
}

// Sine and cosine of θo turned by the scales, as lobe `p` meets them.
fn Hair_tilted(this_: Hair, o: Outgoing, p: u32) -> Tuple_f32_f32 {
    let sin_1 = o.sin_theta;
    let cos_1 = o.cos_theta;
    let parts = this_.tilts;
    let parts_1 = parts[0];
    let s1 = parts_1.v0;
    let c1 = parts_1.v1;
    let parts_2 = parts[1];
    let s2 = parts_2.v0;
    let c2 = parts_2.v1;
    let parts_3 = parts[2];
    let s4 = parts_3.v0;
    let c4 = parts_3.v1;
    var chosen: Tuple_f32_f32;
    if (p == 0) {
        chosen = Tuple_f32_f32((sin_1 * c2) - (cos_1 * s2), (cos_1 * c2) + (sin_1 * s2));
    } else if (p == 1) {
        chosen = Tuple_f32_f32((sin_1 * c1) + (cos_1 * s1), (cos_1 * c1) - (sin_1 * s1));
    } else if (p == 2) {
        chosen = Tuple_f32_f32((sin_1 * c4) + (cos_1 * s4), (cos_1 * c4) - (sin_1 * s4));
    } else {
        chosen = Tuple_f32_f32(sin_1, cos_1);
    }
    let parts_4 = chosen;
    let sin_2 = parts_4.v0;
    let cos_2 = parts_4.v1;
    return Tuple_f32_f32(sin_2, abs(cos_2));
}

// M·N of lobe `p` for a direction.
fn Hair_lobe(this_: Hair, o: Outgoing, p: u32, wi: vec3f, phi: f32) -> f32 {
    let sin_i = wi.x;
    let cos_i = safe_sqrt(1.0f - sqr(wi.x));
    let parts = Hair_tilted(this_, o, p);
    let sin_o = parts.v0;
    let cos_o = parts.v1;
    let m = longitudinal(vec2f(sin_i, cos_i), vec2f(sin_o, cos_o), this_.v[p]);
    var chosen: f32;
    if (p < hair_P_MAX) {
        chosen = logistic_pdf(wrap(phi - Outgoing_center(o, p)), this_.s);
    } else {
        chosen = 1.0f / 6.2831855f;
    }
    let n = chosen;
    return m * n;
}

// What scattering to `wo` depends on.
struct Outgoing {
    sin_theta: f32,
    cos_theta: f32,
    phi: f32,
    gamma_o: f32,
    gamma_t: f32,
    attenuations: array<vec4f, 4>,
    probabilities: vec4f,
}

// Φ(p): the angle around the fibre by which lobe `p` turns light.
fn Outgoing_center(this_: Outgoing, p: u32) -> f32 {
    let p_1 = f32(p);
    return (2.0f * ((p_1 * this_.gamma_t) - this_.gamma_o)) + (p_1 * 3.1415927f);
}

fn double_angle(sin_1: f32, cos_1: f32) -> Tuple_f32_f32 {
    return Tuple_f32_f32((2.0f * sin_1) * cos_1, sqr(cos_1) - sqr(sin_1));
}

// An angle as the equal one within ±π.
fn wrap(angle: f32) -> f32 {
    let turns = floor((angle * (1.0f / 6.2831855f)) + 0.5f);
    return angle - (turns * 6.2831855f);
}

// M: the longitudinal distribution of variance `v`, for sine and cosine of θi and θo.
fn longitudinal(argument_0: vec2f, argument_1: vec2f, v: f32) -> f32 {
    let sin_i = argument_0.x;
    let cos_i = argument_0.y;
    let sin_o = argument_1.x;
    let cos_o = argument_1.y;
    let inverse = 1.0f / v;
    let a = (cos_i * cos_o) * inverse;
    let b = (sin_i * sin_o) * inverse;
    let scale_1 = inverse / (1.0f - exponential_exp(-2.0f * inverse));
    return exponential_exp((ln_bessel_i0(a) - b) - inverse) * scale_1;
}

// The logarithm of the modified Bessel function I₀ of x ≥ 0.
fn ln_bessel_i0(x: f32) -> f32 {
    let y = 1.0f / (8.0f * x);
    let series = 1.0f + (y * (1.0f + (y * (4.5f + (y * 37.5f)))));
    let large = (x - (0.5f * ln(6.2831855f * x))) + ln(series);
    let quarter = sqr(x) * 0.25f;
    var sum = 1.0f;
    var term = 1.0f;
    for (var i = 1u; i < 10; i++) {
        term = (term * quarter) * (1.0f / f32(i * i));
        sum += term;
    }
    return select(ln(sum), large, x > 12.0f);
}

// The logistic distribution of scale `s`, trimmed to ±π.
fn logistic_pdf(x: f32, s: f32) -> f32 {
    let e = exponential_exp(-(abs(x) / s));
    let pdf = e / (s * sqr(1.0f + e));
    return pdf / (1.0f - (2.0f * logistic_tail(s)));
}

// The logistic distribution function at −π.
fn logistic_tail(s: f32) -> f32 {
    let e = exponential_exp(-3.1415927f / s);
    return e / (1.0f + e);
}

// A number of [`logistic_pdf`].
fn sample_logistic(u: f32, s: f32) -> f32 {
    let tail = logistic_tail(s);
    let at = tail + (u * (1.0f - (2.0f * tail)));
    let x = s * ln(at / (1.0f - at));
    return real_min(real_max(x, -3.1415927f), 3.1415927f);
}

fn Hair_flags(this_: Hair) -> u32 {
    return BxdfFlags_splat(BxdfFlags_GLOSSY_REFLECTION | BxdfFlags_TRANSMISSION);
}

fn Hair_f(this_: Hair, wo: vec3f, wi: vec3f, mode: u32) -> vec4f {
    var chosen: Tuple_Vec3_Vec3;
    if (mode == TransportMode_Radiance) {
        chosen = Tuple_Vec3_Vec3(wo, wi);
    } else {
        chosen = Tuple_Vec3_Vec3(wi, wo);
    }
    let parts = chosen;
    let wo_1 = parts.v0;
    let wi_1 = parts.v1;
    let o = Hair_outgoing(this_, wo_1);
    let phi = arc_atan2(wi_1.z, wi_1.y) - o.phi;
    var sum = SampledSpectrum_zero();
    for (var p = 0u; p <= hair_P_MAX; p++) {
        sum += o.attenuations[p] * Hair_lobe(this_, o, p, wi_1, phi);
    }
    return SampledSpectrum_safe_div(sum, SampledSpectrum_splat(abs(wi_1.z)));
}

fn Hair_sample_f(this_: Hair, wo: vec3f, uc: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    let o = Hair_outgoing(this_, wo);
    let parts = Hair_tilted(this_, o, 0);
    var sin_o = parts.v0;
    var cos_o = parts.v1;
    var v = this_.v.x;
    var center = Outgoing_center(o, 0);
    var left = uc / o.probabilities.x;
    var below = o.probabilities.x;
    var is_last = false;
    for (var p = 1u; p <= hair_P_MAX; p++) {
        let here = uc >= below;
        let probability = o.probabilities[p];
        let parts_1 = Hair_tilted(this_, o, p);
        let sin_1 = parts_1.v0;
        let cos_1 = parts_1.v1;
        sin_o = select(sin_o, sin_1, here);
        cos_o = select(cos_o, cos_1, here);
        v = select(v, this_.v[p], here);
        center = select(center, Outgoing_center(o, p), here);
        left = select(left, (uc - below) / probability, here);
        below += probability;
        is_last = here;
    }
    let left_1 = real_min(real_max(left, 0.0f), float_ONE_MINUS_EPSILON);
    let y = real_max(u.x, 1e-5f);
    let cos_theta = 1.0f + (v * ln(y + ((1.0f - y) * exponential_exp(-2.0f / v))));
    let sin_theta_1 = safe_sqrt(1.0f - sqr(cos_theta));
    let cos_phi_1 = sin_cos(u.y * 6.2831855f).v1;
    let sin_i = real_min(real_max(((sin_theta_1 * cos_phi_1) * cos_o) - (cos_theta * sin_o), -1.0f), 1.0f);
    let cos_i = safe_sqrt(1.0f - sqr(sin_i));
    let around = select(center + sample_logistic(left_1, this_.s), left_1 * 6.2831855f, is_last);
    let parts_2 = sin_cos(wrap(o.phi + around));
    let sin_phi_1 = parts_2.v0;
    let cos_phi_2 = parts_2.v1;
    let wi = vec3f(sin_i, cos_i * cos_phi_2, cos_i * sin_phi_1);
    let pdf = Hair_pdf(this_, wo, wi, mode, directions);
    let reflects = same_hemisphere(wo, wi);
    let lobe = BxdfFlags_choose(reflects, BxdfFlags_GLOSSY_REFLECTION, BxdfFlags_GLOSSY_TRANSMISSION);
    let valid = (Directions_meet(directions, lobe) & (pdf > 0.0f)) & (wi.z != 0.0f);
    let rest = BsdfSample_new(Hair_f(this_, wo, wi, mode), wi, pdf, lobe);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, rest.pdf_is_proportional, valid);
}

fn Hair_pdf(this_: Hair, wo: vec3f, wi: vec3f, unused_3: u32, directions: u32) -> f32 {
    let reflects = same_hemisphere(wo, wi);
    let lobe = BxdfFlags_choose(reflects, BxdfFlags_REFLECTION, BxdfFlags_TRANSMISSION);
    let o = Hair_outgoing(this_, wo);
    let phi = arc_atan2(wi.z, wi.y) - o.phi;
    var pdf = 0.0f;
    for (var p = 0u; p <= hair_P_MAX; p++) {
        pdf += o.probabilities[p] * Hair_lobe(this_, o, p, wi, phi);
    }
    return select(0.0f, pdf, Directions_meet(directions, lobe));
}
