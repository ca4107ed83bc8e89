// Paths that go on under the surface of a body, and leave it elsewhere, as
// `integrators/src/transport/subsurface/` has it: by a probe of the diffusion profile, or by a
// random walk.
//
// The rays under the surface are those of the path, so that they are traced where all others are.
// When a probe has met all of the body and one of its points is chosen, the ray to this one is
// traced again.

// Where a path is: above all surfaces, on a probe, on the ray to the chosen point, or on a walk.
const ABOVE = 0u;
const PROBING = 1u;
const EMERGING = 2u;
const WALKING = 3u;

// What a ray under a surface leads to: another one, the end of the path, or the light of day.
const GOES_ON = 0u;
const IS_LOST = 1u;
const LEAVES = 2u;

// The number of events after which a walk ends.
const MAX_EVENTS = 16384u;

// Probabilities of probes along the axes of the frame, of which the last is the normal.
const AXES = vec3f(0.25, 0.25, 0.5);

// The share of the profile that probes reach.
const REACHED = 0.999;

// A path under a surface.
struct Under {
    state: u32,
    material: u32,
    // The medium: extinction, albedo, mean cosine, and index of refraction.
    sigma_t: vec4f,
    albedo: vec4f,
    g: f32,
    eta: f32,
    // How it is left: the kind of the BSDF where it was entered, its record, and the surface.
    kind: u32,
    record: u32,
    surface: OpenPbr,
    heroes: Heroes,
    // Of a probe where it enters, the frame there, and the end; of a walk where its flight began.
    p: vec3f,
    frame: Frame,
    end: vec3f,
    // The length of the next ray.
    reach: f32,
    generator: Generator,
    // The points that a probe has met, and the chosen one: its ray's origin, it, and its normal.
    met: u32,
    kept_o: vec3f,
    kept_p: vec3f,
    kept_n: vec3f,
    // Of a walk the next random number, the free distance, and contribution and densities over the
    // density of the hero.
    u: f32,
    free: f32,
    value: vec4f,
    density: vec4f,
    events: u32,
}

var<private> under: Under;

// The length of the next ray of a path.
fn reach_of_path() -> f32 {
    if (HAS_SUBSURFACE && is_under()) {
        return under.reach;
    }
    return infinity();
}

// Puts a path above all surfaces.
fn stay_above() {
    if (HAS_SUBSURFACE) {
        under.state = ABOVE;
    }
}

fn is_under() -> bool {
    return under.state == PROBING || under.state == WALKING;
}

// Whether the point that has been hit is the one where the path leaves its body.
fn emerges() -> bool {
    let is_there = under.state == EMERGING;
    under.state = ABOVE;
    return is_there;
}

// How a path leaves its body.
fn exit_lobe(s: Surface) -> Bsdf {
    var bsdf: Bsdf;
    bsdf.frame = Frame_from_z_and_x(s.ns, s.ss);
    bsdf.eta = under.eta;
    if (under.kind == MaterialTag_Principled) {
        bsdf.kind = MaterialTag_Principled;
        bsdf.surface = entering_part(under.surface);
    } else {
        bsdf.kind = MaterialTag_Exit;
        bsdf.record = under.record;
    }
    return bsdf;
}

// The profiles at a distance, and their densities.
fn profiles_at(r: f32) -> array<vec4f, 2> {
    var values: vec4f;
    var densities: vec4f;
    for (var i = 0; i < 4; i++) {
        let sigma_t = under.sigma_t[i];
        let found = profile_at(table_of(under.record), under.albedo[i], r * sigma_t) * (sigma_t * sigma_t);
        values[i] = found.x;
        densities[i] = found.y;
    }
    return array(values, densities);
}

// A distance with the density of the profile of the hero; negative without a profile.
fn sampled_radius(u: f32) -> f32 {
    let table = table_of(under.record);
    let count = word(table + 1);
    let radii = word(table + 2);
    let nodes = table + 5 + count;
    let profile = nodes + radii + count;
    let cdf = profile + count * radii;
    let hero = under.heroes.hero;
    let rows = spline_place(table + 5, count, under.albedo[hero]);
    let total = spline_sum(rows, cdf + radii - 1, radii);
    if (!(rows.valid && total > 0)) {
        return -1;
    }
    let y = u * total;
    var low = 0u;
    var high = radii - 1;
    while (high - low > 1) {
        let middle = (low + high) / 2;
        if (spline_sum(rows, cdf + middle, radii) <= y) {
            low = middle;
        } else {
            high = middle;
        }
    }
    var values: vec4f;
    for (var i = 0u; i < 4; i++) {
        values[i] = spline_sum(rows, profile + min(max(low + i, 1) - 1, radii - 1), radii);
    }
    let segment = spline_segment(nodes, radii, low, values);
    let part = (y - spline_sum(rows, cdf + low, radii)) / segment.width;
    // Newton's method starts where a straight line would be.
    let rise = values.z - values.y;
    let start = 2 * part / (values.y + sqrt(max(values.y * values.y + 2 * part * rise, 0)));
    let radius = solved(segment, part, start, true) / under.sigma_t[hero];
    return select(-1, radius, radius < infinity());
}

