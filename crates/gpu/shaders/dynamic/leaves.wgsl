// The base of the pyramid: boxes in the order of Morton codes, and then nothing.

@group(0) @binding(1) var<storage, read_write> primitives: array<u32>;
@group(0) @binding(2) var<storage, read_write> boxes: array<Box>;
@group(0) @binding(3) var<storage, read_write> pyramid: array<Box>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    var own = NOTHING;
    if (id.x < plan.count) {
        own = boxes[primitives[id.x]];
    }
    pyramid[plan.leaves + id.x] = own;
}
