// The buffers of a scene, and the places of random numbers.
//
// Kernels have bindings of their own at 5 and 6, and what rays are traced through at 1. `world` is
// the `Head` of `src/flatten/mod.rs`. Tables are words; a record refers to another by the
// index of its first word, which is a multiple of four: what is read together is four words. The
// files of `src/flatten/` describe the records.

@group(0) @binding(0) var<storage, read_write> world: Head;
@group(0) @binding(2) var<storage, read_write> triangles: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> items: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> tables: array<vec4u>;
@group(0) @binding(7) var<storage, read_write> texels: array<u32>;

fn has_setting(bit: u32) -> bool {
    return (world.settings & bit) != 0;
}

// Where the sample is in its random numbers.
var<private> place: Address;

// The rays traced for the sample.
var<private> rays: u32;

// Whether random numbers are those of a light path.
var<private> is_light_path: bool;

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

// The hit of the camera ray, where a kernel before has found it.
var<private> camera_hit: Hit;
var<private> has_camera_hit: bool;

// Where the camera is on the ray that is traced.
var<private> end_at_camera: u32;

// The first ray of a path, or any other.
fn traced(ray: Ray, t_max: f32, is_any: bool) -> Hit {
    rays++;
    if (has_camera_hit) {
        has_camera_hit = false;
        return camera_hit;
    }
    end_at_camera = ray.camera;
    return trace(ray.o, ray.d, t_max, is_any);
}

// The nearest hit of a ray.
fn nearest(ray: Ray) -> Hit {
    return traced(ray, infinity(), false);
}

// Whether anything is at 0 < t < `t_max`.
fn occluded(ray: Ray, t_max: f32) -> bool {
    rays++;
    end_at_camera = ray.camera;
    return trace(ray.o, ray.d, t_max, true).found;
}

fn is_black(l: vec4f) -> bool {
    return all(l == vec4f());
}
