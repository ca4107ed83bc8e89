// Path tracing through media, as `integrators/src/camera_paths/vol_path.rs` has it: next-event
// estimation, multiple importance sampling over directions and wavelengths, Russian roulette.

// A path between two of its vertices.
struct Path {
    ray: Ray,
    near: Differentials,
    medium: u32,
    // The medium outside of the body that the path is in.
    outside: u32,
    throughput: Throughput,
    heroes: Heroes,
    depth: u32,
    // The vertex that the ray starts at, and whether a light sample could have found what it hits.
    origin: ShapeSampleContext,
    is_found_twice: bool,
    // The product of η² over the refractions.
    eta_scale: f32,
    rough_before: bool,
}

// A shadow ray on its way through interfaces, and what it brings.
struct Connection {
    is_on_its_way: bool,
    ray: Ray,
    t_max: f32,
    medium: u32,
    // What the media leave of the light.
    passage: Throughput,
    // The light as if nothing were in between, over the density of its sample; the density of the
    // path over that of the hero; and the density with which scattering finds the light over that
    // of its sample.
    l: vec4f,
    r_u: vec4f,
    ratio: f32,
}

// The light that arrives, weighted against that which scattering finds.
fn arriving(c: Connection, heroes: Heroes) -> vec4f {
    let by_light = mean_of(heroes, c.r_u * c.passage.r_l);
    let by_scattering = mean_of(heroes, c.r_u * c.passage.r_u) * c.ratio;
    if (!(by_light > 0)) {
        return vec4f();
    }
    return c.l * c.passage.beta * (power_heuristic(by_light, by_scattering) / by_light);
}

// The connection of a vertex with a point of a light, from the medium of the path.
fn connection(
    s: Surface,
    bsdf: Bsdf,
    path: Path,
    phase: HenyeyGreenstein,
    in_medium: bool,
    choice: Choice,
    light: LightSample,
) -> Connection {
    var pdf: f32;
    var f: vec4f;
    if (in_medium) {
        pdf = HenyeyGreenstein_p(phase, s.wo, light.wi);
        f = vec4f(pdf);
    } else {
        pdf = bsdf_pdf(bsdf, s.wo, light.wi);
        f = bsdf_f(bsdf, s.wo, light.wi) * abs(dot(light.wi, s.ns));
    }
    let shadow = shadow_ray(s, light);
    let density = choice.pmf * light.pdf;
    let l = path.throughput.beta * f * light.l / density;
    let ratio = select(pdf / density, 0, is_delta(light_record(choice.light)));
    let clear = Throughput(vec4f(1), vec4f(1), vec4f(1));
    let r_u = path.throughput.r_u;
    return Connection(!is_black(l), shadow.ray, shadow.t_max, path.medium, clear, l, r_u, ratio);
}

// What light that only the path's own sampling finds is multiplied by.
fn carried(path: Path) -> vec4f {
    return path.throughput.beta / mean_of(path.heroes, path.throughput.r_u);
}

// The weight of light that a path hits, and that light sampling finds with the density `pdf`.
fn hit_weight(path: Path, light: u32, pdf: f32) -> f32 {
    let by_light = mean_of(path.heroes, path.throughput.r_l) * light_pmf(path.origin, light) * pdf;
    return power_heuristic(mean_of(path.heroes, path.throughput.r_u), by_light);
}

// All light that paths hit is theirs.
fn is_reserved(path: Path) -> bool {
    return false;
}

// Leaves a vertex along a direction of the density `pdf`.
fn leave(path: ptr<function, Path>, s: Surface, context: ShapeSampleContext, wi: vec3f, pdf: f32) {
    (*path).throughput.r_l = (*path).throughput.r_u / pdf;
    (*path).origin = context;
    (*path).ray = spawn(s, wi);
}

// Goes on with the first wavelength alone.
fn keep_first(path: ptr<function, Path>) {
    let density = mean_of((*path).heroes, (*path).throughput.r_u);
    (*path).throughput.beta /= density;
    (*path).throughput.r_l /= density;
    (*path).throughput.r_u = vec4f(1);
    (*path).heroes = Heroes(vec4f(1, 0, 0, 0), 0);
}

// Whether a wavelength is chosen for each way under a surface: that of the path flies there, too.
const CHOOSES_HEROES = false;

fn heroes_under(path: Path, lambda: SampledWavelengths, u: f32) -> Heroes {
    return path.heroes;
}

// Multiplies a path by its way under a surface of index of refraction `eta`.
fn take_way(path: ptr<function, Path>, value: vec4f, density: vec4f, heroes: Heroes, eta: f32) {
    let of_hero = density[heroes.hero];
    (*path).throughput.beta *= value * (eta * eta) / of_hero;
    (*path).throughput.r_u *= density / of_hero;
}

