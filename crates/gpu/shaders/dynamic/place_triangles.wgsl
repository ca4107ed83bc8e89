// Takes triangles to where their vertices are, and finds their boxes.

@group(0) @binding(1) var<storage, read_write> triangles: array<vec4u>;
// Three numbers for each point.
@group(0) @binding(2) var<storage, read_write> points: array<f32>;
// Three points of each triangle.
@group(0) @binding(3) var<storage, read_write> corners: array<u32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    if (id.x < plan.count && corners[3 * id.x] != AT_REST) {
        var all = NOTHING;
        for (var i = 0u; i < 3; i++) {
            let base = 3 * corners[3 * id.x + i];
            let point = vec3f(points[base], points[base + 1], points[base + 2]);
            let at = 3 * (plan.first_item + id.x) + i;
            triangles[at] = vec4u(bitcast<vec3u>(point), triangles[at].w);
            all = joined(all, Box(point, point));
        }
        boxes[id.x] = all;
    }
    add_middle(id.x, local);
}
