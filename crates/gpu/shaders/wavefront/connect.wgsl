// Adds the direct light of paths whose shadow rays hit nothing.

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let path = path_in(SHADOWS, id.x);
    if (path == NO_PATH) {
        return;
    }
    let o = numbers(SHADOW_O, path);
    shutter_time = numbers(RAY_O, path).w;
    if (!trace(o.xyz, numbers(SHADOW_D, path).xyz, o.w, true).found) {
        keep_numbers(L, path, numbers(L, path) + numbers(DIRECT, path));
    }
}
