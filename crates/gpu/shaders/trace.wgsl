// Rays through the trees of a world.
//
// A kernel that traces declares the uniform or storage `world` and the buffers `nodes`, `triangles`
// and `instances`; `bvh/mod.rs` and `bvh/node.rs` have their formats.

const STACK = 128;
const NO_HIT = 0xffffffffu;

// The bits of references: leaves, leaves of instances, the number of primitives.
const LEAF = 0x80000000u;
const INSTANCES = 0x40000000u;
const COUNT_BITS = 5u;

struct Hit {
    t: f32,
    // Barycentric coordinates of corners 1 and 2.
    uv: vec2f,
    geometry: u32,
    primitive: u32,
    // `NO_HIT` outside of instances.
    instance: u32,
    found: bool,
}

// A ray prepared for boxes.
struct Slabs {
    inverse: vec3f,
    o: vec3f,
    // A bound of the rounding errors of planes, of the boxes' distances, and of the triangle test.
    margin: vec3f,
}

// A ray prepared for triangles: translated and sheared so that it becomes the z axis.
struct Sheared {
    axis: u32,
    o: vec3f,
    shear: vec3f,
}

fn slabs(o: vec3f, d: vec3f, size: f32) -> Slabs {
    let largest = max(abs(d.x), max(abs(d.y), abs(d.z)));
    // A direction that is almost parallel to a slab gives the answer of a parallel one.
    let least = vec3f(largest * 1e-12);
    let signs = select(vec3f(1), vec3f(-1), d < vec3f());
    let inverse = 1.0 / select(d, signs * least, abs(d) < least);
    let bound = size + max(abs(o.x), max(abs(o.y), abs(o.z)));
    return Slabs(inverse, o, abs(inverse) * (bound * 2e-6));
}

fn permuted(v: vec3f, axis: u32) -> vec3f {
    return select(select(v, v.zxy, axis == 1), v.yzx, axis == 0);
}

fn sheared(o: vec3f, d: vec3f) -> Sheared {
    let size = abs(d);
    let axis = select(select(2u, 1u, size.y > size.z), 0u, size.x > size.y && size.x > size.z);
    let p = permuted(d, axis);
    return Sheared(axis, permuted(o, axis), vec3f(-p.x, -p.y, 1) / p.z);
}

fn sheared_point(ray: Sheared, p: vec3f) -> vec3f {
    let v = permuted(p, ray.axis) - ray.o;
    return vec3f(ray.shear.x * v.z + v.x, ray.shear.y * v.z + v.y, v.z * ray.shear.z);
}

// Twice the area of the origin with an edge. It is computed from the end that comes first, so that
// both triangles at the edge have opposite values, however it is rounded or contracted.
fn edge_function(p: vec2f, q: vec2f) -> f32 {
    let swapped = q.x < p.x || (q.x == p.x && q.y < p.y);
    let a = select(p, q, swapped);
    let b = select(q, p, swapped);
    let area = a.x * b.y - a.y * b.x;
    return select(area, -area, swapped);
}

// Takes the hit on a triangle if it is the nearest so far: at 0 < t < `best.t`, or at the same
// distance as another hit and before it.
fn intersect_triangle(ray: Sheared, index: u32, instance: u32, best: ptr<function, Hit>) {
    let corner = array(triangles[3 * index], triangles[3 * index + 1], triangles[3 * index + 2]);
    let a = sheared_point(ray, bitcast<vec3f>(corner[0].xyz));
    let b = sheared_point(ray, bitcast<vec3f>(corner[1].xyz));
    let c = sheared_point(ray, bitcast<vec3f>(corner[2].xyz));
    let e = vec3f(edge_function(b.xy, c.xy), edge_function(c.xy, a.xy), edge_function(a.xy, b.xy));
    if (any(e < vec3f()) && any(e > vec3f())) {
        return;
    }
    let determinant = e.x + e.y + e.z;
    if (determinant == 0) {
        return;
    }
    let inverse = 1 / determinant;
    let t = (e.x * a.z + (e.y * b.z + e.z * c.z)) * inverse;
    // A bound of the error of t ([Pharr 2023 §6.8.7]); what is nearer may be behind.
    let x = max(abs(a.x), max(abs(b.x), abs(c.x)));
    let y = max(abs(a.y), max(abs(b.y), abs(c.y)));
    let z = max(abs(a.z), max(abs(b.z), abs(c.z)));
    let largest = max(abs(e.x), max(abs(e.y), abs(e.z)));
    let dx = 2.9802322e-7 * (x + z);
    let dy = 2.9802322e-7 * (y + z);
    let de = 2 * (1.1920929e-7 * x * y + dy * x + dx * y);
    let error = 3 * (1.7881393e-7 * largest * z + de * z + largest * (1.7881393e-7 * z)) * abs(inverse);
    if (!(t > error)) {
        return;
    }
    let is_first = instance == (*best).instance && (corner[0].w < (*best).geometry
        || corner[0].w == (*best).geometry && corner[1].w < (*best).primitive);
    if (t < (*best).t || (*best).found && t == (*best).t && is_first) {
        *best = Hit(t, e.yz * inverse, corner[0].w, corner[1].w, instance, true);
    }
}

