// Translated from crates/scattering/src/bxdf/layered/walk.rs
// by `cargo xtask wgsl`, which translates it again.

// A random walk inside of the coat.
struct Walk {
    w: vec3f,
    z: f32,
    beta: vec4f,
    alive: bool,
}

// The random numbers of an event. Each has its own, so that they are the same whatever happens in
// other lanes.
struct Numbers {
    roulette: f32,
    flight: f32,
    uc: f32,
    u: vec2f,
}

fn Numbers_next(random: ptr<function, HashSequence>) -> Numbers {
    let result = HashSequence_get_1d(random);
    let result_1 = HashSequence_get_1d(random);
    let result_2 = HashSequence_get_1d(random);
    let result_3 = HashSequence_get_2d(random);
    return Numbers(result, result_1, result_2, result_3);
}

// What happens to a walk next: one thing in each lane that is alive.
struct Event {
    in_medium: bool,
    at_base: bool,
    at_interface: bool,
}

// The walk that begins with a refraction inwards.
fn Walk_enter(entrance: BsdfSample, thickness: f32) -> Walk {
    let beta = entrance.f * (abs(entrance.wi.z) / entrance.pdf);
    return Walk(entrance.wi, thickness, beta, carries_light(entrance));
}

// Plays Russian roulette where little is left after some events.
fn Walk_roulette(this_: ptr<function, Walk>, depth: u32, u: f32) {
    let left = SampledSpectrum_max_component((*this_).beta);
    let plays = (*this_).alive & (left < 0.25f);
    if ((depth <= 3) || !plays) {
        return;
    }
    let survives = u < left;
    (*this_).beta = SampledSpectrum_select(plays, (*this_).beta / left, (*this_).beta);
    (*this_).alive = (*this_).alive & (!plays | survives);
}

// Goes on to the next event, in a coat of this thickness, with a medium where it has one.
fn Walk_go_on(this_: ptr<function, Walk>, thickness: f32, has_medium: bool, u: f32) -> Event {
    let down = (*this_).w.z < 0.0f;
    var height = select(thickness, 0.0f, down);
    var in_medium = false;
    if (has_medium) {
        let z = (*this_).z - (ln(1.0f - u) * (*this_).w.z);
        in_medium = (((*this_).alive & has_medium) & (z > 0.0f)) & (z < thickness);
        height = select(height, z, in_medium);
    }
    if (!has_medium) {
        let transmitted = (*this_).beta * transmittance(thickness, (*this_).w);
        (*this_).beta = SampledSpectrum_select(has_medium, (*this_).beta, transmitted);
    }
    (*this_).z = height;
    let at_layers = (*this_).alive & !in_medium;
    return Event(in_medium, at_layers & down, at_layers & !down);
}

// Goes on along a sample where the mask is true; ends where there is none.
fn Walk_scatter(this_: ptr<function, Walk>, at: bool, sample: BsdfSample) {
    let beta = (*this_).beta * (sample.f * (abs(sample.wi.z) / sample.pdf));
    (*this_).beta = SampledSpectrum_select(at, beta, (*this_).beta);
    (*this_).w = select((*this_).w, sample.wi, at);
    (*this_).alive = (*this_).alive & (!at | carries_light(sample));
}

// Scatters in the medium where the mask is true; returns the density of the direction.
fn Walk_scatter_in_medium(this_: ptr<function, Walk>, at: bool, phase: HenyeyGreenstein, albedo_1: vec4f, u: vec2f) -> f32 {
    let parts = HenyeyGreenstein_sample_p(phase, -(*this_).w, u);
    let w = parts.v0;
    let p = parts.v1;
    (*this_).beta = SampledSpectrum_select(at, (*this_).beta * albedo_1, (*this_).beta);
    (*this_).w = select((*this_).w, w, at);
    (*this_).alive = (*this_).alive & (!at | (w.z != 0.0f));
    return p;
}

// Whether there is a sample of light, and it does not go along the layers.
fn carries_light(sample: BsdfSample) -> bool {
    return ((sample.valid & (sample.pdf > 0.0f)) & (sample.wi.z != 0.0f)) & !SampledSpectrum_is_black(sample.f);
}

// The share of light that goes a height `dz` ≥ 0 along `w` without an event.
fn transmittance(dz: f32, w: vec3f) -> f32 {
    return exponential_exp(-(dz / abs(w.z)));
}

