// The box of the middles of all boxes.

@group(0) @binding(4) var<storage, read_write> boxes: array<Box>;
// Codes of the highest coordinates along each axis, and complements of those of the lowest.
@group(0) @binding(5) var<storage, read_write> ends: array<atomic<u32>, 6>;

const AT_REST = 0xffffffffu;

var<workgroup> ends_of_group: array<atomic<u32>, 6>;

// A word for a number, in the same order.
fn ordered(x: f32) -> u32 {
    let bits = bitcast<u32>(x);
    return select(bits | 0x80000000u, ~bits, (bits >> 31) == 1);
}

// Takes the middle of a box into account. All threads call it.
fn add_middle(index: u32, local: u32) {
    if (index < plan.count) {
        let middle = boxes[index].low * 0.5 + boxes[index].high * 0.5;
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
