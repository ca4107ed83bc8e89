// Direct light: connections of a surface with points of lights.

// The light of a sample that a surface scatters, without visibility and density.
fn scattered(s: Surface, bsdf: Bsdf, light: LightSample) -> vec4f {
    return bsdf_f(bsdf, s.wo, light.wi) * light.l * abs(dot(light.wi, s.ns));
}

// Russian roulette with a probability of survival: the probability, or 1 where survival is certain,
// and 0 if the path has ended.
fn roulette(probability: f32, depth: u32) -> f32 {
    if (!plays_roulette(depth, probability)) {
        return 1;
    }
    return select(0, probability, probability > 0 && get_1d() < probability);
}

// A shadow ray, and the light that it brings if nothing is in its way.
struct DirectLight {
    shadow: ShadowRay,
    l: vec4f,
    // Of a light that paths do not hit, which interfaces occlude.
    is_delta: bool,
}

// The light of the light that `u` chooses and of its point that `u_light` chooses, which a surface
// scatters, weighted against sampling of the BSDF.
fn direct_light(
    s: Surface,
    context: ShapeSampleContext,
    bsdf: Bsdf,
    lambda: SampledWavelengths,
    u: f32,
    u_light: vec2f,
) -> DirectLight {
    var found: DirectLight;
    let choice = choose_light(context, u);
    if (!choice.valid) {
        return found;
    }
    let light = sample_light(choice.light, context, u_light, lambda, true);
    if (!light.valid) {
        return found;
    }
    let l = scattered(s, bsdf, light);
    if (is_black(l)) {
        return found;
    }
    let pdf = choice.pmf * light.pdf;
    var weight = 1.0;
    found.is_delta = is_delta(light_record(choice.light));
    if (!found.is_delta) {
        weight = power_heuristic(pdf, bsdf_pdf(bsdf, s.wo, light.wi));
    }
    found.shadow = shadow_ray(s, light);
    found.l = l * (weight / pdf);
    return found;
}

// The light of all lights that a surface scatters; as if nothing were in between, unless that is
// to cast shadows. Skies of one colour cast none where they are ambient.
fn all_lights(
    s: Surface,
    bsdf: Bsdf,
    lambda: SampledWavelengths,
    has_shadows: bool,
    has_ambient: bool,
) -> vec4f {
    let flags = bxdf_flags(bsdf);
    var sum = vec4f();
    if (!is_non_specular(flags)) {
        return sum;
    }
    let context = light_context(s, flags);
    for (var i = 0u; i < world.light_count; i++) {
        let u = get_2d();
        let is_ambient = has_ambient && word(light_record(i)) == LightTag_UniformInfinite;
        var light: LightSample;
        if (is_ambient) {
            let sample = sample_ambient(s.wo, s.ns, flags, u);
            light.l = emission(light_record(i), lambda);
            light.wi = sample.v0;
            light.pdf = sample.v1;
            light.valid = true;
        } else {
            light = sample_light(i, context, u, lambda, false);
        }
        if (!light.valid) {
            continue;
        }
        let l = scattered(s, bsdf, light);
        if (is_black(l)) {
            continue;
        }
        if (has_shadows && !is_ambient) {
            let shadow = shadow_ray(s, light);
            if (occluded(shadow.ray, shadow.t_max)) {
                continue;
            }
        }
        sum += l / light.pdf;
    }
    return sum;
}
