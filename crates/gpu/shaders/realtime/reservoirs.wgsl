// Reservoirs: samples of direct light that pixels and frames share.
//
// A sample is a light and the numbers that choose a point on it. These are the same for all
// receivers of light, each of which has the density of one, so a sample needs no correction where
// another receiver uses it; it may find another point, by its own densities.

struct Reservoir {
    // The receiver: a ray and its hit.
    o: vec3f,
    t: f32,
    d: vec3f,
    geometry: u32,
    uv: vec2f,
    primitive: u32,
    place: u32,
    instance: u32,
    // Nothing (0), a shape or a triangle.
    kind: u32,
    // The sample: the light, the numbers, and the weight by which what they find is multiplied.
    light: u32,
    weight: f32,
    u: vec2f,
    // How many samples it stands for.
    count: f32,
    // The receiver's normal, as `packed_normal` has it.
    normal: u32,
}

const SHAPE_RECEIVER = 1u;
const TRIANGLE_RECEIVER = 2u;

@group(0) @binding(5) var<uniform> frame: FrameParameters;
@group(0) @binding(6) var<storage, read_write> film: Film;
@group(0) @binding(8) var<storage, read_write> reservoirs: array<Reservoir>;
@group(0) @binding(9) var<uniform> reuse: Reuse;

// A direction in 32 bits.
fn packed_normal(n: vec3f) -> u32 {
    return pack2x16unorm(equal_area_sphere_to_square(n));
}

fn unpacked_normal(packed: u32) -> vec3f {
    return equal_area_square_to_sphere(unpack2x16unorm(packed));
}

// A receiver with what it scatters.
struct Receiver {
    s: Surface,
    context: ShapeSampleContext,
    bsdf: Bsdf,
    receives: bool,
}

fn receiver_of(r: Reservoir, near: Differentials, lambda: ptr<function, SampledWavelengths>) -> Receiver {
    var found: Receiver;
    if (r.kind == 0) {
        return found;
    }
    var hit: Hit;
    hit.t = r.t;
    hit.uv = r.uv;
    hit.geometry = r.geometry;
    hit.primitive = r.primitive;
    hit.place = r.place;
    hit.is_triangle = r.kind == TRIANGLE_RECEIVER;
    hit.instance = r.instance;
    hit.found = true;
    var s = surface_at(hit, Ray_new(r.o, r.d, 0));
    // The walks in coats are the same whenever a sample is evaluated.
    place.dimension = 0;
    found.bsdf = bsdf_at(&s, texture_context(s, near), lambda);
    let flags = bxdf_flags(found.bsdf);
    found.s = s;
    found.context = light_context(s, flags);
    found.receives = is_non_specular(flags);
    return found;
}

// What a sample finds: light that is scattered, without visibility, divided by the density of the
// point for given numbers.
struct Finding {
    l: vec4f,
    light: LightSample,
}

fn find(receiver: Receiver, light: u32, u: vec2f, lambda: SampledWavelengths) -> Finding {
    var found = Finding(vec4f(), no_light());
    if (!receiver.receives) {
        return found;
    }
    found.light = sample_light(light, receiver.context, u, lambda, false);
    if (found.light.valid && found.light.pdf > 0) {
        found.l = scattered(receiver.s, receiver.bsdf, found.light) / found.light.pdf;
    }
    return found;
}

// In proportion to this samples are chosen.
fn aim_of(found: Finding) -> f32 {
    let sum = found.l.x + found.l.y + found.l.z + found.l.w;
    return select(0.0, sum, sum > 0 && sum < infinity());
}

fn is_visible(receiver: Receiver, light: LightSample) -> bool {
    let shadow = shadow_ray(receiver.s, light);
    return !occluded(shadow.ray, shadow.t_max);
}

// The wavelengths at which samples are compared, the same for all.
fn common_wavelengths() -> SampledWavelengths {
    return SampledWavelengths_sample_visible(0.5);
}

// Where the samples for direct light are among the random numbers.
const FIRST_DIMENSION = 0x10000u;
