// Morton codes of the middles of boxes, ten bits for each axis, with the primitives in their order.

@group(0) @binding(1) var<storage, read_write> boxes: array<Box>;
@group(0) @binding(2) var<storage, read_write> ends: array<u32, 6>;
@group(0) @binding(3) var<storage, read_write> keys: array<u32>;
@group(0) @binding(4) var<storage, read_write> primitives: array<u32>;

fn number_of(code: u32) -> f32 {
    return bitcast<f32>(select(~code, code & 0x7fffffffu, (code >> 31) == 1));
}

// Ten bits with two zeros between each.
fn spread(bits: u32) -> u32 {
    var x = bits & 0x3ffu;
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= plan.count) {
        return;
    }
    let high = vec3f(number_of(ends[0]), number_of(ends[1]), number_of(ends[2]));
    let low = vec3f(number_of(~ends[3]), number_of(~ends[4]), number_of(~ends[5]));
    let middle = boxes[id.x].low * 0.5 + boxes[id.x].high * 0.5;
    let part = (middle - low) / max(high - low, vec3f(1e-30));
    let cell = vec3u(clamp(part * 1024, vec3f(), vec3f(1023)));
    keys[id.x] = (spread(cell.x) << 2) | (spread(cell.y) << 1) | spread(cell.z);
    primitives[id.x] = id.x;
}
