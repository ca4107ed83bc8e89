// The picture: filtered while the camera moves, and the mean of the samples of each pixel when it
// rests, into which the filtered one goes over.

struct Shown {
    rays: u32,
    colors: array<f32>,
}

@group(0) @binding(0) var<uniform> frame: FrameParameters;
@group(0) @binding(1) var<storage, read_write> film: Film;
@group(0) @binding(2) var<storage, read_write> shown: Shown;
@group(0) @binding(3) var<storage, read_write> seen: array<Seen>;
@group(0) @binding(4) var<storage, read_write> smoothed: array<vec4f>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let at = id.y * frame.size.x + id.x;
    var color: vec3f;
    if (frame.is_moving == 1) {
        color = smoothed[at].xyz * seen[frame.half * frame.size.x * frame.size.y + at].guide;
        film.pixels[at].filtered = vec4f(color, 1);
    } else {
        let sum = film.pixels[at].sum;
        let mean = select(sum.xyz / sum.w, vec3f(), sum.w == 0);
        let count = f32(frame.before + frame.samples);
        color = mix(mean, film.pixels[at].filtered.xyz, frame.prior / (frame.prior + count));
    }
    shown.colors[3 * at] = color.x;
    shown.colors[3 * at + 1] = color.y;
    shown.colors[3 * at + 2] = color.z;
    if (at == 0) {
        shown.rays = atomicExchange(&film.rays, 0);
    }
}
