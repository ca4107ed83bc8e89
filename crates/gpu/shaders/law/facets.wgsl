// Translated from crates/scattering/src/bxdf/openpbr/facets.rs
// by `cargo xtask wgsl`, which translates it again.

const facets_AT_EDGE: f32 = 46656.0f / 823543.0f;

const facets_SCHLICK_AT_EDGE: f32 = 7776.0f / 16807.0f;

// F₀ + (1 − F₀) x.
fn OpenPbr_schlick(this_: OpenPbr, x: f32) -> vec4f {
    var schlick = this_.metal.color;
    {
        schlick[0] = schlick[0] + ((1.0f - schlick[0]) * x);
    }
    {
        schlick[1] = schlick[1] + ((1.0f - schlick[1]) * x);
    }
    {
        schlick[2] = schlick[2] + ((1.0f - schlick[2]) * x);
    }
    {
        schlick[3] = schlick[3] + ((1.0f - schlick[3]) * x);
    }
    return schlick;
}

// b of the tint; zero where there is none.
fn OpenPbr_dip(this_: OpenPbr) -> vec4f {
    let untinted = SampledSpectrum_splat(1.0f) - this_.specular_color;
    return (OpenPbr_schlick(this_, facets_SCHLICK_AT_EDGE) * untinted) * (1.0f / facets_AT_EDGE);
}

// The reflectance of metal.
fn OpenPbr_metal(this_: OpenPbr, cosine: f32) -> vec4f {
    let grazing = 1.0f - cosine;
    let power = sqr(sqr(grazing)) * grazing;
    let plain = OpenPbr_schlick(this_, power);
    var bare = SampledSpectrum_clamp_zero(plain - (OpenPbr_dip(this_) * ((cosine * power) * grazing)));
    let is_filmed = this_.stack.film_weight > 0.0f;
    if (is_filmed) {
        let filmed = FilmedMetal_run(FilmedMetal(this_, cosine));
        let filmed_1 = SampledSpectrum_lerp(bare, filmed * SampledSpectrum_safe_div(bare, plain), this_.stack.film_weight);
        bare = SampledSpectrum_select(is_filmed, filmed_1, bare);
    }
    return bare * this_.metal.weight;
}

// The mean of [`Self::metal`] over directions by their cosine; under a film about that of the
// mean cosine.
fn OpenPbr_mean_metal(this_: OpenPbr) -> vec4f {
    let bare = OpenPbr_schlick(this_, 1.0f / 21.0f) - (OpenPbr_dip(this_) * (1.0f / 126.0f));
    let mean_1 = SampledSpectrum_clamp_zero(bare) * this_.metal.weight;
    let is_filmed = this_.stack.film_weight > 0.0f;
    if (!is_filmed) {
        return mean_1;
    }
    return SampledSpectrum_select(is_filmed, OpenPbr_metal(this_, 2.0f / 3.0f), mean_1);
}

// The reflectance of the index that metal has under a film.
struct FilmedMetal {
    surface: OpenPbr,
    cosine: f32,
}

fn FilmedMetal_run(this_: FilmedMetal) -> vec4f {
    let surface = this_.surface;
    let cosine = this_.cosine;
    let stack = surface.stack;
    let inner = Stack_inner_cosine(stack, cosine);
    var filmed = surface.waves;
    for (var i = 0u; i < sampled_N; i++) {
        let reflected = real_min(surface.metal.color[i], 0.9999f);
        let root = sqrt(reflected / (1.0f - reflected));
        let below = Complex(1.0f, 2.0f * root);
        filmed[i] = film_reflectance(inner, stack.above, stack.film_ior, below, surface.waves[i]);
    }
    return filmed;
}
