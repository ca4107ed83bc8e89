// Transforms, and those that move between two keys: cameras and instances.

// The time of the sample, where anything moves.
var<private> shutter_time: f32;

// The rows of a matrix.
struct Rows {
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

fn times(m: Rows, v: vec3f) -> vec3f {
    return vec3f(dot(m.x, v), dot(m.y, v), dot(m.z, v));
}

fn transposed(m: Rows, v: vec3f) -> vec3f {
    return m.x * v.x + m.y * v.y + m.z * v.z;
}

fn inverse(m: Rows) -> Rows {
    let a = cross(m.y, m.z);
    let b = cross(m.z, m.x);
    let c = cross(m.x, m.y);
    let scale = 1 / dot(m.x, a);
    return Rows(vec3f(a.x, b.x, c.x) * scale, vec3f(a.y, b.y, c.y) * scale, vec3f(a.z, b.z, c.z) * scale);
}

fn absolute(m: Rows) -> Rows {
    return Rows(abs(m.x), abs(m.y), abs(m.z));
}

// An affine transform.
struct Placement {
    linear: Rows,
    translation: vec3f,
}

// One in the tables.
fn kept_placement(at: u32) -> Placement {
    let row = rows_at(at);
    return Placement(Rows(row[0].xyz, row[1].xyz, row[2].xyz), vec3f(row[0].w, row[1].w, row[2].w));
}

// A point that is taken along.
fn times_point(m: Placement, p: vec3f) -> vec3f {
    return times(m.linear, p) + m.translation;
}

// What a transform at a time is made of.
struct Key {
    time: f32,
    translation: vec3f,
    // A unit quaternion.
    rotation: vec4f,
    stretch: Rows,
}

// Two keys, and the angle between their quaternions.
struct Motion {
    start: Key,
    end: Key,
    angle: f32,
}

// The numbers of a key in the tables.
const MOTION_KEY = 20u;

fn kept_key(at: u32) -> Key {
    let first = numbers_at(at);
    return Key(first.w, first.xyz, numbers_at(at + 4), Rows(vector(at + 8), vector(at + 12), vector(at + 16)));
}

// A motion in the tables.
fn kept_motion(at: u32) -> Motion {
    return Motion(kept_key(at), kept_key(at + MOTION_KEY), number(at + 11));
}

// A transform at a time, interpolated between two keys as in `math/src/animated.rs`.
fn placement_at(motion: Motion, time: f32) -> Placement {
    let start = motion.start;
    let end = motion.end;
    let t = clamp((time - start.time) / (end.time - start.time), 0, 1);
    var weights = vec2f(1 - t, t);
    if (motion.angle > 1e-4) {
        weights = vec2f(sin_cos((1 - t) * motion.angle).v0, sin_cos(t * motion.angle).v0)
            / sin_cos(motion.angle).v0;
    }
    let q = start.rotation * weights.x + end.rotation * weights.y;
    let twice = 2 * q.xyz;
    let squares = q.xyz * twice;
    let products = q.xxy * twice.yzz;
    let turns = q.w * twice;
    let stretch = Rows(
        mix(start.stretch.x, end.stretch.x, t),
        mix(start.stretch.y, end.stretch.y, t),
        mix(start.stretch.z, end.stretch.z, t),
    );
    let x = vec3f(1 - squares.y - squares.z, products.x - turns.z, products.y + turns.y);
    let y = vec3f(products.x + turns.z, 1 - squares.x - squares.z, products.z - turns.x);
    let z = vec3f(products.y - turns.y, products.z + turns.x, 1 - squares.x - squares.y);
    let linear = Rows(transposed(stretch, x), transposed(stretch, y), transposed(stretch, z));
    return Placement(linear, mix(start.translation, end.translation, t));
}

// A key among the items.
fn key_of_item(item: u32) -> Key {
    let first = bitcast<vec4f>(items[5 * item]);
    let stretch = Rows(
        bitcast<vec3f>(items[5 * item + 2].xyz),
        bitcast<vec3f>(items[5 * item + 3].xyz),
        bitcast<vec3f>(items[5 * item + 4].xyz),
    );
    return Key(first.w, first.xyz, bitcast<vec4f>(items[5 * item + 1]), stretch);
}

// The rows of the matrix that takes rays into an instance at the time of the sample, by motions of
// two keys each, the outermost first.
fn moved_rows(first_key: u32, motions: u32) -> array<vec4f, 3> {
    var rows = array(vec4f(1, 0, 0, 0), vec4f(0, 1, 0, 0), vec4f(0, 0, 1, 0));
    for (var i = 0u; i < motions; i++) {
        let key = first_key + 2 * i;
        let angle = bitcast<f32>(items[5 * key + 2].w);
        let placement = placement_at(Motion(key_of_item(key), key_of_item(key + 1), angle), shutter_time);
        let inward = inverse(placement.linear);
        let translation = -times(inward, placement.translation);
        rows = array(
            further_row(inward.x, translation.x, rows),
            further_row(inward.y, translation.y, rows),
            further_row(inward.z, translation.z, rows),
        );
    }
    return rows;
}

// A row of a matrix after others.
fn further_row(row: vec3f, translation: f32, others: array<vec4f, 3>) -> vec4f {
    return others[0] * row.x + others[1] * row.y + others[2] * row.z + vec4f(0, 0, 0, translation);
}