// The weight of a sample of density `p`, where another strategy has the density `other`, if there
// is another.
fn weight(p: f32, other: f32, is_other: bool) -> f32 {
    return select(1.0f, 1.0f / (1.0f + sqr(other / p)), is_other);
}

// A sample of the coat's surface. It is called, because walks have several of them.
struct SampleInterface {
    interface_: Dielectric,
    wo: vec3f,
    uc: f32,
    u: vec2f,
    mode: u32,
    directions: u32,
}

fn SampleInterface_run(this_: SampleInterface) -> BsdfSample {
    return Dielectric_sample_f(this_.interface_, this_.wo, this_.uc, this_.u, this_.mode, this_.directions);
}

// One estimate of the light from `wi` that leaves the inside of the coat to `wo`, both above.
struct Estimate_Conductor {
    layers: Layered_Conductor,
    wo: vec3f,
    wi: vec3f,
    mode: u32,
    random: HashSequence,
}

// One estimate of the light from `wi` that leaves the inside of the coat to `wo`, both above.
struct Estimate_Diffuse {
    layers: Layered_Diffuse,
    wo: vec3f,
    wi: vec3f,
    mode: u32,
    random: HashSequence,
}

fn Estimate_Conductor_run(this_: Estimate_Conductor) -> vec4f {
    let layers = this_.layers;
    let wo = this_.wo;
    let wi = this_.wi;
    let mode = this_.mode;
    var random = this_.random;
    let base = layers.base;
    let interface_1 = layers.interface_;
    let thickness = layers.thickness;
    let albedo_1 = layers.albedo;
    let phase = layers.phase;
    let result = HashSequence_get_1d(&random);
    let result_1 = HashSequence_get_2d(&random);
    let entrance = SampleInterface_run(SampleInterface(interface_1, wo, result, result_1, mode, Directions_Transmission));
    let result_2 = HashSequence_get_1d(&random);
    let result_3 = HashSequence_get_2d(&random);
    let light = SampleInterface_run(SampleInterface(interface_1, wi, result_2, result_3, TransportMode_not(mode), Directions_Transmission));
    var walk = Walk_enter(entrance, thickness);
    walk.alive = walk.alive & carries_light(light);
    let is_rough = BxdfFlags_is_non_specular(Dielectric_flags(interface_1));
    let base_is_rough = BxdfFlags_is_non_specular(Conductor_flags(base));
    let leave = Leave(interface_1, thickness, wi, mode);
    let to_light = -light.wi;
    let light_f = light.f / light.pdf;
    var sum = SampledSpectrum_zero();
    for (var depth = 0u; depth < layers.max_depth; depth++) {
        let result_4 = Numbers_next(&random);
        let roulette = result_4.roulette;
        let flight = result_4.flight;
        let uc = result_4.uc;
        let u = result_4.u;
        Walk_roulette(&walk, depth, roulette);
        if (!walk.alive) {
            break;
        }
        let result_5 = Walk_go_on(&walk, thickness, Layered_Conductor_has_medium(layers), flight);
        let wo_1 = -walk.w;
        var pdf = 1.0f;
        var has_density = true;
        if (result_5.in_medium) {
            let at = result_5.in_medium;
            let p = HenyeyGreenstein_p(phase, wo_1, to_light);
            let weight_1 = weight(light.pdf, p, is_rough);
            let through = (weight_1 * p) * transmittance(thickness - walk.z, to_light);
            let l = ((walk.beta * albedo_1) * light_f) * through;
            sum += SampledSpectrum_select(at, l, SampledSpectrum_zero());
            let result_6 = Walk_scatter_in_medium(&walk, at, phase, albedo_1, u);
            pdf = select(pdf, result_6, at);
        }
        if (result_5.at_base) {
            let at_1 = result_5.at_base;
            let f = Conductor_f(base, wo_1, to_light, mode);
            let weight_2 = weight(light.pdf, Conductor_pdf(base, wo_1, to_light, mode, Directions_All), is_rough);
            let through_1 = (weight_2 * abs(to_light.z)) * transmittance(thickness, to_light);
            let l_1 = ((walk.beta * f) * light_f) * through_1;
            sum += SampledSpectrum_select(at_1 & base_is_rough, l_1, SampledSpectrum_zero());
            let sample = Conductor_sample_f(base, wo_1, uc, u, mode, Directions_Reflection);
            Walk_scatter(&walk, at_1, sample);
            pdf = select(pdf, sample.pdf, at_1);
            has_density = !at_1 | !BxdfFlags_is_specular(sample.flags);
        }
        let at_2 = (((result_5.in_medium | result_5.at_base) & walk.alive) & is_rough) & (walk.w.z > 0.0f);
        if (at_2) {
            sum += SampledSpectrum_select(at_2, Leave_l(leave, walk, pdf, has_density), SampledSpectrum_zero());
        }
        if (result_5.at_interface) {
            let sample_1 = SampleInterface_run(SampleInterface(interface_1, wo_1, uc, u, mode, Directions_Reflection));
            Walk_scatter(&walk, result_5.at_interface, sample_1);
        }
    }
    return sum;
}

