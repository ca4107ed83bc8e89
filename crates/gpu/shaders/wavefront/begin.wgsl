// Paths begin, in the places of those that have ended, and behind those that go on.

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    // The first paths have the places of their samples.
    let sample = batch.first + id.x;
    var path = path_in(ENDED, id.x, batch.beginning);
    if (path == NO_PATH) {
        return;
    }
    path = select(path, sample, sample < batch.places);
    let camera = camera_sample(pixel_of(sample), index_of(sample));
    rays = 0;
    table[2 * sample + 1] = bitcast<vec4u>(vec4f(0, 0, camera.wavelength, camera.weight));
    keep_path(path, sample, new_path(camera.ray, camera.near), camera.lambda, vec4f());
    batch.queues[PATHS * batch.places + batch.going_on + id.x] = path;
}
