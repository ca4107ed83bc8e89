// Paths between the stages of a wavefront.
//
// What is found for the samples is in their order, a `Sample` of `cameras.wgsl` each, in which
// paths keep their light and counts. What else a path keeps is a column of a table, four words in
// each row, so that threads beside each other read words beside each other.

const LAMBDA = 0u;
const LAMBDA_PDF = 1u;
const BETA = 2u;
const RAY_O = 3u;
const RAY_D = 4u;
// The vertex that the ray starts at; with the normals, the sample and where the camera is.
const P = 5u;
const P_ERROR = 6u;
const N = 7u;
const NS = 8u;
// The rays of neighbouring pixels.
const NEAR = 9u;
const HIT = 13u;
const HIT_IDS = 14u;
const SHADOW_O = 15u;
const SHADOW_D = 16u;
const DIRECT = 17u;

// Bits of a path's state, and of its hit.
const IS_TERMINATED = 1u;
const IS_FOUND_TWICE = 2u;
const ROUGH_BEFORE = 4u;
const ARE_KNOWN = 8u;
const FOUND = 1u;
const IS_TRIANGLE = 2u;

@group(0) @binding(6) var<storage, read_write> table: array<vec4u>;

fn place_of(at: u32, path: u32) -> u32 {
    return 2 * batch.samples + at * batch.places + path;
}

fn row(at: u32, path: u32) -> vec4u {
    return table[place_of(at, path)];
}

fn numbers(at: u32, path: u32) -> vec4f {
    return bitcast<vec4f>(row(at, path));
}

fn keep(at: u32, path: u32, words: vec4u) {
    table[place_of(at, path)] = words;
}

fn keep_numbers(at: u32, path: u32, x: vec4f) {
    keep(at, path, bitcast<vec4u>(x));
}

var<workgroup> wanted: array<atomic<u32>, QUEUES>;
var<workgroup> first_places: array<u32, QUEUES>;

// Appends the path of each thread of a workgroup to a queue. All threads call it, those whose path
// is not wanted, too.
fn append(queue: u32, path: u32, is_wanted: bool, local: u32) {
    if (local < QUEUES) {
        atomicStore(&wanted[local], 0u);
    }
    workgroupBarrier();
    var place = 0u;
    if (is_wanted) {
        place = atomicAdd(&wanted[queue], 1u);
    }
    workgroupBarrier();
    if (local < QUEUES) {
        let count = atomicLoad(&wanted[local]);
        if (count > 0) {
            first_places[local] = atomicAdd(&batch.lengths[local], count);
        }
    }
    workgroupBarrier();
    if (is_wanted) {
        batch.queues[queue * batch.places + first_places[queue] + place] = path;
    }
    workgroupBarrier();
}

// The pixel of a sample, and its index.
fn pixel_of(sample: u32) -> vec2u {
    let pixel = sample % (batch.size.x * batch.size.y);
    return batch.low + vec2u(pixel % batch.size.x, pixel / batch.size.x);
}

fn index_of(sample: u32) -> u32 {
    return batch.index + sample / (batch.size.x * batch.size.y);
}

// The number of the sample of a path.
fn sample_of(path: u32) -> u32 {
    return row(N, path).w;
}

fn kept_light(sample: u32) -> vec4f {
    return bitcast<vec4f>(table[2 * sample]);
}

fn keep_light(sample: u32, l: vec4f) {
    table[2 * sample] = bitcast<vec4u>(l);
}

fn keep_path(index: u32, sample: u32, path: Path, lambda: SampledWavelengths, l: vec4f) {
    var bits = path.depth << 4;
    bits |= select(0u, IS_TERMINATED, SampledWavelengths_secondary_terminated(lambda));
    bits |= select(0u, IS_FOUND_TWICE, path.is_found_twice);
    bits |= select(0u, ROUGH_BEFORE, path.rough_before);
    bits |= select(0u, ARE_KNOWN, path.near.are_known);
    keep_light(sample, l);
    table[2 * sample + 1] = vec4u(rays, bits, table[2 * sample + 1].zw);
    keep_numbers(LAMBDA, index, lambda.lambda);
    keep_numbers(LAMBDA_PDF, index, lambda.pdf);
    keep_numbers(BETA, index, path.beta);
    keep_numbers(RAY_O, index, vec4f(path.ray.o, path.ray.time));
    keep_numbers(RAY_D, index, vec4f(path.ray.d, path.pdf));
    keep_numbers(P, index, vec4f(path.origin.p.p, path.eta_scale));
    keep(P_ERROR, index, vec4u(bitcast<vec3u>(path.origin.p.error), place.dimension));
    keep(N, index, vec4u(bitcast<vec3u>(path.origin.n), sample));
    keep(NS, index, vec4u(bitcast<vec3u>(path.origin.ns), path.ray.camera));
    if (path.near.are_known) {
        keep_numbers(NEAR, index, vec4f(path.near.rx_origin, 0));
        keep_numbers(NEAR + 1, index, vec4f(path.near.rx_direction, 0));
        keep_numbers(NEAR + 2, index, vec4f(path.near.ry_origin, 0));
        keep_numbers(NEAR + 3, index, vec4f(path.near.ry_direction, 0));
    }
}

fn kept_wavelengths(index: u32) -> SampledWavelengths {
    return SampledWavelengths(numbers(LAMBDA, index), numbers(LAMBDA_PDF, index));
}

// The path of a sample, with the place in its random numbers and the number of its rays.
fn kept_path(index: u32, sample: u32) -> Path {
    let counts = table[2 * sample + 1];
    let pixel = pixel_of(sample);
    let error_and_dimension = row(P_ERROR, index);
    place = Address(array(pixel.x, pixel.y), index_of(sample), error_and_dimension.w);
    rays = counts.x;
    var path: Path;
    path.depth = counts.y >> 4;
    path.is_found_twice = (counts.y & IS_FOUND_TWICE) != 0;
    path.rough_before = (counts.y & ROUGH_BEFORE) != 0;
    path.beta = numbers(BETA, index);
    let o = numbers(RAY_O, index);
    let d = numbers(RAY_D, index);
    path.ray = Ray_new(o.xyz, d.xyz, o.w);
    shutter_time = o.w;
    path.pdf = d.w;
    let p = numbers(P, index);
    path.eta_scale = p.w;
    let error = Point3Error(p.xyz, bitcast<vec3f>(error_and_dimension.xyz));
    path.origin = ShapeSampleContext(error, numbers(N, index).xyz, numbers(NS, index).xyz, o.w);
    path.near = no_differentials();
    if ((counts.y & ARE_KNOWN) != 0) {
        path.near = Differentials(
            numbers(NEAR, index).xyz, numbers(NEAR + 1, index).xyz, numbers(NEAR + 2, index).xyz,
            numbers(NEAR + 3, index).xyz, true,
        );
    }
    return path;
}
