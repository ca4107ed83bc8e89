// Light paths that are connected to the camera and, with camera paths, bidirectional path tracing:
// `integrators/src/bidirectional/`.
//
// A thread makes a light path and then a camera path by one loop, so that drivers, which inline all
// calls, have each long function once. Contributions to the film of light paths go to a list.

// Paths of this survival probability or more survive.
const CERTAIN = 0.999;

// Light that arrives somewhere on the film, from the light path of a pixel of the batch.
struct Splat {
    film: vec2f,
    path: u32,
    unused: u32,
    l: vec4f,
}

// A rectangle of pixels, the index of the sample of each, and splats with their number, of which
// there is room for `most`.
struct Batch {
    low: vec2u,
    size: vec2u,
    index: u32,
    most: u32,
    count: atomic<u32>,
    unused: u32,
    splats: array<Splat>,
}

// What is found for a pixel: radiance and the number of rays.
struct Sample {
    l: vec4f,
    rays: u32,
    is_terminated: u32,
    unused: vec2u,
}

@group(0) @binding(5) var<storage, read_write> batch: Batch;
@group(0) @binding(6) var<storage, read_write> samples: array<Sample>;

// Partial weights of a subpath.
struct Partial {
    vcm: f32,
    vc: f32,
}

struct Vertex {
    p: Point3Error,
    n: vec3f,
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
    valid: bool,
}

// The light that a vertex scatters along a direction, and the densities with which its subpath
// continues along it, and one of the other kind that comes from there goes back.
struct Scattered {
    l: vec4f,
    pdf: f32,
    pdf_back: f32,
}

var<private> light_vertices: array<Vertex, MOST_VERTICES>;

// The balance heuristic, from the other strategies' densities over that of this one; 0 if their sum
// is no number.
fn balance(others: f32) -> f32 {
    let sum = 1 + others;
    let is_finite = (bitcast<u32>(sum) & 0x7fffffffu) < 0x7f800000u;
    return select(0, 1 / sum, is_finite);
}

// Radiance that is known at the first wavelength only.
fn hero_of(l: vec4f, hero_only: bool) -> vec4f {
    return select(l, vec4f(4 * l.x, 0, 0, 0), hero_only);
}

fn back_of(partial: Partial, pdf_back: f32) -> f32 {
    return partial.vcm + pdf_back * partial.vc;
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
    if (!HAS_CAMERA_PATHS || is_black(l)) {
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
    walk.looks_back = emission.origin.is_distant && tables[world.light_paths + 3] == 1;
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
            l = light_radiance(light_record(point.light), s.n, s.wo, walk.lambda);
        } else {
            point.light = tables[world.infinite + i];
            point.is_distant = true;
            l = sky(point.light, wi, walk.lambda).l;
        }
        var weight = 1.0;
        if (HAS_CAMERA_PATHS && walk.depth > 0 && !is_black(l)) {
            var direct = 0.0;
            if (walk.partial.vcm != 0) {
                direct = direct_pdf(point, before, wi);
            }
            let end = light_end(point, before.p.p, wi, direct);
            weight = balance(end.direct * walk.partial.vcm + end.emission / end.cos_theta * walk.partial.vc);
        }
        sum += hero_of(walk.beta * l, SampledWavelengths_secondary_terminated(walk.lambda)) * weight;
    }
    return sum;
}

