// Takes instances to where they are: the matrices of their items, and their boxes.

@group(0) @binding(1) var<storage, read_write> items: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> placements: array<Placement>;
@group(0) @binding(3) var<storage, read_write> boxes: array<Box>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= plan.count) {
        return;
    }
    let item = placements[id.x].item;
    for (var i = 0u; i < 3; i++) {
        items[5 * (plan.first_item + item) + i] = placements[id.x].rows[i];
    }
    boxes[item] = Box(placements[id.x].low, placements[id.x].high);
}
