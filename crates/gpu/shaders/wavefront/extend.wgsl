// Finds what the rays of paths hit.

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let path = path_in(batch.turn, id.x);
    if (path == NO_PATH) {
        return;
    }
    let o = numbers(RAY_O, path);
    shutter_time = o.w;
    let hit = trace(o.xyz, numbers(RAY_D, path).xyz, infinity(), false);
    let bits = select(0u, FOUND, hit.found) | select(0u, IS_TRIANGLE, hit.is_triangle);
    keep(HIT, path, vec4u(bitcast<u32>(hit.t), bitcast<vec2u>(hit.uv), hit.geometry));
    keep(HIT_IDS, path, vec4u(hit.primitive, hit.place, hit.instance, bits));
}