// Bytes as numbers.
fn bytes(words: vec2u) -> array<f32, 8> {
    let w = words;
    return array(
        f32(w.x & 255), f32(w.x >> 8 & 255), f32(w.x >> 16 & 255), f32(w.x >> 24),
        f32(w.y & 255), f32(w.y >> 8 & 255), f32(w.y >> 16 & 255), f32(w.y >> 24),
    );
}

// The nearest hit at 0 < t < `t_max`; if `is_any`, whichever is found first.
fn trace(o: vec3f, d: vec3f, t_max: f32, is_any: bool) -> Hit {
    var best = Hit(t_max, vec2f(), 0, 0, NO_HIT, false);
    var stack: array<u32, STACK>;
    stack[0] = world.roots.y;
    stack[1] = world.roots.x;
    var top = 2;
    // Within an instance the ray is another one; `outside` is the top of the stack there.
    var ray = slabs(o, d, world.size);
    var shear = sheared(o, d);
    var instance = NO_HIT;
    var outside = 0;
    while (top > 0) {
        if (instance != NO_HIT && top == outside) {
            ray = slabs(o, d, world.size);
            shear = sheared(o, d);
            instance = NO_HIT;
        }
        top--;
        let reference = stack[top];
        if ((reference & LEAF) != 0) {
            let first = (reference & ~(LEAF | INSTANCES)) >> COUNT_BITS;
            let count = reference & ((1u << COUNT_BITS) - 1);
            if ((reference & INSTANCES) == 0) {
                for (var i = 0u; i < count; i++) {
                    intersect_triangle(shear, first + i, instance, &best);
                }
                if (is_any && best.found) {
                    return best;
                }
                continue;
            }
            // The instance that the ray enters; the others wait.
            if (count > 1) {
                stack[top] = LEAF | INSTANCES | ((first + 1) << COUNT_BITS) | (count - 1);
                top++;
            }
            let row = array(
                bitcast<vec4f>(instances[4 * first]),
                bitcast<vec4f>(instances[4 * first + 1]),
                bitcast<vec4f>(instances[4 * first + 2]),
            );
            let placed = instances[4 * first + 3];
            let inner_o = vec3f(dot(row[0], vec4f(o, 1)), dot(row[1], vec4f(o, 1)), dot(row[2], vec4f(o, 1)));
            let inner_d = vec3f(dot(row[0].xyz, d), dot(row[1].xyz, d), dot(row[2].xyz, d));
            ray = slabs(inner_o, inner_d, bitcast<f32>(placed.z));
            shear = sheared(inner_o, inner_d);
            instance = placed.y;
            outside = top;
            stack[top] = placed.x;
            top++;
            continue;
        }
        let at = 6 * reference;
        let head = nodes[at];
        let origin = (bitcast<vec3f>(head.xyz) - ray.o) * ray.inverse;
        let exponents = vec3u(head.w, head.w >> 8, head.w >> 16) & vec3u(255);
        let step = bitcast<vec3f>(exponents << vec3u(23)) * ray.inverse;
        let q = array(nodes[at + 1], nodes[at + 2], nodes[at + 3]);
        let low_x = bytes(q[0].xy);
        let low_y = bytes(q[0].zw);
        let low_z = bytes(q[1].xy);
        let high_x = bytes(q[1].zw);
        let high_y = bytes(q[2].xy);
        let high_z = bytes(q[2].zw);
        let children = array(nodes[at + 4], nodes[at + 5]);
        // Children are sorted as they are pushed, the nearest last.
        let base = top;
        var distances: array<f32, 8>;
        for (var i = 0; i < 8; i++) {
            let child = children[i >> 2][i & 3];
            if (child == LEAF) {
                break;
            }
            let low = origin + vec3f(low_x[i], low_y[i], low_z[i]) * step;
            let high = origin + vec3f(high_x[i], high_y[i], high_z[i]) * step;
            let near = min(low, high) - ray.margin;
            let far = max(low, high) + ray.margin;
            let enter = max(max(near.x, near.y), max(near.z, 0));
            let leave = min(min(far.x, far.y), min(far.z, best.t));
            if (enter <= leave) {
                var place = top;
                while (place > base && distances[place - base - 1] < enter) {
                    distances[place - base] = distances[place - base - 1];
                    stack[place] = stack[place - 1];
                    place--;
                }
                distances[place - base] = enter;
                stack[place] = child;
                top++;
            }
        }
    }
    return best;
}
