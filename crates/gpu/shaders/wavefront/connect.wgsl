// Adds the direct light of paths whose shadow rays hit nothing.

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let path = path_in(SHADOWS, id.x, batch.shadows);
    if (path == NO_PATH) {
        return;
    }
    let o = numbers(SHADOW_O, path);
    shutter_time = numbers(RAY_O, path).w;
    if (!trace(o.xyz, numbers(SHADOW_D, path).xyz, o.w, true).found) {
        let sample = sample_of(path);
        keep_light(sample, kept_light(sample) + numbers(DIRECT, path));
    }
}