fn Estimate_Diffuse_run(this_: Estimate_Diffuse) -> vec4f {
    let layers = this_.layers;
    let wo = this_.wo;
    let wi = this_.wi;
    let mode = this_.mode;
    var random = this_.random;
    let base = layers.base;
    let interface_1 = layers.interface_;
    let thickness = layers.thickness;
    let albedo_1 = layers.albedo;
    let phase = layers.phase;
    let result = HashSequence_get_1d(&random);
    let result_1 = HashSequence_get_2d(&random);
    let entrance = SampleInterface_run(SampleInterface(interface_1, wo, result, result_1, mode, Directions_Transmission));
    let result_2 = HashSequence_get_1d(&random);
    let result_3 = HashSequence_get_2d(&random);
    let light = SampleInterface_run(SampleInterface(interface_1, wi, result_2, result_3, TransportMode_not(mode), Directions_Transmission));
    var walk = Walk_enter(entrance, thickness);
    walk.alive = walk.alive & carries_light(light);
    let is_rough = BxdfFlags_is_non_specular(Dielectric_flags(interface_1));
    let base_is_rough = BxdfFlags_is_non_specular(Diffuse_flags(base));
    let leave = Leave(interface_1, thickness, wi, mode);
    let to_light = -light.wi;
    let light_f = light.f / light.pdf;
    var sum = SampledSpectrum_zero();
    for (var depth = 0u; depth < layers.max_depth; depth++) {
        let result_4 = Numbers_next(&random);
        let roulette = result_4.roulette;
        let flight = result_4.flight;
        let uc = result_4.uc;
        let u = result_4.u;
        Walk_roulette(&walk, depth, roulette);
        if (!walk.alive) {
            break;
        }
        let result_5 = Walk_go_on(&walk, thickness, Layered_Diffuse_has_medium(layers), flight);
        let wo_1 = -walk.w;
        var pdf = 1.0f;
        var has_density = true;
        if (result_5.in_medium) {
            let at = result_5.in_medium;
            let p = HenyeyGreenstein_p(phase, wo_1, to_light);
            let weight_1 = weight(light.pdf, p, is_rough);
            let through = (weight_1 * p) * transmittance(thickness - walk.z, to_light);
            let l = ((walk.beta * albedo_1) * light_f) * through;
            sum += SampledSpectrum_select(at, l, SampledSpectrum_zero());
            let result_6 = Walk_scatter_in_medium(&walk, at, phase, albedo_1, u);
            pdf = select(pdf, result_6, at);
        }
        if (result_5.at_base) {
            let at_1 = result_5.at_base;
            let f = Diffuse_f(base, wo_1, to_light, mode);
            let weight_2 = weight(light.pdf, Diffuse_pdf(base, wo_1, to_light, mode, Directions_All), is_rough);
            let through_1 = (weight_2 * abs(to_light.z)) * transmittance(thickness, to_light);
            let l_1 = ((walk.beta * f) * light_f) * through_1;
            sum += SampledSpectrum_select(at_1 & base_is_rough, l_1, SampledSpectrum_zero());
            let sample = Diffuse_sample_f(base, wo_1, uc, u, mode, Directions_Reflection);
            Walk_scatter(&walk, at_1, sample);
            pdf = select(pdf, sample.pdf, at_1);
            has_density = !at_1 | !BxdfFlags_is_specular(sample.flags);
        }
        let at_2 = (((result_5.in_medium | result_5.at_base) & walk.alive) & is_rough) & (walk.w.z > 0.0f);
        if (at_2) {
            sum += SampledSpectrum_select(at_2, Leave_l(leave, walk, pdf, has_density), SampledSpectrum_zero());
        }
        if (result_5.at_interface) {
            let sample_1 = SampleInterface_run(SampleInterface(interface_1, wo_1, uc, u, mode, Directions_Reflection));
            Walk_scatter(&walk, result_5.at_interface, sample_1);
        }
    }
    return sum;
}

