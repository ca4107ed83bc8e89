// A level of nodes of eight children, of the binary tree. Each node has what is three levels below
// its root, and then, while there is room, the children of its largest child.
//
// So a level has at least three of the binary tree, and the number of levels has a bound. Where
// nodes of a level are in the buffer depends on the order of threads, what is in them does not.

@group(0) @binding(1) var<storage, read_write> inner: array<Inner>;
@group(0) @binding(2) var<storage, read_write> bounds: array<Box>;
@group(0) @binding(3) var<storage, read_write> nodes: array<vec4u>;
// The children of each node, in the binary tree; of a node that is not yet made, its root first.
@group(0) @binding(4) var<storage, read_write> children: array<u32>;
// The number of nodes of each level.
@group(0) @binding(5) var<storage, read_write> levels: array<atomic<u32>>;

fn half_area(node: u32) -> f32 {
    let size = bounds[node].high - bounds[node].low;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    var begin = 0u;
    for (var level = 0u; level < plan.step; level++) {
        begin += atomicLoad(&levels[level]);
    }
    let count = atomicLoad(&levels[plan.step]);
    for (var i = id.x; i < count; i += 64 * groups.x) {
        let node = begin + i;
        var open: array<u32, WIDTH>;
        open[0] = children[WIDTH * node];
        var size = 1u;
        for (var level = 0; level < 3; level++) {
            let before = size;
            for (var child = 0u; child < before; child++) {
                if ((open[child] & IS_LEAF) == 0) {
                    let parts = halves(open[child], inner[open[child]]);
                    open[child] = parts.x;
                    open[size] = parts.y;
                    size++;
                }
            }
        }
        while (size < WIDTH) {
            var largest = WIDTH;
            var most = -1.0;
            for (var child = 0u; child < size; child++) {
                if ((open[child] & IS_LEAF) == 0) {
                    let area = half_area(open[child]);
                    if (area > most) {
                        most = area;
                        largest = child;
                    }
                }
            }
            if (largest == WIDTH) {
                break;
            }
            let parts = halves(open[largest], inner[open[largest]]);
            open[largest] = parts.x;
            open[size] = parts.y;
            size++;
        }
        var wanted = 0u;
        for (var child = 0u; child < size; child++) {
            wanted += select(0u, 1u, (open[child] & IS_LEAF) == 0);
        }
        var next = begin + count + atomicAdd(&levels[plan.step + 1], wanted);
        for (var child = 0u; child < WIDTH; child++) {
            var own = NONE;
            if (child < size) {
                own = open[child];
                if ((own & IS_LEAF) == 0) {
                    nodes[6 * (plan.first_node + node) + 4 + child / 4][child % 4] = plan.first_node + next;
                    children[WIDTH * next] = own;
                    next++;
                }
            }
            children[WIDTH * node + child] = own;
        }
    }
}
