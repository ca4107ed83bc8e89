// The words of all nodes, but for references to nodes: the boxes of their children, quantised so
// that they are around the exact ones, and the leaves. `src/bvh/node.rs` has the format.

@group(0) @binding(1) var<storage, read_write> primitives: array<u32>;
@group(0) @binding(2) var<storage, read_write> pyramid: array<Box>;
@group(0) @binding(3) var<storage, read_write> bounds: array<Box>;
@group(0) @binding(4) var<storage, read_write> nodes: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> children: array<u32>;
@group(0) @binding(6) var<storage, read_write> levels: array<u32>;

// The bits of references to leaves of nothing.
const EMPTY = 0x80000000u;
const COUNT_BITS = 5u;

// The reference of a leaf of one item or triangle.
fn leaf(primitive: u32) -> u32 {
    return plan.leaf_bits | ((plan.first_item + primitive) << COUNT_BITS) | 1;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    var count = 0u;
    // What a ray's stack needs below it: an entry for each level of nodes, and a leaf's.
    var below = plan.leaf_stack;
    for (var level = 0u; level < arrayLength(&levels); level++) {
        below += select(0u, 1u, count > id.x && levels[level] > 0);
        count += levels[level];
    }
    if (id.x >= count) {
        return;
    }
    let at = 6 * (plan.first_node + id.x);
    var boxes: array<Box, WIDTH>;
    var all = NOTHING;
    for (var i = 0u; i < WIDTH; i++) {
        let child = children[WIDTH * id.x + i];
        if (child == NONE) {
            nodes[at + 4 + i / 4][i % 4] = EMPTY;
            boxes[i] = NOTHING;
            continue;
        }
        if ((child & IS_LEAF) == 0) {
            boxes[i] = bounds[child];
        } else {
            let place = child & ~IS_LEAF;
            nodes[at + 4 + i / 4][i % 4] = leaf(primitives[place]);
            boxes[i] = pyramid[plan.leaves + place];
        }
        all = joined(all, boxes[i]);
    }
    // The next power of two above the size of a step; a little larger, for the rounding of planes.
    let exponents = min((bitcast<vec3u>((all.high - all.low) / 254.9) >> vec3u(23)) + 1, vec3u(254));
    let step = bitcast<vec3f>(exponents << vec3u(23));
    // Two words for each of the low planes of x, y and z, and then for the high ones.
    var words: array<u32, 12>;
    for (var i = 0u; i < WIDTH; i++) {
        if (children[WIDTH * id.x + i] == NONE) {
            continue;
        }
        let low = vec3u(clamp(floor((boxes[i].low - all.low) / step - 2e-4), vec3f(), vec3f(255)));
        let high = vec3u(clamp(ceil((boxes[i].high - all.low) / step + 2e-4), vec3f(), vec3f(255)));
        for (var axis = 0u; axis < 3; axis++) {
            words[2 * axis + i / 4] |= low[axis] << (8 * (i % 4));
            words[6 + 2 * axis + i / 4] |= high[axis] << (8 * (i % 4));
        }
    }
    let packed = exponents.x | (exponents.y << 8) | (exponents.z << 16) | (below << 24);
    nodes[at] = vec4u(bitcast<vec3u>(all.low), packed);
    for (var i = 0u; i < 3; i++) {
        nodes[at + 1 + i] = vec4u(words[4 * i], words[4 * i + 1], words[4 * i + 2], words[4 * i + 3]);
    }
}
