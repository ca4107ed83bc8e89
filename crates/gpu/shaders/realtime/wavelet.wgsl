// A level of the à-trous wavelet filter, which stops at edges of surfaces, and at those of light as
// far as its variance tells them from noise.

@group(0) @binding(0) var<uniform> frame: FrameParameters;
@group(0) @binding(1) var<storage, read_write> seen: array<Seen>;
@group(0) @binding(2) var<storage, read_write> history: array<History>;
@group(0) @binding(3) var<storage, read_write> estimates: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> smoothed: array<vec4f>;
@group(0) @binding(5) var<uniform> level: Level;

// Standard deviations by which neighbours may differ.
const DEVIATIONS = 4.0;

// The variance around a pixel, smoothed.
fn variance_at(pixel: vec2i) -> f32 {
    var sum = 0.0;
    var weights = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let there = pixel + vec2i(x, y);
            if (all(there >= vec2i()) && all(there < vec2i(frame.size))) {
                let weight = 1 / f32((1 + abs(x)) * (1 + abs(y)));
                sum += weight * estimates[u32(there.y) * frame.size.x + u32(there.x)].w;
                weights += weight;
            }
        }
    }
    return sum / weights;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let kernel = array(0.375, 0.25, 0.0625);
    let first = frame.half * frame.size.x * frame.size.y;
    let at = id.y * frame.size.x + id.x;
    let middle = seen[first + at];
    let here = estimates[at];
    let y_here = luminance(here.xyz);
    let scale = DEVIATIONS * sqrt(variance_at(vec2i(id.xy))) + 1e-3 * y_here + 1e-12;
    var sum = here.xyz;
    var variance = here.w;
    var weights = 1.0;
    for (var y = -2; y <= 2; y++) {
        for (var x = -2; x <= 2; x++) {
            let pixel = vec2i(id.xy) + level.step * vec2i(x, y);
            let is_here = x == 0 && y == 0;
            if (is_here || any(pixel < vec2i()) || any(pixel >= vec2i(frame.size))) {
                continue;
            }
            let there = u32(pixel.y) * frame.size.x + u32(pixel.x);
            let other = estimates[there];
            let share = kernel[abs(x)] * kernel[abs(y)] / (kernel[0] * kernel[0]);
            let weight = share * likeness(middle, seen[first + there])
                * exp(-abs(luminance(other.xyz) - y_here) / scale);
            sum += weight * other.xyz;
            variance += weight * weight * other.w;
            weights += weight;
        }
    }
    let color = sum / weights;
    smoothed[at] = vec4f(color, variance / (weights * weights));
    if (level.is_kept == 1) {
        history[first + at].color = color;
    }
}
