// A frame: what all kernels of it share.

// The light of a pixel: colours times weights, and weights, of this frame, and of the picture at
// rest so far; and the filtered colour of the last frame in motion.
struct Light {
    now: vec4f,
    sum: vec4f,
    filtered: vec4f,
}

struct Film {
    rays: atomic<u32>,
    pixels: array<Light>,
}

// What is seen at the middle of a pixel.
struct Seen {
    // The point, or where there is none the direction.
    p: vec3f,
    // Along the ray.
    distance: f32,
    n: vec3f,
    // What it is: of the same number are surfaces of one material, of one light, or the sky (0).
    id: u32,
    // Reflectance, or emission of lights and the sky: colours are filtered as parts of it.
    guide: vec3f,
}

// What is known of a pixel from frame to frame, as parts of its guide.
struct History {
    color: vec3f,
    // Frames that it is the mean of.
    count: f32,
    // The means of luminance and of its square.
    moments: vec2f,
}

fn luminance(color: vec3f) -> f32 {
    return dot(color, vec3f(0.2126, 0.7152, 0.0722));
}

// How much the surface at `b` is the one at `a`, going on: by what it is, by its normal, and by the
// angle at which the way there leaves the plane of `a`.
fn likeness(a: Seen, b: Seen) -> f32 {
    if (a.id != b.id) {
        return 0;
    }
    if (a.id == 0) {
        return 1;
    }
    let way = b.p - a.p;
    let off = abs(dot(a.n, way));
    let facing = max(dot(a.n, b.n), 0);
    return pow(facing, 64) * exp(-off / (0.1 * length(way) + 1e-4 * a.distance));
}

// Where the camera of the frame before saw a point, or a direction: the position on its film, in
// pixels of the frame, with their centres at whole numbers. The last component is 0 where that is
// nowhere.
fn place_before(v: vec3f, is_point: bool) -> vec3f {
    let p = vec4f(v, select(0.0, 1.0, is_point));
    let q = vec3f(dot(frame.eye.rows[0], p), dot(frame.eye.rows[1], p), dot(frame.eye.rows[2], p));
    var screen = q.xy;
    if (frame.eye.is_orthographic == 0) {
        if (q.z <= 0) {
            return vec3f();
        }
        screen /= q.z;
    }
    return vec3f((screen - frame.eye.screen.xy) / frame.eye.screen.zw - 0.5 - vec2f(frame.low), 1);
}
