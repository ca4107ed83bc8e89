// The light of a frame: some samples of each pixel.

@group(0) @binding(5) var<uniform> frame: FrameParameters;
@group(0) @binding(6) var<storage, read_write> film: Film;

var<workgroup> rays_of_group: atomic<u32>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    rays = 0;
    if (all(id.xy < frame.size)) {
        let at = id.y * frame.size.x + id.x;
        var sum = vec4f();
        // The first sample of a frame in motion is that of `surfaces.wgsl`.
        has_camera_hit = frame.is_moving == 1;
        if (has_camera_hit) {
            camera_hit = kept_hit(at);
        }
        for (var i = 0u; i < frame.samples; i++) {
            let camera = camera_sample(frame.low + id.xy, frame.index + i);
            var lambda = camera.lambda;
            let l = radiance(camera.ray, camera.near, &lambda);
            sum += exposed(l, lambda, camera.weight);
        }
        film.pixels[at].now = sum;
        var before = vec4f();
        if (frame.before > 0) {
            before = film.pixels[at].sum;
        }
        film.pixels[at].sum = before + sum;
    }
    atomicAdd(&rays_of_group, rays);
    workgroupBarrier();
    if (local == 0) {
        atomicAdd(&film.rays, atomicLoad(&rays_of_group));
    }
}
