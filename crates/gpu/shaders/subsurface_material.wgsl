// Bodies under the surface of which light is scattered: their boundary, the lobe by which light
// enters them, what they are where it is not followed there, and the tables of their diffusion
// profiles, records of `src/flatten/subsurface.rs`.

// The table of a material: the norm of the exit lobe, the numbers of albedos and radii, the offset
// of the gains of rough boundaries, the number of rows of what walks return, and then albedos,
// radii, effective albedos, profiles, their integrals, and those rows.
fn table_of(record: u32) -> u32 {
    return word(record + 5);
}

fn walks_under(record: u32) -> bool {
    return word(record + 6) == 1;
}

fn asymmetry_under(record: u32) -> f32 {
    return number(record + 10);
}

// The last of the first `count` − 1 ascending numbers that is at most `x`, or the first.
fn interval_of(first: u32, count: u32, x: f32) -> u32 {
    var low = 0u;
    var high = count - 1;
    while (high - low > 1) {
        let middle = (low + high) / 2;
        if (number(first + middle) <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// The nodes on which a spline depends, and their weights.
struct SplinePlace {
    nodes: vec4u,
    weights: vec4f,
    valid: bool,
}

fn spline_place(first: u32, count: u32, x: f32) -> SplinePlace {
    if (!(number(first) <= x && x <= number(first + count - 1))) {
        return SplinePlace(vec4u(), vec4f(), false);
    }
    let i = interval_of(first, count, x);
    let before = max(i, 1) - 1;
    let after = min(i + 2, count - 1);
    let start = number(first + i);
    let end = number(first + i + 1);
    let width = end - start;
    let t = (x - start) / width;
    let near = 1 - t * t * (3 - 2 * t);
    let from_ = t * (1 - t) * (1 - t) * width / (end - number(first + before));
    let to = -t * t * (1 - t) * width / (number(first + after) - start);
    return SplinePlace(vec4u(before, i, i + 1, after), vec4f(-from_, near - to, 1 - near + from_, to), true);
}

// The sum of weighted numbers, `step` apart.
fn spline_sum(at: SplinePlace, first: u32, step: u32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < 4; i++) {
        sum += at.weights[i] * number(first + step * at.nodes[i]);
    }
    return sum;
}

// The polynomial between two nodes, of which the values of the four nodes around are given.
struct SplineSegment {
    start: f32,
    width: f32,
    c: vec4f,
}

fn spline_segment(first: u32, count: u32, i: u32, values: vec4f) -> SplineSegment {
    let start = number(first + i);
    let end = number(first + i + 1);
    let width = end - start;
    let from_ = width * (values.z - values.x) / (end - number(first + max(i, 1) - 1));
    let to = width * (values.w - values.y) / (number(first + min(i + 2, count - 1)) - start);
    let rise = values.z - values.y;
    return SplineSegment(start, width, vec4f(values.y, from_, 3 * rise - 2 * from_ - to, from_ + to - 2 * rise));
}

// Where in a segment its value, or its integral, is `y`, as x: Newton's method within bounds that
// bisection narrows.
fn solved(s: SplineSegment, y: f32, start: f32, is_integral: bool) -> f32 {
    let c = s.c;
    var low = 0.0;
    var high = 1.0;
    var t = start;
    for (var i = 0; i < 32; i++) {
        if (!(low < t && t < high)) {
            t = 0.5 * (low + high);
        }
        let value = c.x + t * (c.y + t * (c.z + t * c.w));
        var found = vec2f(value, c.y + t * (2 * c.z + t * 3 * c.w));
        if (is_integral) {
            found = vec2f(t * (c.x + t * (c.y / 2 + t * (c.z / 3 + t * (c.w / 4)))), value);
        }
        if (abs(found.x - y) <= 1e-6 * abs(y) || high - low < 1e-6) {
            break;
        }
        if (found.x < y) {
            low = t;
        } else {
            high = t;
        }
        t -= (found.x - y) / found.y;
    }
    return s.start + s.width * clamp(t, 0, 1);
}

// Where a spline through ascending values is `y`; the nearest end if nowhere.
fn spline_inverse(first: u32, values: u32, count: u32, y: f32) -> f32 {
    if (!(y > number(values))) {
        return number(first);
    }
    if (y >= number(values + count - 1)) {
        return number(first + count - 1);
    }
    let i = interval_of(values, count, y);
    let around = vec4f(
        number(values + max(i, 1) - 1), number(values + i), number(values + i + 1),
        number(values + min(i + 2, count - 1)),
    );
    return solved(spline_segment(first, count, i, around), y, 0.5, false);
}

// The place of a roughness among evenly spaced ones, and the rest.
fn roughness_place(facets: TrowbridgeReitz, count: u32) -> vec2f {
    let x = clamp(sqrt(TrowbridgeReitz_mean_alpha(facets)), 0, 1) * f32(count - 1);
    let lower = min(floor(x), f32(count - 2));
    return vec2f(lower, x - lower);
}

// The albedo of a medium that returns a share of the light that entered.
fn albedo_under(record: u32, facets: TrowbridgeReitz, share: f32) -> f32 {
    let table = table_of(record);
    let count = word(table + 1);
    let albedos = table + 5;
    let radii = word(table + 2);
    let effective = albedos + count + radii;
    if (!walks_under(record)) {
        return spline_inverse(albedos, effective, count, share);
    }
    let place = roughness_place(facets, word(table + 4));
    let rows = effective + count + 2 * count * radii + u32(place.x) * count;
    var found: vec2f;
    for (var i = 0u; i < 2; i++) {
        found[i] = spline_inverse(albedos, rows + i * count, count, share);
    }
    return mix(found.x, found.y, place.y);
}

// The medium of a body, given the values of its textures: extinction, and albedo.
fn medium_under(record: u32, facets: TrowbridgeReitz, a: vec4f, b: vec4f) -> array<vec4f, 2> {
    let scale = number(record + 8);
    if (word(record + 7) == 0) {
        let absorbs = max(a * scale, vec4f());
        let scatters = max(b * scale, vec4f());
        let sigma_t = absorbs + scatters;
        return array(sigma_t, select(scatters / sigma_t, vec4f(), sigma_t == vec4f()));
    }
    let share = clamp(a, vec4f(), vec4f(1));
    var albedo: vec4f;
    for (var i = 0; i < 4; i++) {
        albedo[i] = albedo_under(record, facets, share[i]);
    }
    return array(1 / max(b * scale, vec4f(1e-6)), albedo);
}

// The cosines of the table of gains.
const COSINES = 19u;
const ROUGHNESSES = 21u;

// Visible normals of a quadrature, each way.
const STEPS = 8u;

// The same for a direction above a boundary that is not as rough in all directions, by quadrature
// over the normals that it sees.
fn brushed_gain(bsdf: Bsdf, wo: vec3f) -> f32 {
    let facets = bsdf.facets;
    var left = 0.0;
    var entered = 0.0;
    for (var i = 0u; i < STEPS * STEPS; i++) {
        let u = (vec2f(f32(i % STEPS), f32(i / STEPS)) + 0.5) / f32(STEPS);
        let wm = TrowbridgeReitz_sample_wm(facets, wo, u);
        let cosine = dot(wo, wm);
        let reflected = fr_dielectric(cosine, bsdf.eta);
        let mirrored = fresnel_reflect(wo, wm);
        let refracted = fresnel_refract(wo, wm, bsdf.eta);
        // What leaves of what facets turn is not hidden by others.
        let seen = TrowbridgeReitz_g1(facets, wo);
        left += 1;
        if (mirrored.z > 0) {
            left -= reflected * TrowbridgeReitz_g(facets, wo, mirrored) / seen;
        }
        if (refracted.v2 && refracted.v0.z < 0) {
            entered += (1 - reflected) * TrowbridgeReitz_g(facets, wo, refracted.v0) / seen;
        }
    }
    return select(1, left / entered, entered > 0);
}

// By how much more counts what a rough boundary refracts between two directions, of which one is
// above, so that all light enters a walk which is not reflected.
fn boundary_gain(bsdf: Bsdf, wo: vec3f, wi: vec3f) -> f32 {
    if (!walks_under(bsdf.record) || TrowbridgeReitz_effectively_smooth(bsdf.facets)) {
        return 1;
    }
    if (bsdf.facets.alpha_x != bsdf.facets.alpha_y) {
        return brushed_gain(bsdf, select(wi, wo, wo.z > 0));
    }
    let r = roughness_place(bsdf.facets, ROUGHNESSES);
    let x = clamp(sqrt(max(select(wi.z, wo.z, wo.z > 0), 0)), 0, 1) * f32(COSINES - 1);
    let lower = min(floor(x), f32(COSINES - 2));
    let first = word(table_of(bsdf.record) + 3) + u32(r.x) * COSINES + u32(lower);
    let near = mix(number(first), number(first + 1), x - lower);
    let far = mix(number(first + COSINES), number(first + COSINES + 1), x - lower);
    return mix(near, far, r.y);
}

// What the value of a boundary is multiplied by: light that comes out from below has been scattered
// there, and is the path's own. A sample that goes down is the beginning of its way, and counts.
fn boundary_factor(bsdf: Bsdf, wo: vec3f, wi: vec3f, is_sample: bool) -> f32 {
    if (wo.z * wi.z > 0) {
        return 1;
    }
    if (wo.z > 0 && !is_sample) {
        return 0;
    }
    return boundary_gain(bsdf, wo, wi);
}

// The lobe by which light enters a body, over all that does; a path from the camera leaves by it.
fn Exit_flags(bsdf: Bsdf) -> u32 {
    return BxdfFlags_DIFFUSE_REFLECTION;
}

fn Exit_f(bsdf: Bsdf, wo: vec3f, wi: vec3f, mode: u32) -> vec4f {
    let norm = number(table_of(bsdf.record)) * 0.31830987;
    let passes = (1 - fr_dielectric(wi.z, bsdf.eta)) * norm;
    return vec4f(select(0, passes, wo.z > 0 && wi.z > 0));
}

fn Exit_pdf(bsdf: Bsdf, wo: vec3f, wi: vec3f, mode: u32, directions: u32) -> f32 {
    return select(0, cosine_hemisphere_pdf(wi.z), wo.z > 0 && wi.z > 0);
}

fn Exit_sample_f(bsdf: Bsdf, wo: vec3f, uc: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    let wi = sample_cosine_hemisphere(u);
    let pdf = Exit_pdf(bsdf, wo, wi, mode, directions);
    var sample = BsdfSample_new(Exit_f(bsdf, wo, wi, mode), wi, pdf, BxdfFlags_DIFFUSE_REFLECTION);
    sample.valid = pdf > 0;
    return sample;
}

// Leaves of a body the boundary, by samples of which paths enter it.
fn keep_boundary(bsdf: ptr<function, Bsdf>) {
    if (HAS_SUBSURFACE && (*bsdf).kind == MaterialTag_Subsurface) {
        (*bsdf).kind = MaterialTag_Boundary;
    } else if (HAS_SUBSURFACE && (*bsdf).kind == MaterialTag_Principled) {
        (*bsdf).surface = boundary_part((*bsdf).surface);
    }
}

// The share of the light that entered which leaves again, by the profile.
fn effective_albedo(bsdf: Bsdf) -> vec4f {
    let table = table_of(bsdf.record);
    let count = word(table + 1);
    let albedos = table + 5;
    let effective = albedos + count + word(table + 2);
    var share: vec4f;
    for (var i = 0; i < 4; i++) {
        let rows = spline_place(albedos, count, bsdf.albedo[i]);
        if (rows.valid) {
            share[i] = max(spline_sum(rows, effective, 1), 0);
        }
    }
    return share;
}

// The surface of a body as if light left where it entered: its boundary, and a diffuse base.
fn Body_flags(bsdf: Bsdf) -> u32 {
    let is_smooth = TrowbridgeReitz_effectively_smooth(bsdf.facets);
    let mirrors = select(BxdfFlags_GLOSSY_REFLECTION, BxdfFlags_SPECULAR_REFLECTION, is_smooth);
    return BxdfFlags_DIFFUSE_REFLECTION | select(mirrors, 0, bsdf.eta == 1);
}

fn Body_f(bsdf: Bsdf, wo: vec3f, wi: vec3f, mode: u32) -> vec4f {
    if (!(wo.z > 0 && wi.z > 0)) {
        return vec4f();
    }
    let diffused = Exit_f(bsdf, wo, wi, mode) * effective_albedo(bsdf) * (1 - fr_dielectric(wo.z, bsdf.eta));
    return Dielectric_f(Dielectric(bsdf.eta, bsdf.facets), wo, wi, mode) + diffused;
}

// The probability to sample the boundary, and not the base.
fn boundary_probability(bsdf: Bsdf, wo: vec3f) -> f32 {
    let reflected = select(fr_dielectric(wo.z, bsdf.eta), 0, bsdf.eta == 1);
    let diffused = (1 - reflected) * SampledSpectrum_average(effective_albedo(bsdf));
    return select(0, reflected / (reflected + diffused), reflected > 0);
}

fn Body_pdf(bsdf: Bsdf, wo: vec3f, wi: vec3f, mode: u32, directions: u32) -> f32 {
    if (!(wo.z > 0 && wi.z > 0)) {
        return 0;
    }
    let boundary = Dielectric(bsdf.eta, bsdf.facets);
    let mirrored = Dielectric_pdf(boundary, wo, wi, mode, Directions_Reflection);
    return mix(cosine_hemisphere_pdf(wi.z), mirrored, boundary_probability(bsdf, wo));
}

fn Body_sample_f(bsdf: Bsdf, wo: vec3f, uc: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    if (!(wo.z > 0) || directions == Directions_Transmission) {
        return BsdfSample_invalid();
    }
    let p = boundary_probability(bsdf, wo);
    var wi = sample_cosine_hemisphere(u);
    var lobe = BxdfFlags_DIFFUSE_REFLECTION;
    if (uc < p) {
        let boundary = Dielectric(bsdf.eta, bsdf.facets);
        var mirrored = Dielectric_sample_f(boundary, wo, uc / p, u, mode, Directions_Reflection);
        if (!mirrored.valid || (mirrored.flags & BxdfFlags_SPECULAR) != 0) {
            mirrored.pdf *= p;
            return mirrored;
        }
        wi = mirrored.wi;
        lobe = mirrored.flags;
    }
    let pdf = Body_pdf(bsdf, wo, wi, mode, directions);
    var sample = BsdfSample_new(Body_f(bsdf, wo, wi, mode), wi, pdf, lobe);
    sample.valid = pdf > 0;
    return sample;
}

// The profile of a wavelength at a distance in mean free paths, and its density over the plane.
fn profile_at(table: u32, albedo: f32, r: f32) -> vec2f {
    let count = word(table + 1);
    let radii = word(table + 2);
    let albedos = table + 5;
    let rows = spline_place(albedos, count, albedo);
    let columns = spline_place(albedos + count, radii, r);
    if (!(rows.valid && columns.valid)) {
        return vec2f();
    }
    let effective = albedos + count + radii;
    var profile = 0.0;
    for (var i = 0u; i < 4; i++) {
        profile += rows.weights[i] * spline_sum(columns, effective + count + radii * rows.nodes[i], 1);
    }
    profile = max(profile / (6.2831855 * select(1, r, r > 0)), 0);
    let total = spline_sum(rows, effective, 1);
    return vec2f(profile, select(0, profile / total, total > 0));
}
