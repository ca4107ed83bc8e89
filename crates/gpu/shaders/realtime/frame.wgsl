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
}

// The light of a pixel: colours times weights, and weights, of this frame, and of the picture at
// rest so far.
struct Light {
    now: vec4f,
    sum: vec4f,
}

struct Film {
    rays: atomic<u32>,
    pixels: array<Light>,
}