// The end of a walk that is refracted outwards to the light.
struct Leave {
    interface_: Dielectric,
    thickness: f32,
    wi: vec3f,
    mode: u32,
}

// The light of a walk that goes up and through the rough interface to `wi` next. The direction
// of the walk has the density `pdf`, unless it is specular.
fn Leave_l(this_: Leave, walk: Walk, pdf: f32, has_density: bool) -> vec4f {
    let interface_1 = this_.interface_;
    let thickness = this_.thickness;
    let wi = this_.wi;
    let mode = this_.mode;
    let f = Dielectric_f(interface_1, -walk.w, wi, mode);
    let other = Dielectric_pdf(interface_1, wi, -walk.w, TransportMode_not(mode), Directions_Transmission);
    let through = weight(pdf, other, has_density) * transmittance(thickness - walk.z, walk.w);
    return SampledSpectrum_select(SampledSpectrum_is_black(f), SampledSpectrum_zero(), (walk.beta * f) * through);
}

// A sample of the whole, for `wo` above.
struct SampleWalk_Conductor {
    layers: Layered_Conductor,
    wo: vec3f,
    uc: f32,
    u: vec2f,
    mode: u32,
}

// A sample of the whole, for `wo` above.
struct SampleWalk_Diffuse {
    layers: Layered_Diffuse,
    wo: vec3f,
    uc: f32,
    u: vec2f,
    mode: u32,
}

fn SampleWalk_Conductor_run(this_: SampleWalk_Conductor) -> BsdfSample {
    let layers = this_.layers;
    let wo = this_.wo;
    let uc = this_.uc;
    let u = this_.u;
    let mode = this_.mode;
    let base = layers.base;
    let interface_1 = layers.interface_;
    let thickness = layers.thickness;
    let albedo_1 = layers.albedo;
    let phase = layers.phase;
    let entrance = Dielectric_sample_f(interface_1, wo, uc, u, mode, Directions_All);
    let reflected = entrance.valid & BxdfFlags_is_reflective(entrance.flags);
    let words_0 = bitcast<u32>(uc);
    let words_1 = bitcast<u32>(u.x);
    let words_2 = bitcast<u32>(u.y);
    var state = 0x6a09e667u;
    {
        state = mix_word(state ^ words_0) + 0x3c6ef372u;
    }
    {
        state = mix_word(state ^ words_1) + 0x3c6ef372u;
    }
    {
        state = mix_word(state ^ words_2) + 0x3c6ef372u;
    }
    var random = HashSequence(state);
    var walk = Walk_enter(entrance, thickness);
    walk.alive = walk.alive & !reflected;
    var specular = BxdfFlags_is_specular(entrance.flags);
    var left = false;
    var f = entrance.f;
    var wi = entrance.wi;
    for (var depth = 0u; depth <= layers.max_depth; depth++) {
        let result = Numbers_next(&random);
        let roulette = result.roulette;
        let flight = result.flight;
        let uc_1 = result.uc;
        let u_1 = result.u;
        Walk_roulette(&walk, depth, roulette);
        if (!walk.alive) {
            break;
        }
        let result_1 = Walk_go_on(&walk, thickness, Layered_Conductor_has_medium(layers), flight);
        let wo_1 = -walk.w;
        if (result_1.in_medium) {
            let result_2 = Walk_scatter_in_medium(&walk, result_1.in_medium, phase, albedo_1, u_1);
            specular = specular & !result_1.in_medium;
        }
        if (result_1.at_base) {
            let sample = Conductor_sample_f(base, wo_1, uc_1, u_1, mode, Directions_Reflection);
            specular = specular & (!result_1.at_base | BxdfFlags_is_specular(sample.flags));
            Walk_scatter(&walk, result_1.at_base, sample);
        }
        if (result_1.at_interface) {
            let sample_1 = SampleInterface_run(SampleInterface(interface_1, wo_1, uc_1, u_1, mode, Directions_All));
            let leaves = (result_1.at_interface & carries_light(sample_1)) & BxdfFlags_is_transmissive(sample_1.flags);
            f = SampledSpectrum_select(leaves, (walk.beta * sample_1.f) / sample_1.pdf, f);
            wi = select(wi, sample_1.wi, leaves);
            Walk_scatter(&walk, result_1.at_interface, sample_1);
            walk.alive = walk.alive & !leaves;
            left = left | leaves;
        }
    }
    let pdf = select(1.0f, entrance.pdf, reflected);
    let diffuse = BxdfFlags_is_diffuse(Layered_Conductor_flags(layers));
    let rough = BxdfFlags_choose(diffuse, BxdfFlags_DIFFUSE_REFLECTION, BxdfFlags_GLOSSY_REFLECTION);
    let lobe = BxdfFlags_select(specular, BxdfFlags_splat(BxdfFlags_SPECULAR_REFLECTION), rough);
    let lobe_1 = BxdfFlags_select(reflected, entrance.flags, lobe);
    let rest = BsdfSample_new(f, wi, pdf, lobe_1);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, true, reflected | left);
}