// Whether a path from the camera enters a body by a sample of its boundary.
fn enters_body(bsdf: Bsdf, s: Surface, sample: BsdfSample) -> bool {
    let is_diffuse = (sample.flags & BxdfFlags_DIFFUSE) != 0;
    let is_body = bsdf.kind == MaterialTag_Principled && is_diffuse && !is_black(openpbr_extinction(bsdf.surface));
    let passes = dot(s.wo, s.ns) > 0 && (sample.flags & BxdfFlags_TRANSMISSION) != 0;
    return passes && (is_body || bsdf.kind == MaterialTag_Boundary);
}

// Leads a path, whose ray has entered a body, under its surface; false if it ends.
fn go_under(path: ptr<function, Path>, s: Surface, bsdf: Bsdf, lambda: SampledWavelengths) -> bool {
    let is_principled = bsdf.kind == MaterialTag_Principled;
    let walks = is_principled || walks_under(bsdf.record);
    // What chooses the hero, and the axis and the place of the probe and one of its points, or the
    // first flight of a walk and all that follows.
    var u: array<vec2f, 4>;
    for (var i = select(1u, 0u, CHOOSES_HEROES); i < select(4u, 3u, walks); i++) {
        u[i] = next_numbers(i == 2 && !walks);
    }
    under.heroes = heroes_under(*path, lambda, u[0].x);
    under.material = s.material;
    under.kind = bsdf.kind;
    if (is_principled) {
        under.surface = bsdf.surface;
        under.sigma_t = openpbr_extinction(bsdf.surface);
        under.albedo = openpbr_albedo(bsdf.surface);
        under.g = openpbr_asymmetry(bsdf.surface);
        under.eta = 1;
    } else {
        under.record = bsdf.record;
        under.sigma_t = bsdf.sigma_t;
        under.albedo = bsdf.albedo;
        under.g = asymmetry_under(bsdf.record);
        under.eta = bsdf.eta;
    }
    if (walks) {
        under.state = WALKING;
        under.generator = generator(hash_of_pair(bitcast<vec2u>(vec2f(u[1].x, u[2].x))));
        under.u = u[1].x;
        under.value = vec4f(1);
        under.density = vec4f(1);
        under.events = 0;
        return begin_flight((*path).ray);
    }
    under.state = PROBING;
    under.generator = generator(hash_of_word(bitcast<u32>(u[3].x)));
    under.met = 0;
    under.p = s.p.p;
    under.frame = Frame_from_z(s.ns);
    var across = array(under.frame.x, under.frame.y);
    var along = under.frame.z;
    if (u[1].x < AXES.x) {
        across = array(under.frame.y, under.frame.z);
        along = under.frame.x;
    } else if (u[1].x < AXES.x + AXES.y) {
        across = array(under.frame.z, under.frame.x);
        along = under.frame.y;
    }
    var radii: vec2f;
    for (var i = 0; i < 2; i++) {
        radii[i] = sampled_radius(select(u[2].x, REACHED, i == 1));
    }
    if (!(radii.x >= 0 && radii.x < radii.y)) {
        return false;
    }
    let half = sqrt(max(radii.y * radii.y - radii.x * radii.x, 0));
    let turn = sin_cos(6.2831855 * u[2].y);
    let start = across[0] * (radii.x * turn.v1) + across[1] * (radii.x * turn.v0) - along * half;
    (*path).ray = Ray_new(s.p.p + start, along, shutter_time);
    under.end = (*path).ray.o + along * (2 * half);
    under.reach = 2 * half;
    return under.reach > 0;
}

