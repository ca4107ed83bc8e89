// A frame: what all kernels of it share.

struct FrameParameters {
    // The first pixel, and how many there are.
    low: vec2u,
    size: vec2u,
    // The index of the first sample of each pixel, how many there are of each, and how many there
    // were before of the picture at rest.
    index: u32,
    samples: u32,
    before: u32,
    // Which half of the buffers is of this frame, and whether the other is of the one before.
    half: u32,
    has_history: u32,
    // Whether the camera moves, and the number of samples for which the filtered picture counts
    // while one at rest begins.
    is_moving: u32,
    prior: f32,
    // The camera of the frame before: whether it is orthographic, its screen (top left and pixel),
    // and the rows of the matrix from render space.
    is_orthographic: u32,
    screen: vec4f,
    rows: array<vec4f, 3>,
}

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