fn SampleWalk_Diffuse_run(this_: SampleWalk_Diffuse) -> BsdfSample {
    let layers = this_.layers;
    let wo = this_.wo;
    let uc = this_.uc;
    let u = this_.u;
    let mode = this_.mode;
    let base = layers.base;
    let interface_1 = layers.interface_;
    let thickness = layers.thickness;
    let albedo_1 = layers.albedo;
    let phase = layers.phase;
    let entrance = Dielectric_sample_f(interface_1, wo, uc, u, mode, Directions_All);
    let reflected = entrance.valid & BxdfFlags_is_reflective(entrance.flags);
    let words_0 = bitcast<u32>(uc);
    let words_1 = bitcast<u32>(u.x);
    let words_2 = bitcast<u32>(u.y);
    var state = 0x6a09e667u;
    {
        state = mix_word(state ^ words_0) + 0x3c6ef372u;
    }
    {
        state = mix_word(state ^ words_1) + 0x3c6ef372u;
    }
    {
        state = mix_word(state ^ words_2) + 0x3c6ef372u;
    }
    var random = HashSequence(state);
    var walk = Walk_enter(entrance, thickness);
    walk.alive = walk.alive & !reflected;
    var specular = BxdfFlags_is_specular(entrance.flags);
    var left = false;
    var f = entrance.f;
    var wi = entrance.wi;
    for (var depth = 0u; depth <= layers.max_depth; depth++) {
        let result = Numbers_next(&random);
        let roulette = result.roulette;
        let flight = result.flight;
        let uc_1 = result.uc;
        let u_1 = result.u;
        Walk_roulette(&walk, depth, roulette);
        if (!walk.alive) {
            break;
        }
        let result_1 = Walk_go_on(&walk, thickness, Layered_Diffuse_has_medium(layers), flight);
        let wo_1 = -walk.w;
        if (result_1.in_medium) {
            let result_2 = Walk_scatter_in_medium(&walk, result_1.in_medium, phase, albedo_1, u_1);
            specular = specular & !result_1.in_medium;
        }
        if (result_1.at_base) {
            let sample = Diffuse_sample_f(base, wo_1, uc_1, u_1, mode, Directions_Reflection);
            specular = specular & (!result_1.at_base | BxdfFlags_is_specular(sample.flags));
            Walk_scatter(&walk, result_1.at_base, sample);
        }
        if (result_1.at_interface) {
            let sample_1 = SampleInterface_run(SampleInterface(interface_1, wo_1, uc_1, u_1, mode, Directions_All));
            let leaves = (result_1.at_interface & carries_light(sample_1)) & BxdfFlags_is_transmissive(sample_1.flags);
            f = SampledSpectrum_select(leaves, (walk.beta * sample_1.f) / sample_1.pdf, f);
            wi = select(wi, sample_1.wi, leaves);
            Walk_scatter(&walk, result_1.at_interface, sample_1);
            walk.alive = walk.alive & !leaves;
            left = left | leaves;
        }
    }
    let pdf = select(1.0f, entrance.pdf, reflected);
    let diffuse = BxdfFlags_is_diffuse(Layered_Diffuse_flags(layers));
    let rough = BxdfFlags_choose(diffuse, BxdfFlags_DIFFUSE_REFLECTION, BxdfFlags_GLOSSY_REFLECTION);
    let lobe = BxdfFlags_select(specular, BxdfFlags_splat(BxdfFlags_SPECULAR_REFLECTION), rough);
    let lobe_1 = BxdfFlags_select(reflected, entrance.flags, lobe);
    let rest = BsdfSample_new(f, wi, pdf, lobe_1);
    return BsdfSample(rest.f, rest.wi, rest.pdf, rest.flags, rest.eta, true, reflected | left);
}
