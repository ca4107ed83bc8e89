// Translated from crates/scattering/src/fresnel.rs
// by `cargo xtask wgsl`, which translates it again.

// The mirror image of `wo` about `n`; both point away from the surface.
fn fresnel_reflect(wo: vec3f, n: vec3f) -> vec3f {
    return (n * (Vec3_dot(wo, n) * 2.0f)) - wo;
}

// The refraction of `wi` through a surface with unit normal `n`, and the relative index η_t/η_i
// along it: `eta` if `wi` is on the side of `n`, else its inverse; and where there is one: not
// where all light is reflected inside.
fn fresnel_refract(wi: vec3f, n: vec3f, eta: f32) -> Tuple_Vec3_f32_bool {
    let cos_1 = Vec3_dot(n, wi);
    let below = cos_1 < 0.0f;
    let n_1 = select(n, -n, below);
    let cos_i = select(cos_1, -cos_1, below);
    let eta_1 = select(eta, 1.0f / eta, below);
    let sin2_t = real_max(1.0f - sqr(cos_i), 0.0f) / sqr(eta_1);
    let cos_t = safe_sqrt(1.0f - sin2_t);
    return Tuple_Vec3_f32_bool((n_1 * ((cos_i / eta_1) - cos_t)) - (wi / eta_1), eta_1, !(sin2_t >= 1.0f));
}

// The reflectance of an interface between dielectrics; `eta` is the relative index met by light
// with `cos_theta_i` > 0.
fn fr_dielectric(cos_theta_i: f32, eta: f32) -> f32 {
    let below = cos_theta_i < 0.0f;
    let cos_i = real_min(select(cos_theta_i, -cos_theta_i, below), 1.0f);
    let eta_1 = select(eta, 1.0f / eta, below);
    let sin2_t = (1.0f - sqr(cos_i)) / sqr(eta_1);
    let cos_t = safe_sqrt(1.0f - sin2_t);
    let parallel = ((eta_1 * cos_i) - cos_t) / ((eta_1 * cos_i) + cos_t);
    let perpendicular = (cos_i - (eta_1 * cos_t)) / (cos_i + (eta_1 * cos_t));
    let reflectance_1 = (sqr(parallel) + sqr(perpendicular)) * 0.5f;
    return select(reflectance_1, 1.0f, sin2_t >= 1.0f);
}

// The share of uniform light that an interface between dielectrics of relative index `eta`
// reflects: the mean of [`fr_dielectric`] over the directions of a hemisphere by their cosine. A
// fit, to 0.01, of [Kulla 2017].
fn mean_fresnel(eta: f32) -> f32 {
    let denser = (eta - 1.0f) / (4.08567f + (1.00071f * eta));
    return select(0.997118f + (eta * (0.1014f + (eta * (-0.965241f + (eta * -0.130607f))))), denser, eta >= 1.0f);
}

// The reflectance of an interface to a medium of complex index `eta` + i `k`, relative to the
// medium of the light; `cos_theta_i` in [0, 1].
fn fr_complex(cos_theta_i: f32, eta: f32, k: f32) -> f32 {
    let cos_1 = real_min(real_max(cos_theta_i, 1e-12f), 1.0f);
    let cos2 = sqr(cos_1);
    let sin2 = 1.0f - cos2;
    let real = (((eta - 1.0f) * (eta + 1.0f)) - sqr(k)) + cos2;
    let imaginary = (2.0f * eta) * k;
    let modulus = sqrt(sqr(real) + sqr(imaginary));
    let larger = sqrt(0.5f * (modulus + abs(real)));
    let is_real_part = (real >= 0.0f) | (larger == 0.0f);
    let a = select((0.5f * imaginary) / larger, larger, is_real_part);
    let sum = modulus + cos2;
    let cross_1 = (2.0f * cos_1) * a;
    let perpendicular = (sum - cross_1) / (sum + cross_1);
    let sum_1 = (cos2 * modulus) + sqr(sin2);
    let cross_2 = cross_1 * sin2;
    let parallel = (perpendicular * (sum_1 - cross_2)) / (sum_1 + cross_2);
    return 0.5f * (parallel + perpendicular);
}

// [`fr_complex`] at each wavelength.
fn fr_conductor(cos_theta_i: f32, eta: vec4f, k: vec4f) -> vec4f {
    var reflected = eta;
    for (var i = 0u; i < sampled_N; i++) {
        reflected[i] = fr_complex(cos_theta_i, eta[i], k[i]);
    }
    return reflected;
}
