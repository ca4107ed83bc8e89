// Subpaths from both ends, and their connections: `integrators/src/bidirectional/`.
//
// Kernels say whether there are camera paths, beside which light paths have a weight, and whether
// these are connected to anything.

// Partial weights of a subpath.
struct Partial {
    vcm: f32,
    vc: f32,
}

struct Vertex {
    p: Point3Error,
    n: vec3f,
    front: f32,
    wo: vec3f,
    bsdf: Bsdf,
    beta: vec4f,
    hero_only: bool,
    partial: Partial,
    depth: u32,
}

// A subpath between two of its vertices.
struct Subpath {
    ray: Ray,
    near: Differentials,
    lambda: SampledWavelengths,
    beta: vec4f,
    // Throughput without the factors η² of refraction, relative to the beginning.
    share: vec4f,
    partial: Partial,
    depth: u32,
    // Where a light path begins.
    origin: LightPoint,
    // Whether the ray goes back to where a light path comes from, to see what is in the way.
    looks_back: bool,
    rough_before: bool,
    goes_on: bool,
}

// A way from a vertex along `wi` to the camera, a light or a vertex: what the light that the vertex
// scatters there is multiplied by, and the densities of other strategies over that of this one,
// by a factor of those that make less of the path of the vertex, and of the density of `wi`.
struct Connection {
    wi: vec3f,
    factor: vec4f,
    back: f32,
    ahead: f32,
    ray: Ray,
    t_max: f32,
    film: vec2f,
    hero_only: bool,
    // Whether no other strategy finds the path, so that it has all the weight.
    is_only: bool,
    valid: bool,
}

// A vertex that a walk has reached, what lights are chosen by there, its lobes, and its textures.
struct Arrival {
    v: Vertex,
    context: ShapeSampleContext,
    flags: u32,
    textures: TextureContext,
}

// The light that a vertex scatters along a direction, and the densities with which its subpath
// continues along it, and one of the other kind that comes from there goes back.
struct Scattered {
    l: vec4f,
    pdf: f32,
    pdf_back: f32,
}

// Whether the subpath has partial weights.
fn has_weights() -> bool {
    return HAS_CAMERA_PATHS && (ARE_CONNECTED || !is_light_path);
}

// The balance heuristic, from the other strategies' densities over that of this one; 0 if their sum
// is no number.
fn balance_heuristic(others: f32) -> f32 {
    let sum = 1 + others;
    let is_finite = (bitcast<u32>(sum) & 0x7fffffffu) < 0x7f800000u;
    return select(0, 1 / sum, is_finite);
}

// Radiance that is known at the first wavelength only.
fn hero_of(l: vec4f, hero_only: bool) -> vec4f {
    return select(l, vec4f(4 * l.x, 0, 0, 0), hero_only);
}

fn back_of(partial: Partial, pdf_back: f32) -> f32 {
    return select(0, partial.vcm + pdf_back * partial.vc, ARE_CONNECTED);
}

fn cos_theta(v: Vertex, w: vec3f) -> f32 {
    return abs(dot(v.n, w));
}

// The cosine that scattering is multiplied by: of light with the correction that keeps its energy.
fn scattering_cosine(v: Vertex, w: vec3f) -> f32 {
    let ns = v.bsdf.frame.z;
    if (v.bsdf.mode == TransportMode_Radiance) {
        return abs(dot(w, ns));
    }
    let cos_wo = cos_theta(v, v.wo);
    return select(abs(dot(v.wo, ns) * dot(w, v.n)) / cos_wo, 0, cos_wo == 0);
}

// The densities of a direction there and back.
fn densities(v: Vertex, w: vec3f) -> vec2f {
    var found: vec2f;
    var bsdf = v.bsdf;
    for (var i = 0u; i < 2; i++) {
        found[i] = bsdf_pdf(bsdf, select(w, v.wo, i == 0), select(v.wo, w, i == 0));
        bsdf.mode = 1 - bsdf.mode;
    }
    return found;
}

