// Translated from crates/spectrum/src/wavelengths.rs
// by `cargo xtask wgsl`, which translates it again.

const wavelengths_LAMBDA_MIN: f32 = 360.0f;

const wavelengths_LAMBDA_MAX: f32 = 830.0f;

// The wavelengths of a path, in nanometres, and their sampling densities, per nanometre.
struct SampledWavelengths {
    lambda: vec4f,
    pdf: vec4f,
}

// Wavelengths sampled uniformly over `min..max`, from `u` in [0, 1).
fn SampledWavelengths_sample_uniform_in(u: f32, min_1: f32, max_1: f32) -> SampledWavelengths {
    let parts = rotations(u);
    let u_1 = parts.x;
    let u_2 = parts.y;
    let u_3 = parts.z;
    let u_4 = parts.w;
    let lambda_0 = min_1 + (u_1 * (max_1 - min_1));
    let lambda_1 = min_1 + (u_2 * (max_1 - min_1));
    let lambda_2 = min_1 + (u_3 * (max_1 - min_1));
    let lambda_3 = min_1 + (u_4 * (max_1 - min_1));
    let element = 1.0f / (max_1 - min_1);
    return SampledWavelengths(vec4f(lambda_0, lambda_1, lambda_2, lambda_3), vec4f(element, element, element, element));
}

// Wavelengths sampled so that colours have little noise, from `u` in [0, 1).
fn SampledWavelengths_sample_visible(u: f32) -> SampledWavelengths {
    let turned_1 = u * f32(sampled_N);
    let quarter = floor(turned_1);
    let x = turned_1 - quarter;
    var lambda = vec4f(0.0f, 0.0f, 0.0f, 0.0f);
    var pdf = vec4f(0.0f, 0.0f, 0.0f, 0.0f);
    for (var i = 0u; i < sampled_N; i++) {
        let a = wavelengths_TANH_0[i];
        let b = wavelengths_TANH_1[i];
        let c = wavelengths_TANH_2[i];
        let d = wavelengths_TANH_3[i];
        let tanh = (((((d * x) + c) * x) + b) * x) + a;
        let slope = ((((3.0f * d) * x) + (2.0f * c)) * x) + b;
        lambda[i] = wavelength_of_tanh(tanh);
        pdf[i] = ((0.25f * wavelengths_TANH_SCALE) * (1.0f - (tanh * tanh))) / slope;
    }
    return SampledWavelengths(turned_by(quarter, lambda), turned_by(quarter, pdf));
}

// The wavelengths that pbrt-v4 samples as the eye sees them from u = 0.5, so that renderers
// can be compared at the same ones: those of the density ∝ sech²(0.0072 (λ − 538))
// [Radziszewski 2009] at 0.5, 0.75, 1 and 0.25 of its integral.
fn SampledWavelengths_fixed_visible() -> SampledWavelengths {
    return SampledWavelengths(vec4f(wavelengths_FIXED.x, wavelengths_FIXED.y, wavelengths_FIXED.z, wavelengths_FIXED.w), vec4f(wavelengths_FIXED_PDF.x, wavelengths_FIXED_PDF.y, wavelengths_FIXED_PDF.z, wavelengths_FIXED_PDF.w));
}

// The wavelengths that pbrt-v4 samples uniformly over `min..max` from u = 0.5: at 0.5, 0.75, 1
// and 0.25 of the range.
fn SampledWavelengths_fixed_uniform_in(min_1: f32, max_1: f32) -> SampledWavelengths {
    let pdf = 1.0f / (max_1 - min_1);
    return SampledWavelengths(vec4f(real_min(fma(max_1 - min_1, 0.5f, min_1), max_1), real_min(fma(max_1 - min_1, 0.75f, min_1), max_1), max_1, real_min(fma(max_1 - min_1, 0.25f, min_1), max_1)), vec4f(pdf, pdf, pdf, pdf));
}

