// Eight levels of the pyramid. Box i is around 2i and 2i + 1; the base begins at the number of its
// boxes, the top is box 1. A workgroup has a part of 256 boxes of one level, and those above it.

@group(0) @binding(1) var<storage, read_write> pyramid: array<Box>;

const PART = 256u;

var<workgroup> part: array<Box, PART>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let width = plan.leaves >> (8 * plan.step);
    let side = min(width, PART);
    if (local < side) {
        part[local] = pyramid[width + side * group.x + local];
    }
    workgroupBarrier();
    var level = width / 2;
    for (var pairs = side / 2; pairs > 0; pairs /= 2) {
        var above = NOTHING;
        if (local < pairs) {
            above = joined(part[2 * local], part[2 * local + 1]);
            pyramid[level + pairs * group.x + local] = above;
        }
        workgroupBarrier();
        if (local < pairs) {
            part[local] = above;
        }
        workgroupBarrier();
        level /= 2;
    }
}
