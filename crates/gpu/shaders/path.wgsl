// Path tracing with next-event estimation, multiple importance sampling and Russian roulette.

// A path between two of its vertices.
struct Path {
    ray: Ray,
    near: Differentials,
    beta: vec4f,
    depth: u32,
    // The vertex that the ray starts at, the density of its direction, and whether a light sample
    // could have found what it hits.
    origin: ShapeSampleContext,
    pdf: f32,
    is_found_twice: bool,
    // The product of η² over the refractions.
    eta_scale: f32,
    rough_before: bool,
}

// The weight of light that a path hits, and that light sampling finds with the density `pdf`.
fn hit_weight(path: Path, light: u32, pdf: f32) -> f32 {
    return power_heuristic(path.pdf, light_pmf(path.origin, light) * pdf);
}

// Whether what a path hits is direct light of its first surface that reservoirs have.
fn is_reserved(path: Path) -> bool {
    return HAS_RESERVOIRS && path.depth == 1 && path.is_found_twice;
}

// Whether a wavelength is chosen for each way under a surface.
const CHOOSES_HEROES = true;

// The wavelength chosen by `u` in proportion to the throughput; the first once dispersion has
// terminated the others.
fn heroes_under(path: Path, lambda: SampledWavelengths, u: f32) -> Heroes {
    let beta = path.beta;
    let sum = beta.x + beta.y + beta.z + beta.w;
    if (SampledWavelengths_secondary_terminated(lambda) || !(sum > 0 && sum < infinity())) {
        return Heroes(vec4f(1, 0, 0, 0), 0);
    }
    let probabilities = beta / sum;
    var hero = 0u;
    var rest = u;
    while (hero < 3 && rest >= probabilities[hero]) {
        rest -= probabilities[hero];
        hero++;
    }
    while (hero > 0 && probabilities[hero] == 0) {
        hero--;
    }
    return Heroes(probabilities, hero);
}

// Multiplies a path by its way under a surface of index of refraction `eta`.
fn take_way(path: ptr<function, Path>, value: vec4f, density: vec4f, heroes: Heroes, eta: f32) {
    (*path).beta *= value * (eta * eta) / mean_of(heroes, density);
    (*path).eta_scale /= eta * eta;
}

// Leaves a vertex along a direction of its BSDF.
fn scatter(path: ptr<function, Path>, s: Surface, context: ShapeSampleContext, sample: BsdfSample, pdf: f32) {
    (*path).beta *= sample.f * (abs(dot(sample.wi, s.ns)) / sample.pdf);
    (*path).origin = context;
    (*path).pdf = pdf;
    let is_specular = (sample.flags & BxdfFlags_SPECULAR) != 0;
    (*path).is_found_twice = !is_specular;
    (*path).rough_before |= !is_specular;
    if ((sample.flags & BxdfFlags_TRANSMISSION) != 0) {
        (*path).eta_scale *= sample.eta * sample.eta;
    }
    (*path).ray = spawn(s, sample.wi);
}

// Plays Russian roulette; false if the path has ended.
fn survives(path: ptr<function, Path>) -> bool {
    let survival = camera_path_survival((*path).beta * (*path).eta_scale);
    let probability = roulette(survival, (*path).depth);
    (*path).beta /= probability;
    return probability > 0;
}

// A path that begins with a camera ray.
fn new_path(ray: Ray, near: Differentials) -> Path {
    stay_above();
    var path: Path;
    path.ray = ray;
    path.near = near;
    path.beta = vec4f(1);
    path.eta_scale = 1;
    return path;
}

// What a path does at the end of its ray: it adds light to `l`, finds the direct light of the point
// and the next ray; false if it has ended.
fn shade(
    path: ptr<function, Path>,
    hit: Hit,
    lambda: ptr<function, SampledWavelengths>,
    direct: ptr<function, DirectLight>,
    l: ptr<function, vec4f>,
) -> bool {
    (*direct).l = vec4f();
    var s: Surface;
    if (hit.found) {
        s = surface_at(hit, (*path).ray);
    }
    if (HAS_SUBSURFACE && is_under()) {
        let step = follow_under(path, hit.found, s);
        if (step != LEAVES) {
            return step == GOES_ON;
        }
    }
    // Whether the point is where the path leaves a body that it has entered at the vertex before.
    let is_exit = HAS_SUBSURFACE && emerges();
    if (!hit.found) {
        if (!is_exit) {
            *l += (*path).beta * escaped(*path, *lambda);
        }
        return false;
    }
    let textures = texture_context(s, (*path).near);
    var bsdf: Bsdf;
    if (is_exit) {
        s.wo = s.ns;
        bsdf = exit_lobe(s);
    } else {
        *l += (*path).beta * emitted(*path, s, hit.uv, *lambda);
        if (HAS_MEDIA && is_interface(s.material)) {
            pass_interface(path, s, hit.t);
            return true;
        }
        bsdf = bsdf_at(&s, textures, lambda);
        if ((*path).depth == world.max_depth) {
            return false;
        }
        (*path).depth++;
        roughen(&bsdf, (*path).rough_before);
    }
    let flags = bxdf_flags(bsdf);
    let context = light_context(s, flags);
    // Random numbers of the light and its point, and the lobe and its direction.
    var u: array<vec2f, 4>;
    let samples_light = is_non_specular(flags) && !(HAS_RESERVOIRS && (*path).depth == 1);
    for (var i = select(2u, 0u, samples_light); i < 4; i++) {
        u[i] = next_numbers((i & 1) == 1);
    }
    if (samples_light) {
        *direct = direct_light(s, context, bsdf, *lambda, u[0].x, u[1]);
        (*direct).l *= (*path).beta;
    }
    let sample = bsdf_sample(bsdf, s.wo, u[2].x, u[3]);
    if (!sample.valid) {
        return false;
    }
    (*path).near = scattered_differentials(s, textures, (*path).near, sample);
    scatter(path, s, context, sample, density_of_sample(bsdf, s.wo, sample));
    if (HAS_SUBSURFACE && enters_body(bsdf, s, sample)) {
        (*path).near = no_differentials();
        return go_under(path, s, bsdf, *lambda);
    }
    return survives(path);
}