// The wavelengths in nanometres.
fn SampledWavelengths_lambda(this_: SampledWavelengths) -> vec4f {
    return this_.lambda;
}

// Keeps only the first wavelength, for dispersion, and divides its density by N.
fn SampledWavelengths_terminate_secondary(this_: ptr<function, SampledWavelengths>) {
    let terminated = SampledWavelengths_secondary_terminated(*this_);
    let parts = (*this_).pdf;
    let hero = parts.x;
    (*this_).pdf = vec4f(0.0f, 0.0f, 0.0f, 0.0f);
    (*this_).pdf.x = select(hero / f32(sampled_N), hero, terminated);
}

// Whether the secondary wavelengths are terminated.
fn SampledWavelengths_secondary_terminated(this_: SampledWavelengths) -> bool {
    let parts = this_.pdf;
    let p = parts.x;
    let p_1 = parts.y;
    let p_2 = parts.z;
    let p_3 = parts.w;
    let a = p_1 == 0.0f;
    let b = p_2 == 0.0f;
    let c = p_3 == 0.0f;
    return (a & b) & c;
}

// `u` and its rotations by 1/4, 2/4 and 3/4 within [0, 1).
fn rotations(u: f32) -> vec4f {
    let rotated = u + 0.0f;
    let rotated_1 = u + 0.25f;
    let rotated_2 = u + 0.5f;
    let rotated_3 = u + 0.75f;
    return vec4f(select(rotated, rotated - 1.0f, rotated >= 1.0f), select(rotated_1, rotated_1 - 1.0f, rotated_1 >= 1.0f), select(rotated_2, rotated_2 - 1.0f, rotated_2 >= 1.0f), select(rotated_3, rotated_3 - 1.0f, rotated_3 >= 1.0f));
}

// The numbers of the quarters of the distribution, beginning with that of this index.
fn turned_by(quarter: f32, numbers: vec4f) -> vec4f {
    let a = numbers.x;
    let b = numbers.y;
    let c = numbers.z;
    let d = numbers.w;
    let by_two = quarter >= 2.0f;
    let rest = quarter - select(0.0f, 2.0f, by_two);
    let by_one = rest >= 1.0f;
    let a_1 = select(a, c, by_two);
    let b_1 = select(b, d, by_two);
    let c_1 = select(c, numbers.x, by_two);
    let d_1 = select(d, numbers.y, by_two);
    return vec4f(select(a_1, b_1, by_one), select(b_1, c_1, by_one), select(c_1, d_1, by_one), select(d_1, a_1, by_one));
}

const wavelengths_FIXED: vec4f = vec4f(545.903f, 616.85626f, 830.0f, 479.15405f);

const wavelengths_FIXED_PDF: vec4f = vec4f(0.0039270754f, 0.0029000742f, 0.00022832123f, 0.0033093247f);

const wavelengths_TANH_CENTER: f32 = 569.0f;

const wavelengths_TANH_SCALE: f32 = 0.014f;

const wavelengths_TANH_0: vec4f = vec4f(-0.9942682f, -0.8871028f, -0.4820172f, 0.2679077f);

const wavelengths_TANH_1: vec4f = vec4f(0.1402298f, 0.2459453f, 0.4856515f, 1.0597162f);

const wavelengths_TANH_2: vec4f = vec4f(-0.1684075f, 0.2815163f, 0.3454355f, -0.8542698f);

const wavelengths_TANH_3: vec4f = vec4f(0.1353431f, -0.122376f, -0.0811622f, 0.5253066f);

fn wavelength_of_tanh(tanh: f32) -> f32 {
    let log_1 = ln((1.0f + tanh) / (1.0f - tanh));
    let lambda = wavelengths_TANH_CENTER + (log_1 * (0.5f / wavelengths_TANH_SCALE));
    return real_min(real_max(lambda, wavelengths_LAMBDA_MIN), wavelengths_LAMBDA_MAX);
}
