// The buffers of a scene, and the random numbers of a sample.
//
// `world` has what Rust calls a `Head`. Tables are words; a record refers to another by the index
// of its first word. The files of `src/flatten/` describe the records.

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
    key: u32,
    is_centered: u32,
    has_one_wavelength: u32,
    max_depth: u32,
    regularize: u32,
    white: u32,
    white_scale: f32,
    max_distance: f32,
    cos_sample: u32,
    has_footprints: u32,
    unused: u32,
}

// A rectangle of pixels, and the index of the sample of each.
struct Batch {
    low: vec2u,
    size: vec2u,
    index: u32,
}

// What is found for a pixel: radiance, the number of rays, and 1 where only the first wavelength is
// left.
struct Sample {
    l: vec4f,
    rays: u32,
    is_terminated: u32,
    unused: vec2u,
}

@group(0) @binding(0) var<storage, read_write> world: World;
@group(0) @binding(1) var<storage, read_write> nodes: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> triangles: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> items: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> tables: array<u32>;
@group(0) @binding(5) var<storage, read_write> batch: Batch;
@group(0) @binding(6) var<storage, read_write> samples: array<Sample>;

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

fn get_1d() -> f32 {
    let u = Independent_at_1d(Independent(1, world.key, place), place);
    place.dimension += 1;
    return u;
}

fn get_2d() -> vec2f {
    let u = Independent_at_2d(Independent(1, world.key, place), place);
    place.dimension += 2;
    return u;
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
