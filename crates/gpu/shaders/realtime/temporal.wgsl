// Temporal accumulation: what the frames before have found of the same surfaces.

@group(0) @binding(0) var<uniform> frame: FrameParameters;
@group(0) @binding(1) var<storage, read_write> seen: array<Seen>;
@group(0) @binding(2) var<storage, read_write> film: Film;
@group(0) @binding(3) var<storage, read_write> history: array<History>;

// The most frames that are averaged, so that what depends on the direction of view follows it.
const MOST_FRAMES = 32.0;

// Whether the point that was seen is the one that is seen now, up to the width of pixels.
fn is_same(now: Seen, then: Seen) -> bool {
    if (now.id != then.id) {
        return false;
    }
    let off = abs(dot(now.n, then.p - now.p));
    return now.id == 0 || (dot(now.n, then.n) > 0.9 && off < 0.01 * now.distance);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let pixels = frame.size.x * frame.size.y;
    let at = id.y * frame.size.x + id.x;
    let now = seen[frame.half * pixels + at];
    let light = film.pixels[at].now;
    let color = select(light.xyz / light.w, vec3f(), light.w == 0) / now.guide;
    let y = luminance(color);
    var sum = History();
    var weights = 0.0;
    let place = place_before(now.p, now.id != 0);
    if (frame.has_history == 1 && place.z == 1) {
        let corner = floor(place.xy);
        let within = place.xy - corner;
        for (var i = 0u; i < 4; i++) {
            let offset = vec2u(i & 1, i >> 1);
            let pixel = vec2i(corner) + vec2i(offset);
            if (any(pixel < vec2i()) || any(pixel >= vec2i(frame.size))) {
                continue;
            }
            let there = (1 - frame.half) * pixels + u32(pixel.y) * frame.size.x + u32(pixel.x);
            if (!is_same(now, seen[there])) {
                continue;
            }
            let shares = select(1 - within, within, offset == vec2u(1));
            let weight = shares.x * shares.y;
            let old = history[there];
            sum.color += weight * old.color;
            sum.count += weight * old.count;
            sum.moments += weight * old.moments;
            weights += weight;
        }
    }
    var next = History(color, 1, vec2f(y, y * y));
    if (weights > 0.01) {
        let count = min(sum.count / weights + 1, MOST_FRAMES);
        next.color = mix(sum.color / weights, next.color, 1 / count);
        next.moments = mix(sum.moments / weights, next.moments, 1 / count);
        next.count = count;
    }
    history[frame.half * pixels + at] = next;
}