// Plays Russian roulette; false if the path has ended.
fn survives(path: ptr<function, Path>) -> bool {
    let survival = camera_path_survival(carried(*path) * (*path).eta_scale);
    let probability = roulette(survival, (*path).depth);
    (*path).throughput.beta /= probability;
    return probability > 0;
}

// Continues a shadow ray at the end of a segment; the light that it brings if that was the
// last one.
fn follow_shadow(c: ptr<function, Connection>, hit: Hit, s: Surface, flight: Flight, heroes: Heroes) -> vec4f {
    (*c).t_max -= hit.t;
    let has_arrived = !hit.found || (*c).t_max <= 0;
    (*c).is_on_its_way = flight.end != ABSORBED && !has_arrived;
    if ((*c).is_on_its_way) {
        (*c).medium = medium_towards(hit.geometry, s.n, (*c).ray.d, (*c).medium);
        (*c).ray = spawn(s, (*c).ray.d);
        return vec4f();
    }
    return select(arriving(*c, heroes), vec4f(), flight.end == ABSORBED);
}

// Scatters a path at a point in a medium; false if it has ended.
fn scatter_in_medium(
    path: ptr<function, Path>,
    s: Surface,
    context: ShapeSampleContext,
    phase: HenyeyGreenstein,
    u: vec2f,
) -> bool {
    let scattered = HenyeyGreenstein_sample_p(phase, s.wo, u);
    (*path).near = no_differentials();
    (*path).is_found_twice = has_setting(SettingBit_SamplesLights);
    (*path).rough_before = true;
    leave(path, s, context, scattered.v0, scattered.v1);
    return survives(path);
}

// Scatters a path at a surface of a geometry; false if it has ended.
fn scatter(
    path: ptr<function, Path>,
    s: Surface,
    geometry: u32,
    context: ShapeSampleContext,
    bsdf: Bsdf,
    sample: BsdfSample,
    lambda: SampledWavelengths,
) -> bool {
    (*path).throughput.beta *= sample.f * (abs(dot(sample.wi, s.ns)) / sample.pdf);
    if (HAS_SUBSURFACE && enters_body(bsdf, s, sample)) {
        (*path).outside = (*path).medium;
        (*path).medium = 0;
        (*path).near = no_differentials();
        (*path).ray = spawn(s, sample.wi);
        return go_under(path, s, bsdf, lambda);
    }
    let is_specular = (sample.flags & BxdfFlags_SPECULAR) != 0;
    (*path).is_found_twice = !is_specular && has_setting(SettingBit_SamplesLights);
    (*path).rough_before |= !is_specular;
    if ((sample.flags & BxdfFlags_TRANSMISSION) != 0) {
        (*path).eta_scale *= sample.eta * sample.eta;
    }
    (*path).medium = medium_towards(geometry, s.n, sample.wi, (*path).medium);
    leave(path, s, context, sample.wi, density_of_sample(bsdf, s.wo, sample));
    return survives(path);
}

