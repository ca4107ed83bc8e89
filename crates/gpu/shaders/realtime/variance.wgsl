// The variance of the mean of each pixel: from its own frames, or while these are few from its
// neighbours.

@group(0) @binding(0) var<uniform> frame: FrameParameters;
@group(0) @binding(1) var<storage, read_write> seen: array<Seen>;
@group(0) @binding(2) var<storage, read_write> history: array<History>;
@group(0) @binding(3) var<storage, read_write> estimates: array<vec4f>;

// As many frames have a variance of their own.
const ENOUGH_FRAMES = 4.0;

// The pixels around that stand for frames.
const RADIUS = 3;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let first = frame.half * frame.size.x * frame.size.y;
    let at = id.y * frame.size.x + id.x;
    let here = history[first + at];
    var moments = here.moments;
    if (here.count < ENOUGH_FRAMES) {
        let middle = seen[first + at];
        var weights = 1.0;
        for (var y = -RADIUS; y <= RADIUS; y++) {
            for (var x = -RADIUS; x <= RADIUS; x++) {
                let pixel = vec2i(id.xy) + vec2i(x, y);
                let is_here = x == 0 && y == 0;
                if (is_here || any(pixel < vec2i()) || any(pixel >= vec2i(frame.size))) {
                    continue;
                }
                let there = first + u32(pixel.y) * frame.size.x + u32(pixel.x);
                let weight = likeness(middle, seen[there]);
                moments += weight * history[there].moments;
                weights += weight;
            }
        }
        moments /= weights;
    }
    let variance = max(moments.y - moments.x * moments.x, 0) / here.count;
    estimates[at] = vec4f(here.color, variance);
}