// What the end of a ray under a surface leads to; `s` is the point that was hit, if any was.
fn follow_under(path: ptr<function, Path>, is_hit: bool, s: Surface) -> u32 {
    if (under.state == WALKING) {
        return follow_walk(path, is_hit, s);
    }
    if (is_hit) {
        let ray = (*path).ray;
        if (s.material == under.material) {
            under.met++;
            var from_ = under.generator;
            if (unit_interval(generated_word(&from_)) * f32(under.met) < 1) {
                under.kept_o = ray.o;
                under.kept_p = s.p.p;
                under.kept_n = s.n;
            }
            under.generator = from_;
        }
        (*path).ray = spawn(s, ray.d);
        under.reach = dot(under.end - (*path).ray.o, ray.d);
        if (under.reach > 0) {
            return GOES_ON;
        }
    }
    if (under.met == 0) {
        return IS_LOST;
    }
    let d = under.kept_p - under.p;
    let away = Frame_to_local(under.frame, d);
    let cosines = abs(Frame_to_local(under.frame, under.kept_n)) * AXES;
    let distances = vec4f(length(away.yz), length(away.zx), length(away.xy), length(d));
    var value: vec4f;
    var density: vec4f;
    for (var i = 0; i < 4; i++) {
        let found = profiles_at(distances[i]);
        if (i < 3) {
            density += found[1] * cosines[i];
        } else {
            value = found[0];
        }
    }
    (*path).ray.o = under.kept_o;
    under.state = EMERGING;
    return select(IS_LOST, GOES_ON, takes_exit(path, value, density / f32(under.met)));
}

// Multiplies a path by its way under a surface; false if it ends.
fn takes_exit(path: ptr<function, Path>, value: vec4f, density: vec4f) -> bool {
    if (!(density[under.heroes.hero] > 0) || is_black(value)) {
        return false;
    }
    take_way(path, value, density, under.heroes, under.eta);
    return true;
}

fn walk_number() -> f32 {
    var from_ = under.generator;
    let u = unit_interval(generated_word(&from_));
    under.generator = from_;
    return u;
}

// Begins the next flight of a walk; false if there have been too many.
fn begin_flight(ray: Ray) -> bool {
    under.p = ray.o;
    under.free = -ln(1 - under.u) / under.sigma_t[under.heroes.hero];
    under.u = walk_number();
    under.reach = under.free;
    under.events++;
    return under.events <= MAX_EVENTS;
}

fn follow_walk(path: ptr<function, Path>, is_hit: bool, s: Surface) -> u32 {
    let hero = under.heroes.hero;
    let ray = (*path).ray;
    if (is_hit && !(s.material == under.material && dot(ray.d, s.ns) > 0)) {
        // Other materials are not seen from inside.
        (*path).ray = spawn(s, ray.d);
        under.reach = under.free - dot((*path).ray.o - under.p, ray.d);
        if (under.reach > 0) {
            return GOES_ON;
        }
    } else if (is_hit) {
        let distance = dot(s.p.p - under.p, ray.d);
        let passed = attenuation(under.sigma_t, distance);
        under.value *= passed / passed[hero];
        under.density *= passed / passed[hero];
        let reflected = fr_dielectric(-abs(dot(ray.d, s.n)), under.eta);
        if (walk_number() >= min(reflected, 1)) {
            under.state = EMERGING;
            return select(IS_LOST, LEAVES, takes_exit(path, under.value, under.density));
        }
        (*path).ray = spawn(s, fresnel_reflect(-ray.d, s.n));
        return select(IS_LOST, GOES_ON, begin_flight((*path).ray));
    }
    if (!(under.free < infinity())) {
        return IS_LOST;
    }
    let passed = attenuation(under.sigma_t, under.free);
    let pdf = under.sigma_t[hero] * passed[hero];
    under.value *= under.albedo * under.sigma_t * passed / pdf;
    under.density *= under.sigma_t * passed / pdf;
    let thrift = SampledSpectrum_max_component(under.value) / mean_of(under.heroes, under.density);
    let survival = min(thrift, 1);
    if (!(walk_number() < survival)) {
        return IS_LOST;
    }
    under.value /= survival;
    var u: vec2f;
    for (var i = 0; i < 2; i++) {
        u[i] = walk_number();
    }
    let phase = HenyeyGreenstein(under.g);
    (*path).ray = Ray_new(under.p + ray.d * under.free, HenyeyGreenstein_sample_p(phase, -ray.d, u).v0, shutter_time);
    return select(IS_LOST, GOES_ON, begin_flight((*path).ray));
}