fn scattered_along(v: Vertex, w: vec3f) -> Scattered {
    let l = v.beta * bsdf_f(v.bsdf, v.wo, w) * scattering_cosine(v, w);
    if (!has_weights() || is_black(l)) {
        return Scattered(l, 0, 0);
    }
    let pdf = densities(v, w);
    return Scattered(l, pdf.x, pdf.y);
}

fn light_subpath(lambda: SampledWavelengths) -> Subpath {
    var walk: Subpath;
    // What chooses the light, its point and the direction.
    var u: array<vec2f, 3>;
    for (var i = 0u; i < 3; i++) {
        u[i] = next_numbers(i > 0);
    }
    let emission = emit(u[0].x, u[1], u[2], lambda);
    walk.ray = emission.ray;
    walk.lambda = lambda;
    walk.beta = emission.beta;
    walk.share = vec4f(1);
    walk.origin = emission.origin;
    walk.looks_back = emission.origin.is_distant && word(world.light_paths + 3) == 1;
    if (walk.looks_back) {
        walk.ray.d = -walk.ray.d;
    }
    walk.goes_on = emission.valid;
    return walk;
}

fn camera_subpath(camera: CameraSample) -> Subpath {
    var walk: Subpath;
    walk.ray = camera.ray;
    walk.near = camera.near;
    walk.lambda = camera.lambda;
    walk.beta = vec4f(1);
    walk.share = vec4f(1);
    if (HAS_CAMERA_PATHS) {
        let seen = seen_from_camera(camera.ray);
        let pdf = select(seen.pdf_direction, seen.pdf_position, is_parallel());
        walk.partial.vcm = count_of_light_paths() / pdf;
    }
    walk.goes_on = true;
    return walk;
}

// The weighted light of the lights that a camera path hits; `before` is its last vertex.
fn lights_met(walk: Subpath, before: ShapeSampleContext, hit: Hit, s: Surface) -> vec4f {
    var sum = vec4f();
    let wi = walk.ray.d;
    let count = select(world.infinite_count, min(s.light, 1), hit.found);
    for (var i = 0u; i < count; i++) {
        var point: LightPoint;
        var l: vec4f;
        if (hit.found) {
            point = LightPoint(s.light - 1, s.p.p, s.n, hit.uv, false);
            l = light_radiance(light_record(point.light), s, walk.lambda);
        } else {
            point.light = word(world.infinite + i);
            point.is_distant = true;
            l = sky(point.light, walk.ray.o, wi, walk.lambda).l;
        }
        var weight = 1.0;
        if (HAS_CAMERA_PATHS && walk.depth > 0 && !is_black(l)) {
            var direct = 0.0;
            if (walk.partial.vcm != 0) {
                direct = direct_pdf(point, before, wi);
            }
            let end = light_end(point, before.p.p, wi, direct);
            let by_light = select(0, end.emission / end.cos_theta * walk.partial.vc, ARE_CONNECTED);
            weight = balance_heuristic(end.direct * walk.partial.vcm + by_light);
        }
        sum += hero_of(walk.beta * l, SampledWavelengths_secondary_terminated(walk.lambda)) * weight;
    }
    return sum;
}

// The partial weights at the vertex that a walk has reached.
fn partial_at(walk: Subpath, t: f32, v: Vertex, context: ShapeSampleContext) -> Partial {
    let cosine = cos_theta(v, v.wo);
    if (is_light_path && walk.depth == 1) {
        let direct = direct_pdf(walk.origin, context, v.wo);
        let end = light_end(walk.origin, context.p.p, v.wo, direct);
        let scale = end.cos_theta / (end.emission * cosine);
        return Partial(direct * scale, select(scale, 0, end.is_delta));
    }
    let squared = select(t * t, 1, is_parallel() && walk.depth == 1);
    return Partial(walk.partial.vcm * squared / cosine, walk.partial.vc / cosine);
}

