// A sample of each pixel of a batch: the radiance along the camera ray.

@group(0) @binding(5) var<storage, read_write> batch: Batch;
@group(0) @binding(6) var<storage, read_write> samples: array<PixelSample>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= batch.size)) {
        return;
    }
    let camera = camera_sample(batch.low + id.xy, batch.index);
    var lambda = camera.lambda;
    rays = 0;
    var l: vec4f;
    if (!HAS_LENSES || camera.share > 0) {
        l = radiance(camera.ray, camera.near, &lambda) * camera.share;
    }
    let is_terminated = u32(SampledWavelengths_secondary_terminated(lambda));
    samples[id.y * batch.size.x + id.x] = PixelSample(l, rays, is_terminated, camera.wavelength, camera.weight);
}
