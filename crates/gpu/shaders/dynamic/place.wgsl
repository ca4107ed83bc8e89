// Takes spheres to where they are: their items, the boxes of all items, and the box of the middles
// of these.

@group(0) @binding(1) var<storage, read_write> items: array<vec4u>;
// Three numbers for each sphere.
@group(0) @binding(2) var<storage, read_write> centers: array<f32>;
// The first sphere of each geometry.
@group(0) @binding(3) var<storage, read_write> spheres: array<u32>;
@group(0) @binding(4) var<storage, read_write> boxes: array<Box>;
// Codes of the highest coordinates along each axis, and complements of those of the lowest.
@group(0) @binding(5) var<storage, read_write> ends: array<atomic<u32>, 6>;

const BALL = 6u;
const AT_REST = 0xffffffffu;

var<workgroup> ends_of_group: array<atomic<u32>, 6>;

// A word for a number, in the same order.
fn ordered(x: f32) -> u32 {
    let bits = bitcast<u32>(x);
    return select(bits | 0x80000000u, ~bits, (bits >> 31) == 1);
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    if (id.x < plan.count) {
        let at = 5 * (plan.first_item + id.x);
        let ids = items[at + 4];
        let first = spheres[ids.y];
        if (ids.x == BALL && first != AT_REST) {
            let base = 3 * (first + ids.z);
            let center = vec3f(centers[base], centers[base + 1], centers[base + 2]);
            let radius = bitcast<f32>(items[at].w);
            items[at] = bitcast<vec4u>(vec4f(center, radius));
            // More than the rounding errors of the planes.
            let reach = vec3f(radius) + (abs(center) + radius) * 2.4e-7;
            boxes[id.x] = Box(center - reach, center + reach);
        }
        let middle = boxes[id.x].low * 0.5 + boxes[id.x].high * 0.5;
        for (var axis = 0u; axis < 3; axis++) {
            atomicMax(&ends_of_group[axis], ordered(middle[axis]));
            atomicMax(&ends_of_group[axis + 3], ~ordered(middle[axis]));
        }
    }
    workgroupBarrier();
    if (local < 6) {
        atomicMax(&ends[local], atomicLoad(&ends_of_group[local]));
    }
}