fn connection_to_camera(v: Vertex, u: vec2f) -> Connection {
    var c: Connection;
    let lens = sample_lens(v.p.p, u);
    if (!lens.seen.valid || !is_reached(lens.seen.film)) {
        return c;
    }
    c.wi = lens.wi;
    if (v.front * dot(v.n, c.wi) < 0) {
        return c;
    }
    c.factor = vec4f(lens.we);
    let way = lens.p - v.p.p;
    let density = select(lens.seen.pdf_direction / dot(way, way), lens.seen.pdf_position, is_parallel());
    c.back = density * cos_theta(v, c.wi) / count_of_light_paths();
    c.ray = Ray_between(v.p, v.n, Point3Error(lens.p, vec3f()), lens.seen.n, 0);
    c.ray.camera = CameraEnd_Target;
    c.t_max = 0.9999;
    c.film = lens.seen.film;
    c.valid = true;
    return c;
}

fn connection_to_light(
    v: Vertex,
    context: ShapeSampleContext,
    lambda: SampledWavelengths,
    u: f32,
    u_light: vec2f,
) -> Connection {
    var c: Connection;
    let choice = choose_light(context, u);
    if (!choice.valid) {
        return c;
    }
    let light = sample_light(choice.light, context, u_light, lambda, false);
    if (!light.valid) {
        return c;
    }
    let pdf = choice.pmf * light.pdf;
    let is_point = !light.is_distant && all(light.n == vec3f());
    let direct = select(pdf, choice.pmf * Vec3_length_squared(light.p.p - v.p.p), is_point);
    let point = LightPoint(choice.light, light.p.p, light.n, light.uv, light.is_distant);
    let end = light_end(point, context.p.p, light.wi, direct);
    c.wi = light.wi;
    c.factor = light.l / pdf;
    c.back = end.emission * cos_theta(v, c.wi) / (direct * end.cos_theta);
    c.ahead = select(1 / direct, 0, end.is_delta);
    c.ray = Ray_between(v.p, v.n, light.p, light.n, 0);
    c.t_max = 0.9999;
    if (light.is_distant) {
        c.ray = Ray_spawn(v.p, v.n, c.wi, 0);
        c.t_max = infinity();
    }
    c.valid = true;
    return c;
}

// The way to a vertex of the light path, but for what that scatters.
fn connection_to_vertex(v: Vertex, other: Vertex) -> Connection {
    var c: Connection;
    let way = other.p.p - v.p.p;
    let squared = Vec3_length_squared(way);
    c.wi = way / sqrt(squared);
    c.factor = vec4f(1 / squared);
    c.back = cos_theta(v, c.wi) / squared;
    c.ahead = cos_theta(other, c.wi) / squared;
    c.ray = Ray_between(v.p, v.n, other.p, other.n, 0);
    c.t_max = 0.9999;
    c.hero_only = other.hero_only;
    c.valid = v.depth + other.depth <= world.max_depth;
    return c;
}

// The weighted light of a connection of a vertex, at the other end of which is a vertex, too, or
// not; black where something is in the way.
fn light_along(connection: Connection, v: Vertex, is_vertex: bool, other: Vertex) -> vec4f {
    var c = connection;
    // What the other vertex scatters, if there is one, and then this one.
    var others = 0.0;
    for (var end = select(1u, 0u, is_vertex); end < 2 && c.valid; end++) {
        var at = v;
        var w = c.wi;
        if (ARE_CONNECTED && end == 0) {
            at = other;
            w = -w;
        }
        let found = scattered_along(at, w);
        c.factor *= found.l;
        c.valid = !is_black(c.factor) && all(abs(c.factor) < vec4f(infinity()));
        if (end == 0) {
            c.back *= found.pdf;
            c.ahead *= back_of(at.partial, found.pdf_back);
        } else {
            others = c.back * back_of(v.partial, found.pdf_back) + c.ahead * found.pdf;
        }
    }
    if (!c.valid || occluded(c.ray, c.t_max)) {
        return vec4f();
    }
    let l = hero_of(c.factor, v.hero_only || c.hero_only);
    if (!HAS_CAMERA_PATHS || c.is_only) {
        return l;
    }
    return l * balance_heuristic(others);
}

