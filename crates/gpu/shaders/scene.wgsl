// The buffers of a scene, and the random numbers of a sample.
//
// Kernels have bindings of their own at 5 and 6. `world` has what Rust calls a `Head`. Tables are
// words; a record refers to another by the index of its first word. The files of `src/flatten/`
// describe the records.

struct World {
    roots: vec2u,
    unbounded: u32,
    size: f32,
    camera: u32,
    pixel_filter: u32,
    geometries: u32,
    materials: u32,
    lights: u32,
    infinite: u32,
    choice: u32,
    light_count: u32,
    infinite_count: u32,
    random_numbers: u32,
    is_centered: u32,
    has_one_wavelength: u32,
    max_depth: u32,
    regularize: u32,
    white: u32,
    white_scale: f32,
    max_distance: f32,
    cos_sample: u32,
    has_footprints: u32,
    sensor: u32,
    light_paths: u32,
    media: u32,
}

@group(0) @binding(0) var<storage, read_write> world: World;
@group(0) @binding(1) var<storage, read_write> nodes: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> triangles: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> items: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> tables: array<u32>;
@group(0) @binding(7) var<storage, read_write> texels: array<u32>;

// Where the sample is in its random numbers.
var<private> place: Address;

// The rays traced for the sample.
var<private> rays: u32;

fn number(at: u32) -> f32 {
    return bitcast<f32>(tables[at]);
}

fn vector(at: u32) -> vec3f {
    return vec3f(number(at), number(at + 1), number(at + 2));
}

const INDEPENDENT = 0u;
const PADDED_SOBOL = 2u;
const SOBOL = 3u;
const HALTON = 4u;
const STRATIFIED = 5u;
const PMJ02BN = 6u;

// Whether random numbers are those of a light path.
var<private> is_light_path: bool;

// The coordinates at the current place, of which samplers make the second one if it is wanted.
fn coordinates(is_pair: bool) -> vec2f {
    var at = world.random_numbers;
    if (is_light_path) {
        at = tables[world.light_paths];
    }
    let key = tables[at + 1];
    if (tables[at] == INDEPENDENT) {
        return Independent_at_2d(Independent(1, key, place), place);
    }
    if (HAS_RARE_SAMPLERS) {
        switch (tables[at]) {
            case PADDED_SOBOL: { return padded_sobol(place, key, tables[at + 2], tables[at + 3], is_pair); }
            case SOBOL: { return sobol(at, is_pair); }
            case HALTON: { return halton_at(at, is_pair); }
            case STRATIFIED: {
                let grid = vec2u(tables[at + 3], tables[at + 4]);
                return stratified(place, grid, tables[at + 2], key, tables[at + 5] == 1, is_pair);
            }
            case PMJ02BN: { return pmj02bn(place, tables[at + 2], key, is_pair); }
            default: {}
        }
    }
    return ZSobol_at_2d(ZSobol(tables[at + 2], tables[at + 3], tables[at + 4], key, place), place);
}

// The coordinates of `sobol`. On the CPU its first two dimensions are the position in the pixel,
// and others begin with the third; here camera paths have that position after their first number.
fn sobol(at: u32, is_pair: bool) -> vec2f {
    let m = tables[at + 2];
    let kept = (1u << m) - 1;
    let bits = (place.pixel[0] & kept) << m | place.pixel[1] & kept;
    let is_position = !is_light_path && place.dimension == 1;
    var first = place.dimension;
    if (is_light_path || first == 0) {
        first += 2;
    }
    first = select(wrapped_dimension(first, select(1u, 2u, is_pair), tables[at + 3]), 0, is_position);
    var u: vec2f;
    for (var c = 0u; c < select(1u, 2u, is_pair); c++) {
        let matrix = tables[at + 5] + 64 * (first + c);
        var digits = 0u;
        for (var bit = 0u; bit < 32; bit++) {
            digits ^= tables[matrix + bit] & (0u - (bits >> bit & 1));
            digits ^= tables[matrix + 32 + bit] & (0u - (place.index >> bit & 1));
        }
        digits >>= select(0u, m, is_position);
        u[c] = Randomize_digits(tables[at + 1], digits, tables[tables[at + 4] + first + c]);
    }
    return u;
}

// The coordinates of `halton`.
fn halton_at(at: u32, is_pair: bool) -> vec2f {
    let pixel = mix_word(mix_word(tables[at + 1] ^ place.pixel[0]) ^ place.pixel[1]);
    let randomize = tables[at + 2];
    let index = place.index + select(0u, pixel, randomize == 0);
    let first = wrapped_dimension(place.dimension, select(1u, 2u, is_pair), tables[at + 3]);
    var u: vec2f;
    for (var c = 0u; c < select(1u, 2u, is_pair); c++) {
        let base = tables[tables[at + 4] + first + c];
        u[c] = halton(index, base, randomize, mix_word(pixel ^ mix_word(first + c)));
    }
    return u;
}

// The next random number, or pair of them. Samplers are long: what draws several does so in a loop,
// because drivers inline all calls.
fn next_numbers(is_pair: bool) -> vec2f {
    let u = coordinates(is_pair);
    place.dimension += select(1u, 2u, is_pair);
    return u;
}

fn get_1d() -> f32 {
    return next_numbers(false).x;
}

fn get_2d() -> vec2f {
    return next_numbers(true);
}

// A random number that depends on two vectors and a word alone.
fn hashed(a: vec3f, b: vec3f, word: u32) -> f32 {
    let u = bitcast<vec3u>(a);
    let mixed = mix_quadruple(array(u.x, u.y, u.z, word));
    let v = bitcast<vec3u>(b) ^ vec3u(mixed[0], mixed[1], mixed[2]);
    return unit_interval(mix_quadruple(array(v.x, v.y, v.z, mixed[3]))[0]);
}

// The nearest hit of a ray.
fn nearest(ray: Ray) -> Hit {
    rays++;
    return trace(ray.o, ray.d, infinity(), false);
}

// Whether anything is at 0 < t < `t_max`.
fn occluded(ray: Ray, t_max: f32) -> bool {
    rays++;
    return trace(ray.o, ray.d, t_max, true).found;
}

fn is_black(l: vec4f) -> bool {
    return all(l == vec4f());
}
