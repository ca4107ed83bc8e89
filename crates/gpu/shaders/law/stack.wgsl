// Translated from crates/scattering/src/bxdf/openpbr/stack.rs
// by `cargo xtask wgsl`, which translates it again.

// The numbers of the layers.
struct Stack {
    base: TrowbridgeReitz,
    coat: TrowbridgeReitz,
    coat_weight: f32,
    coat_ior: f32,
    fuzz_weight: f32,
    fuzz_roughness: f32,
    above: f32,
    below: f32,
    index: f32,
    film_weight: f32,
    film_ior: f32,
    is_thin: bool,
}

// What the layers do with light from one direction above, as if nothing absorbed.
struct Taken {
    fuzz_once: f32,
    fuzz_more: f32,
    coat: f32,
    below_coat: f32,
    metal: f32,
    dielectric: f32,
    refracted: f32,
    left: f32,
}

// What glass does with light from one direction below or, if it is a sheet, from either side.
struct Inside {
    reflected: f32,
    refracted: f32,
    left: f32,
}

// α both ways, of a roughness and anisotropy in [0, 1].
fn distribution(roughness: f32, anisotropy: f32) -> TrowbridgeReitz {
    let narrow = 1.0f - anisotropy;
    let alpha_x = sqr(roughness) * sqrt(2.0f / (1.0f + sqr(narrow)));
    return TrowbridgeReitz_new(alpha_x, narrow * alpha_x);
}

// The roughness of a base under a coat, by the variance that refraction in it adds.
fn roughened(p: OpenPbrParameters) -> f32 {
    let base = sqr(sqr(p.specular_roughness));
    let coat = sqr(sqr(p.coat_roughness));
    let under = sqrt(sqrt(real_min(base + (2.0f * coat), 1.0f)));
    return lerp(p.coat_weight, p.specular_roughness, under);
}

fn Stack_new(p: OpenPbrParameters) -> Stack {
    let above = lerp(p.coat_weight, 1.0f, p.coat_ior);
    let root = (p.specular_ior - above) / (p.specular_ior + above);
    let root_1 = real_min(real_max(root * sqrt(p.specular_weight), -0.999f), 0.999f);
    return Stack(distribution(roughened(p), p.specular_roughness_anisotropy), distribution(p.coat_roughness, p.coat_roughness_anisotropy), p.coat_weight, p.coat_ior, p.fuzz_weight, p.fuzz_roughness, above, (above * (1.0f + root_1)) / (1.0f - root_1), real_max(p.specular_ior, 1.001f), p.thin_film_weight, p.thin_film_ior, p.geometry_thin_walled);
}

// Whether there is something over the base.
fn Stack_has_layers(this_: Stack) -> bool {
    return (this_.coat_weight > 0.0f) | (this_.fuzz_weight > 0.0f);
}

// Whether some layer spreads light, so that there is a rest to scatter.
fn Stack_spreads(this_: Stack) -> bool {
    let has_rough_coat = (this_.coat_weight > 0.0f) & !TrowbridgeReitz_effectively_smooth(this_.coat);
    return (!TrowbridgeReitz_effectively_smooth(this_.base) | has_rough_coat) | (this_.fuzz_weight > 0.0f);
}

// The cosine at which the base is met by light that meets the surface at `cosine` in air.
fn Stack_inner_cosine(this_: Stack, cosine: f32) -> f32 {
    let inner = safe_sqrt(1.0f - ((1.0f - sqr(cosine)) / sqr(this_.above)));
    return select(inner, cosine, this_.above == 1.0f);
}

// The reflectance of the dielectric met at a cosine in air, under a film of so many
// wavelengths.
fn Stack_dielectric(this_: Stack, cosine: f32, waves: f32) -> f32 {
    let cosine_1 = Stack_inner_cosine(this_, cosine);
    let bare = fr_dielectric(cosine_1, this_.below / this_.above);
    let is_filmed = this_.film_weight > 0.0f;
    if (!is_filmed) {
        return bare;
    }
    let below = Complex_real(this_.below);
    let filmed = film_reflectance(cosine_1, this_.above, this_.film_ior, below, waves);
    return select(bare, lerp(this_.film_weight, bare, filmed), is_filmed);
}

// The same at all wavelengths of a path.
fn Stack_dielectrics(this_: Stack, cosine: f32, waves: vec4f) -> vec4f {
    if (this_.film_weight > 0.0f) {
        return FilmedDielectric_run(FilmedDielectric(this_, cosine, waves));
    }
    return SampledSpectrum_splat(fr_dielectric(Stack_inner_cosine(this_, cosine), this_.below / this_.above));
}

// The facets that mirror light, turned over, as a sheet with rough sides refracts it.
fn Stack_sheet(this_: Stack) -> TrowbridgeReitz {
    return TrowbridgeReitz_scaled(this_.base, real_min((this_.index - 1.0f) * 0.70710677f, 1.0f));
}

// The reflectance of the dielectric under a film.
struct FilmedDielectric {
    stack: Stack,
    cosine: f32,
    waves: vec4f,
}

fn FilmedDielectric_run(this_: FilmedDielectric) -> vec4f {
    var reflected = this_.waves;
    for (var i = 0u; i < sampled_N; i++) {
        reflected[i] = Stack_dielectric(this_.stack, this_.cosine, this_.waves[i]);
    }
    return reflected;
}
