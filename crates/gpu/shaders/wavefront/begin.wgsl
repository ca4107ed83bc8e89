// Paths begin: a camera ray of each pixel.

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= batch.count) {
        return;
    }
    let camera = camera_sample(pixel_of(id.x), batch.index);
    rays = 0;
    keep(COUNTS, id.x, bitcast<vec4u>(vec4f(0, 0, camera.wavelength, camera.weight)));
    keep_path(id.x, new_path(camera.ray, camera.near), camera.lambda, vec4f());
    batch.queues[id.x] = id.x;
}
