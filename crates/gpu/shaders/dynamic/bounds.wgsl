// The boxes of the binary tree's inner nodes: of a range of leaves, by the boxes of the pyramid
// that it consists of, at most two of each level.

@group(0) @binding(1) var<storage, read_write> inner: array<Inner>;
@group(0) @binding(2) var<storage, read_write> pyramid: array<Box>;
@group(0) @binding(3) var<storage, read_write> bounds: array<Box>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x + 1 >= plan.count) {
        return;
    }
    let end = inner[id.x].end;
    var first = plan.leaves + min(id.x, end);
    var behind = plan.leaves + max(id.x, end) + 1;
    var all = NOTHING;
    while (first < behind) {
        if ((first & 1) == 1) {
            all = joined(all, pyramid[first]);
            first++;
        }
        if ((behind & 1) == 1) {
            behind--;
            all = joined(all, pyramid[behind]);
        }
        first /= 2;
        behind /= 2;
    }
    bounds[id.x] = all;
}