// The vertex where a walk has hit a surface at the distance `t`.
fn arrive(walk: ptr<function, Subpath>, s: ptr<function, Surface>, t: f32) -> Arrival {
    let textures = texture_context(*s, (*walk).near);
    var lambda = (*walk).lambda;
    var bsdf = bsdf_at(s, textures, &lambda);
    (*walk).lambda = lambda;
    bsdf.mode = select(TransportMode_Radiance, TransportMode_Importance, is_light_path);
    if (has_setting(SettingBit_Regularizes) && (*walk).rough_before) {
        regularize(&bsdf);
    }
    (*walk).depth++;
    let flags = bxdf_flags(bsdf);
    let context = light_context(*s, flags);
    let hero_only = SampledWavelengths_secondary_terminated(lambda);
    let beta = (*walk).beta;
    var v = Vertex((*s).p, (*s).n, (*s).front, (*s).wo, bsdf, beta, hero_only, Partial(), (*walk).depth);
    if (has_weights()) {
        v.partial = partial_at(*walk, t, v, context);
    }
    return Arrival(v, context, flags, textures);
}

// Leaves a vertex along a direction that `uc` and `u` choose; the walk may end there.
fn leave(walk: ptr<function, Subpath>, arrival: Arrival, s: Surface, uc: f32, u: vec2f) {
    let v = arrival.v;
    let sample = bsdf_sample(v.bsdf, s.wo, uc, u);
    (*walk).goes_on = sample.valid;
    if (!sample.valid) {
        return;
    }
    (*walk).near = scattered_differentials(s, arrival.textures, (*walk).near, sample);
    let cosine = cos_theta(v, sample.wi);
    let is_specular = (sample.flags & BxdfFlags_SPECULAR) != 0;
    if (has_weights() && is_specular) {
        (*walk).partial = Partial(0, v.partial.vc * cosine);
    } else if (has_weights()) {
        let pdf = densities(v, sample.wi);
        let ahead = select(sample.pdf, pdf.x, sample.pdf_is_proportional);
        (*walk).partial = Partial(1 / ahead, cosine / ahead * back_of(v.partial, pdf.y));
    }
    (*walk).rough_before |= !is_specular;
    let scale = sample.f * (scattering_cosine(v, sample.wi) / sample.pdf);
    (*walk).beta *= scale;
    (*walk).share *= scale;
    if (!is_light_path && (sample.flags & BxdfFlags_TRANSMISSION) != 0) {
        (*walk).share *= sample.eta * sample.eta;
    }
    (*walk).ray = Ray_spawn(v.p, v.n, sample.wi, 0);
    (*walk).goes_on = !is_black((*walk).beta);
}

// Plays Russian roulette.
fn survive(walk: ptr<function, Subpath>) {
    if (!(*walk).goes_on) {
        return;
    }
    let probability = roulette(SampledSpectrum_max_component((*walk).share), (*walk).depth);
    (*walk).goes_on = probability > 0;
    (*walk).beta /= probability;
    (*walk).share /= probability;
}

// Whether a walk has looked back to where its light path comes from. Then it turns around, and goes
// on if nothing was in the way.
fn looked_back(walk: ptr<function, Subpath>, hit: Hit) -> bool {
    if (!(*walk).looks_back) {
        return false;
    }
    (*walk).looks_back = false;
    (*walk).ray.d = -(*walk).ray.d;
    (*walk).goes_on = !hit.found;
    return true;
}
