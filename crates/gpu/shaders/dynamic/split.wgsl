// The inner nodes of a binary tree over sorted Morton codes, each by itself [Karras 2012].
//
// Node i has the primitives from i to somewhere, all those whose codes have more leading bits in
// common than those at its other side; it is split where the next bit changes. Equal codes differ
// by their places.

@group(0) @binding(1) var<storage, read_write> keys: array<u32>;
@group(0) @binding(2) var<storage, read_write> inner: array<Inner>;

// The number of leading bits that the codes at two places have in common; -1 beyond the ends.
fn common_bits(i: u32, j: i32) -> i32 {
    if (j < 0 || j >= i32(plan.count)) {
        return -1;
    }
    let differing = keys[i] ^ keys[u32(j)];
    if (differing != 0) {
        return i32(countLeadingZeros(differing));
    }
    return 32 + i32(countLeadingZeros(i ^ u32(j)));
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x + 1 >= plan.count) {
        return;
    }
    let i = i32(id.x);
    let way = select(-1, 1, common_bits(id.x, i + 1) > common_bits(id.x, i - 1));
    let least = common_bits(id.x, i - way);
    var most = 2;
    while (common_bits(id.x, i + most * way) > least) {
        most *= 2;
    }
    var length = 0;
    for (var step = most / 2; step > 0; step /= 2) {
        if (common_bits(id.x, i + (length + step) * way) > least) {
            length += step;
        }
    }
    let end = i + length * way;
    let shared_bits = common_bits(id.x, end);
    var size = 0;
    var step = length;
    while (step > 1) {
        step = (step + 1) / 2;
        if (common_bits(id.x, i + (size + step) * way) > shared_bits) {
            size += step;
        }
    }
    inner[id.x] = Inner(u32(end), u32(i + size * way + min(way, 0)));
}
