// The picture: the mean of the samples of each pixel, and the number of rays.

struct Shown {
    rays: u32,
    colors: array<f32>,
}

@group(0) @binding(0) var<uniform> frame: FrameParameters;
@group(0) @binding(1) var<storage, read_write> film: Film;
@group(0) @binding(2) var<storage, read_write> shown: Shown;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let at = id.y * frame.size.x + id.x;
    let sum = film.pixels[at].sum;
    let color = select(sum.xyz / sum.w, vec3f(), sum.w == 0);
    shown.colors[3 * at] = color.x;
    shown.colors[3 * at + 1] = color.y;
    shown.colors[3 * at + 2] = color.z;
    if (at == 0) {
        shown.rays = atomicExchange(&film.rays, 0);
    }
}
