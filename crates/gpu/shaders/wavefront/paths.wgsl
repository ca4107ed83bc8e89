// Paths between the stages of a wavefront, and the queues of those that go on.
//
// Paths that go on are appended to the queue of the next stage, each workgroup's together. In which
// order they are in a queue depends on threads, what they find does not.
//
// What a path keeps is a column of a table, four words in each row, so that threads beside each
// other read words beside each other; but for the first two rows, which are a `Sample` of
// `cameras.wgsl` of each path: light, and counts with what the film needs.

const L = 0u;
const COUNTS = 1u;
const LAMBDA = 2u;
const LAMBDA_PDF = 3u;
const BETA = 4u;
const RAY_O = 5u;
const RAY_D = 6u;
// The vertex that the ray starts at.
const P = 7u;
const P_ERROR = 8u;
const N = 9u;
const NS = 10u;
// The rays of neighbouring pixels.
const NEAR = 11u;
const HIT = 15u;
const HIT_IDS = 16u;
const SHADOW_O = 17u;
const SHADOW_D = 18u;
const DIRECT = 19u;

// Bits of a path's state, and of its hit.
const IS_TERMINATED = 1u;
const IS_FOUND_TWICE = 2u;
const ROUGH_BEFORE = 4u;
const ARE_KNOWN = 8u;
const FOUND = 1u;
const IS_TRIANGLE = 2u;

// The queues: of paths in two turns, and of shadow rays.
const SHADOWS = 2u;

// A rectangle of pixels, the index of the sample of each, the number of paths, and the queue of
// those that go on.
struct Batch {
    low: vec2u,
    size: vec2u,
    index: u32,
    count: u32,
    turn: u32,
    unused: u32,
    lengths: array<atomic<u32>, 4>,
    queues: array<u32>,
}

@group(0) @binding(5) var<storage, read_write> batch: Batch;
@group(0) @binding(6) var<storage, read_write> table: array<vec4u>;

fn place_of(at: u32, path: u32) -> u32 {
    return select(at * batch.count + path, 2 * path + at, at <= COUNTS);
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

// The path of a thread in a queue; NO_PATH beyond its end.
const NO_PATH = 0xffffffffu;

fn path_in(queue: u32, i: u32) -> u32 {
    if (i >= atomicLoad(&batch.lengths[queue])) {
        return NO_PATH;
    }
    return batch.queues[queue * batch.count + i];
}

var<workgroup> wanted: atomic<u32>;
var<workgroup> first_place: u32;

// Appends the paths of a workgroup to a queue. All threads call it, those whose path is not
// wanted, too.
fn append(queue: u32, path: u32, is_wanted: bool, local: u32) {
    if (local == 0) {
        atomicStore(&wanted, 0u);
    }
    workgroupBarrier();
    var place = 0u;
    if (is_wanted) {
        place = atomicAdd(&wanted, 1u);
    }
    workgroupBarrier();
    if (local == 0) {
        first_place = atomicAdd(&batch.lengths[queue], atomicLoad(&wanted));
    }
    workgroupBarrier();
    if (is_wanted) {
        batch.queues[queue * batch.count + first_place + place] = path;
    }
    workgroupBarrier();
}

// The pixel of a path.
fn pixel_of(path: u32) -> vec2u {
    return batch.low + vec2u(path % batch.size.x, path / batch.size.x);
}

fn keep_path(index: u32, path: Path, lambda: SampledWavelengths, l: vec4f) {
    var bits = path.depth << 4;
    bits |= select(0u, IS_TERMINATED, SampledWavelengths_secondary_terminated(lambda));
    bits |= select(0u, IS_FOUND_TWICE, path.is_found_twice);
    bits |= select(0u, ROUGH_BEFORE, path.rough_before);
    bits |= select(0u, ARE_KNOWN, path.near.are_known);
    keep_numbers(L, index, l);
    keep(COUNTS, index, vec4u(rays, bits, row(COUNTS, index).zw));
    keep_numbers(LAMBDA, index, lambda.lambda);
    keep_numbers(LAMBDA_PDF, index, lambda.pdf);
    keep_numbers(BETA, index, path.beta);
    keep_numbers(RAY_O, index, vec4f(path.ray.o, path.ray.time));
    keep_numbers(RAY_D, index, vec4f(path.ray.d, path.pdf));
    keep_numbers(P, index, vec4f(path.origin.p.p, path.eta_scale));
    keep(P_ERROR, index, vec4u(bitcast<vec3u>(path.origin.p.error), place.dimension));
    keep_numbers(N, index, vec4f(path.origin.n, 0));
    keep_numbers(NS, index, vec4f(path.origin.ns, 0));
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

// A path, with the place in its random numbers and the number of its rays.
fn kept_path(index: u32) -> Path {
    let counts = row(COUNTS, index);
    let pixel = pixel_of(index);
    let error_and_dimension = row(P_ERROR, index);
    place = Address(array(pixel.x, pixel.y), batch.index, error_and_dimension.w);
    rays = counts.x;
    var path: Path;
    path.depth = counts.y >> 4;
    path.is_found_twice = (counts.y & IS_FOUND_TWICE) != 0;
    path.rough_before = (counts.y & ROUGH_BEFORE) != 0;
    path.beta = numbers(BETA, index);
    let o = numbers(RAY_O, index);
    let d = numbers(RAY_D, index);
    path.ray = Ray(o.xyz, d.xyz, o.w);
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