// Shades a path at the end of its ray, or where a medium scatters it before: it adds light to
// `l`, finds the connection of the vertex with a light and the next ray; false if it has ended.
fn shade(
    path: ptr<function, Path>,
    hit: Hit,
    surface: Surface,
    flight: Flight,
    lambda: ptr<function, SampledWavelengths>,
    shadow: ptr<function, Connection>,
    l: ptr<function, vec4f>,
) -> bool {
    var s = surface;
    if (HAS_SUBSURFACE && is_under()) {
        let step = follow_under(path, hit.found, s);
        if (step != LEAVES) {
            return step == GOES_ON;
        }
    }
    // Whether the path leaves here the body that it has entered at the vertex before.
    let is_exit = HAS_SUBSURFACE && emerges();
    if (is_exit) {
        (*path).medium = (*path).outside;
    }
    *l += flight.emitted;
    let in_medium = flight.end == SCATTERED;
    if (flight.end == ABSORBED || (in_medium && (*path).depth == world.max_depth)) {
        return false;
    }
    var bsdf: Bsdf;
    var textures: TextureContext;
    var flags = 0u;
    if (in_medium) {
        s.p = Point3Error(flight.p, vec3f());
        s.n = vec3f();
        s.ns = vec3f();
        s.wo = -(*path).ray.d;
    } else if (is_exit) {
        if (!hit.found) {
            return false;
        }
        s.wo = s.ns;
        textures = texture_context(s, (*path).near);
        bsdf = exit_lobe(s);
        flags = bxdf_flags(bsdf);
    } else {
        if (!hit.found) {
            *l += carried(*path) * escaped(*path, *lambda);
            return false;
        }
        *l += carried(*path) * emitted(*path, s, hit.uv, *lambda);
        if (is_interface(s.material)) {
            (*path).medium = medium_towards(hit.geometry, s.n, (*path).ray.d, (*path).medium);
            pass_interface(path, s, hit.t);
            return true;
        }
        textures = texture_context(s, (*path).near);
        bsdf = bsdf_at(&s, textures, lambda);
        if ((*path).depth == world.max_depth) {
            return false;
        }
        if (SampledWavelengths_secondary_terminated(*lambda)) {
            keep_first(path);
        }
        roughen(&bsdf, (*path).rough_before);
        flags = bxdf_flags(bsdf);
    }
    (*path).depth += select(1u, 0u, is_exit);
    var context = context_of(s);
    if (!in_medium) {
        context = light_context(s, flags);
    }
    let phase = HenyeyGreenstein(number(max((*path).medium, 1) + 1));
    // Random numbers of the light and its point, the collisions of the shadow ray, and the lobe and
    // its direction.
    let samples_light = has_setting(SettingBit_SamplesLights) && (in_medium || is_non_specular(flags));
    var u: array<vec2f, 6>;
    for (var i = select(4u, 0u, samples_light); i < 6; i++) {
        if (!(in_medium && i == 4)) {
            u[i] = next_numbers(i == 1 || i == 5);
        }
    }
    var choice: Choice;
    if (samples_light) {
        choice = choose_light(context, u[0].x);
    }
    if (choice.valid) {
        let light = sample_light(choice.light, context, u[1], *lambda, true);
        if (light.valid) {
            begin_collisions(u[2].x, u[3].x);
            *shadow = connection(s, bsdf, *path, phase, in_medium, choice, light);
            if (!in_medium) {
                (*shadow).medium = medium_towards(hit.geometry, s.n, light.wi, (*path).medium);
            }
        }
    }
    if (in_medium) {
        return scatter_in_medium(path, s, context, phase, u[5]);
    }
    let sample = bsdf_sample(bsdf, s.wo, u[4].x, u[5]);
    if (!sample.valid) {
        return false;
    }
    (*path).near = scattered_differentials(s, textures, (*path).near, sample);
    return scatter(path, s, hit.geometry, context, bsdf, sample, *lambda);
}

fn radiance(ray: Ray, near: Differentials, lambda: ptr<function, SampledWavelengths>) -> vec4f {
    var l = vec4f();
    stay_above();
    var path: Path;
    path.ray = ray;
    path.near = near;
    path.medium = word(world.media);
    path.throughput = Throughput(vec4f(1), vec4f(1), vec4f(1));
    path.heroes = Heroes(vec4f(0.25), min(u32(get_1d() * 4), 3));
    path.eta_scale = 1;
    var shadow: Connection;
    var goes_on = true;
    // Each turn follows a part of the last vertex's shadow ray, until that has ended, or the ray to
    // the next vertex, as what rays meet is found at one place of the program.
    while (shadow.is_on_its_way || goes_on) {
        let is_shadow = shadow.is_on_its_way;
        var part = path.ray;
        var t_max = reach_of_path();
        var medium = path.medium;
        var throughput = path.throughput;
        if (is_shadow) {
            part = shadow.ray;
            t_max = shadow.t_max;
            medium = shadow.medium;
            throughput = shadow.passage;
        }
        let hit = traced(part, t_max, false);
        if (is_shadow && hit.found && !is_interface(word(world.geometries + 8 * hit.geometry))) {
            shadow.is_on_its_way = false;
            continue;
        }
        var s: Surface;
        if (hit.found) {
            s = surface_at(hit, part);
        }
        var flight: Flight;
        if (medium != 0) {
            // Shadow rays to points are as long as the distance.
            let scale = select(1, length(part.d), is_shadow);
            if (!is_shadow) {
                let first = get_1d();
                begin_collisions(first, get_1d());
            }
            let end = select(t_max, hit.t, hit.found) * scale;
            let unit = Ray_new(part.o, part.d / scale, part.time);
            flight = fly(medium, unit, end, is_shadow, path.heroes, *lambda, &throughput);
        }
        if (is_shadow) {
            shadow.passage = throughput;
            l += follow_shadow(&shadow, hit, s, flight, path.heroes);
        } else {
            path.throughput = throughput;
            goes_on = shade(&path, hit, s, flight, lambda, &shadow, &l);
        }
    }
    return l;
}