// The partial weights at the vertex that a walk has reached.
fn arrived(walk: Subpath, t: f32, v: Vertex, context: ShapeSampleContext) -> Partial {
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
    c.factor = vec4f(lens.we);
    let way = lens.p - v.p.p;
    let density = select(lens.seen.pdf_direction / dot(way, way), lens.seen.pdf_position, is_parallel());
    c.back = density * cos_theta(v, c.wi) / count_of_light_paths();
    c.ray = Ray_between(v.p, v.n, Point3Error(lens.p, vec3f()), lens.seen.n, 0);
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
    let point = LightPoint(choice.light, light.p.p, light.n, vec2f(), light.is_distant);
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

// The weighted light of all connections of a vertex, the first of which `u` chooses and the point
// at its other end `u_point`; that of one to the camera is splatted.
fn connected(
    v: Vertex,
    context: ShapeSampleContext,
    lambda: SampledWavelengths,
    u: f32,
    u_point: vec2f,
    count: u32,
    path: u32,
) -> vec4f {
    var sum = vec4f();
    for (var i = 0u; i <= count; i++) {
        var c: Connection;
        var other: Vertex;
        let is_vertex = HAS_CAMERA_PATHS && i > 0;
        if (is_light_path) {
            c = connection_to_camera(v, u_point);
        } else if (!is_vertex) {
            c = connection_to_light(v, context, lambda, u, u_point);
        } else {
            other = light_vertices[i - 1];
            c = connection_to_vertex(v, other);
        }
        // What the other vertex scatters, if there is one, and then this one.
        var others = 0.0;
        for (var end = select(1u, 0u, is_vertex); end < 2 && c.valid; end++) {
            var at = v;
            var w = c.wi;
            if (HAS_CAMERA_PATHS && end == 0) {
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
            continue;
        }
        var l = hero_of(c.factor, v.hero_only || c.hero_only);
        if (HAS_CAMERA_PATHS) {
            l *= balance(others);
        }
        if (is_light_path) {
            let place = atomicAdd(&batch.count, 1u);
            if (place < batch.most) {
                batch.splats[place] = Splat(c.film, path, 0, l);
            }
        } else {
            sum += l;
        }
    }
    return sum;
}

// Leaves a vertex along a sample; the walk may end there.
fn leave(walk: ptr<function, Subpath>, v: Vertex, sample: BsdfSample) {
    let cosine = cos_theta(v, sample.wi);
    let is_specular = (sample.flags & BxdfFlags_SPECULAR) != 0;
    if (HAS_CAMERA_PATHS && is_specular) {
        (*walk).partial = Partial(0, v.partial.vc * cosine);
    } else if (HAS_CAMERA_PATHS) {
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
    let probability = SampledSpectrum_max_component((*walk).share);
    if (!(*walk).goes_on || (*walk).depth <= 1 || probability >= CERTAIN) {
        return;
    }
    (*walk).goes_on = probability > 0 && get_1d() < probability;
    (*walk).beta /= probability;
    (*walk).share /= probability;
}

// The light of the paths of a pixel, but for what they splat.
fn light_of(camera: CameraSample, path: u32) -> vec4f {
    var l = vec4f();
    let camera_place = place;
    place.dimension = 0;
    is_light_path = true;
    var walk = light_subpath(camera.lambda);
    var count = 0u;
    var before: ShapeSampleContext;
    loop {
        if (!walk.goes_on || is_light_path && walk.depth == world.max_depth) {
            if (!is_light_path) {
                break;
            }
            is_light_path = false;
            place = camera_place;
            walk = camera_subpath(camera);
        }
        let hit = nearest(walk.ray);
        if (walk.looks_back) {
            walk.looks_back = false;
            walk.ray.d = -walk.ray.d;
            walk.goes_on = !hit.found;
            continue;
        }
        var s: Surface;
        if (hit.found) {
            s = surface_at(hit, walk.ray);
        }
        if (!is_light_path) {
            l += lights_met(walk, before, hit, s);
        }
        walk.goes_on = hit.found && (is_light_path || HAS_CAMERA_PATHS && walk.depth < world.max_depth);
        if (!walk.goes_on) {
            continue;
        }
        let textures = texture_context(s, walk.near);
        var lambda = walk.lambda;
        var bsdf = bsdf_at(&s, textures, &lambda);
        walk.lambda = lambda;
        bsdf.mode = select(TransportMode_Radiance, TransportMode_Importance, is_light_path);
        if (world.regularize == 1 && walk.rough_before) {
            regularize(&bsdf);
        }
        walk.depth++;
        let flags = bsdf_flags(bsdf);
        let context = light_context(s, flags);
        let hero_only = SampledWavelengths_secondary_terminated(walk.lambda);
        var v = Vertex(s.p, s.n, s.wo, bsdf, walk.beta, hero_only, Partial(), walk.depth);
        if (HAS_CAMERA_PATHS) {
            v.partial = arrived(walk, hit.t, v, context);
        }
        // What chooses the light and its point, or the point of the lens, and the lobe and its
        // direction.
        var u: array<vec2f, 4>;
        let connects = is_non_specular(flags);
        for (var i = select(2u, u32(is_light_path), connects); i < 4; i++) {
            u[i] = next_numbers((i & 1) == 1);
        }
        if (connects) {
            let others = select(count, 0, is_light_path);
            l += connected(v, context, camera.lambda, u[0].x, u[1], others, path);
            if (HAS_CAMERA_PATHS && is_light_path && walk.depth < world.max_depth) {
                light_vertices[count] = v;
                count++;
            }
        }
        let sample = bsdf_sample(bsdf, s.wo, u[2].x, u[3]);
        walk.goes_on = sample.valid;
        if (sample.valid) {
            walk.near = scattered_differentials(s, textures, walk.near, sample);
            before = context;
            leave(&walk, v, sample);
        }
    }
    return l;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= batch.size)) {
        return;
    }
    let camera = camera_sample(batch.low + id.xy, batch.index);
    let path = id.y * batch.size.x + id.x;
    rays = 0;
    let l = light_of(camera, path);
    samples[path] = Sample(l, rays, 0, vec2u());
}
