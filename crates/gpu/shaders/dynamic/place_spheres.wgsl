// Takes spheres to where they are: their items and boxes.

@group(0) @binding(1) var<storage, read_write> items: array<vec4u>;
// Three numbers for each point.
@group(0) @binding(2) var<storage, read_write> points: array<f32>;
// The first point of each geometry.
@group(0) @binding(3) var<storage, read_write> spheres: array<u32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    if (id.x < plan.count) {
        let at = 5 * (plan.first_item + id.x);
        let ids = items[at + 4];
        // An instance has no geometry.
        if (ids.x == ItemTag_Ball && spheres[ids.y] != AT_REST) {
            let base = 3 * (spheres[ids.y] + ids.z);
            let center = vec3f(points[base], points[base + 1], points[base + 2]);
            let radius = bitcast<f32>(items[at].w);
            items[at] = bitcast<vec4u>(vec4f(center, radius));
            // More than the rounding errors of the planes.
            let reach = vec3f(radius) + (abs(center) + radius) * 2.4e-7;
            boxes[id.x] = Box(center - reach, center + reach);
        }
    }
    add_middle(id.x, local);
}
