// Boxes.

struct Box {
    low: vec3f,
    high: vec3f,
}

// Around nothing: joined with another one, it gives that.
const NOTHING = Box(vec3f(3e38), vec3f(-3e38));

fn joined(a: Box, b: Box) -> Box {
    return Box(min(a.low, b.low), max(a.high, b.high));
}
