// Rays through the trees of a world; `shapes.wgsl` has those that meet what is not a triangle.
//
// A kernel that traces declares the buffers `world`, `nodes`, `triangles` and `items`; `bvh/` has
// their formats. It has `accepts`, which says whether a hit on a surface that is cut out counts;
// `HAS_CURVES`, whether there are curves; `ribbon_normal`, the normal of one; `HAS_MOTION`, whether
// instances move; and `moved_rows`, the matrix of one at the time of rays.

// The entries of a ray's stack. They are few, because all are set to zero before each ray.
const STACK = 24u;

const NO_HIT = 0xffffffffu;

// The bits of references: leaves, leaves of items, the number of primitives.
const LEAF = 0x80000000u;
const ITEMS = 0x40000000u;
const COUNT_BITS = 5u;

// The bit of a node on the stack of which some children wait together: those of some bits, instead
// of a distance.
const TOGETHER = 0x40000000u;

struct Hit {
    t: f32,
    // Barycentric coordinates of corners 1 and 2, or the parameters of a patch.
    uv: vec2f,
    geometry: u32,
    primitive: u32,
    // The index of the triangle or of the item.
    place: u32,
    is_triangle: bool,
    // The index of the instance's item; `NO_HIT` outside of instances.
    instance: u32,
    found: bool,
}

// What is kept of a hit while a ray is traced; `place` is `NO_HIT` where nothing is found.
struct Nearest {
    t: f32,
    uv: vec2f,
    place: u32,
    is_triangle: bool,
    instance: u32,
    // Whether it is to be accepted.
    is_cut_out: bool,
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
fn intersect_triangle(ray: Sheared, index: u32, instance: u32, best: ptr<function, Nearest>) {
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
    if (!(t > 0 && t <= (*best).t)) {
        return;
    }
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
    if (t == (*best).t) {
        let before = (*best).place;
        if (before == NO_HIT || !(*best).is_triangle || instance != (*best).instance) {
            return;
        }
        let geometry = triangles[3 * before].w;
        let is_first = corner[0].w < geometry
            || (corner[0].w == geometry && corner[1].w < triangles[3 * before + 1].w);
        if (!is_first) {
            return;
        }
    }
    *best = Nearest(t, e.yz * inverse, index, true, instance, corner[2].w == 1);
}

// The distances of four planes across each axis, whose numbers of steps are bytes. Children are
// tested four at a time by vectors, because what is in arrays with indices that vary is in memory,
// and loops are not unrolled.
fn planes(bytes: vec3u, origin: vec3f, step: vec3f) -> array<vec4f, 3> {
    return array(
        vec4f(unpack4xU8(bytes.x)) * step.x + origin.x,
        vec4f(unpack4xU8(bytes.y)) * step.y + origin.y,
        vec4f(unpack4xU8(bytes.z)) * step.z + origin.z,
    );
}

// Where a ray enters four boxes, and which of them it hits.
struct FourBoxes {
    begin: vec4f,
    are_hit: vec4<bool>,
}

// The boxes of children with these planes, before `t_max`.
fn four_boxes(enter: array<vec4f, 3>, leave: array<vec4f, 3>, children: vec4u, t_max: f32) -> FourBoxes {
    let begin = max(max(enter[0], enter[1]), max(enter[2], vec4f()));
    let end = min(min(leave[0], leave[1]), min(leave[2], vec4f(t_max)));
    return FourBoxes(begin, (begin <= end) & (children != vec4u(LEAF)));
}

// Takes a child that is hit: the nearest one of the node is next, and the others wait on the stack.
// Both are a reference with the distance where the ray enters its box.
fn take(
    child: u32, distance: f32, is_hit: bool,
    next: ptr<function, vec2u>, stack: ptr<function, array<vec2u, STACK>>, top: ptr<function, u32>,
) {
    if (!is_hit) {
        return;
    }
    // Distances are not negative, so that their bits have their order.
    let taken = vec2u(child, bitcast<u32>(distance));
    let before = *next;
    if (before.x == LEAF) {
        *next = taken;
        return;
    }
    let is_nearer = taken.y < before.y;
    *next = select(before, taken, is_nearer);
    (*stack)[*top] = select(taken, before, is_nearer);
    (*top)++;
}

fn take_four(
    children: vec4u, boxes: FourBoxes,
    next: ptr<function, vec2u>, stack: ptr<function, array<vec2u, STACK>>, top: ptr<function, u32>,
) {
    take(children.x, boxes.begin.x, boxes.are_hit.x, next, stack, top);
    take(children.y, boxes.begin.y, boxes.are_hit.y, next, stack, top);
    take(children.z, boxes.begin.z, boxes.are_hit.z, next, stack, top);
    take(children.w, boxes.begin.w, boxes.are_hit.w, next, stack, top);
}

// A bit for each of four that are set.
fn bits(are_set: vec4<bool>) -> u32 {
    let bits = select(vec4u(), vec4u(1, 2, 4, 8), are_set);
    return (bits.x | bits.y) | (bits.z | bits.w);
}

// The id of the innermost instance that is hit; `NO_HIT` outside of instances.
fn instance_id(hit: Hit) -> u32 {
    if (hit.instance == NO_HIT) {
        return NO_HIT;
    }
    return items[5 * hit.instance + 3].w;
}

// All of a hit.
fn whole(hit: Nearest) -> Hit {
    var whole = Hit(hit.t, hit.uv, 0, 0, hit.place, hit.is_triangle, hit.instance, true);
    if (hit.place == NO_HIT) {
        whole.found = false;
    } else if (hit.is_triangle) {
        whole.geometry = triangles[3 * hit.place].w;
        whole.primitive = triangles[3 * hit.place + 1].w;
    } else {
        let ids = items[5 * hit.place + 4];
        whole.geometry = ids.y;
        whole.primitive = ids.z;
    }
    return whole;
}

// The rows of the matrix that takes rays into an instance.
fn instance_rows(item: u32) -> array<vec4f, 3> {
    let placed = items[5 * item + 4];
    if (HAS_MOTION && placed.z != 0) {
        return moved_rows(placed.y, placed.z);
    }
    return array(
        bitcast<vec4f>(items[5 * item]), bitcast<vec4f>(items[5 * item + 1]), bitcast<vec4f>(items[5 * item + 2]),
    );
}

// The nearest hit at 0 < t < `t_max`; if `is_any`, whichever is found first.
fn trace(o: vec3f, d: vec3f, t_max: f32, is_any: bool) -> Hit {
    var best = Nearest(t_max, vec2f(), NO_HIT, false, NO_HIT, false);
    // What is next, if anything, and what waits.
    var next = vec2u(LEAF, 0);
    var stack: array<vec2u, STACK>;
    stack[0] = vec2u(world.roots.y, 0);
    stack[1] = vec2u(world.roots.x, 0);
    stack[2] = vec2u(world.unbounded, 0);
    var top = 3u;
    // Within an instance the ray is another one; `outside` is the top of the stack there.
    var ray = slabs(o, d, world.size);
    var shear = sheared(o, d);
    var inner_o = o;
    var inner_d = d;
    var instance = NO_HIT;
    var outside = 0u;
    // What a shape is to be hit beyond.
    var after = 0.0;
    loop {
        if (next.x == LEAF) {
            if (top == 0) {
                break;
            }
            if (instance != NO_HIT && top == outside) {
                ray = slabs(o, d, world.size);
                shear = sheared(o, d);
                inner_o = o;
                inner_d = d;
                instance = NO_HIT;
            }
            top--;
            next = stack[top];
        }
        let entry = next;
        next.x = LEAF;
        // The bits of children that wait together are a distance of almost 0.
        if (bitcast<f32>(entry.y) > best.t) {
            continue;
        }
        let reference = entry.x;
        if ((reference & (LEAF | TOGETHER)) == TOGETHER) {
            // The first of them is next, and the others wait on.
            let others = entry.y & (entry.y - 1);
            if (others != 0) {
                stack[top] = vec2u(reference, others);
                top++;
            }
            let child = firstTrailingBit(entry.y);
            next = vec2u(nodes[6 * (reference & ~TOGETHER) + 4 + child / 4][child % 4], 0);
            continue;
        }
        if ((reference & LEAF) != 0) {
            let first = (reference & ~(LEAF | ITEMS)) >> COUNT_BITS;
            let count = reference & ((1u << COUNT_BITS) - 1);
            if (count == 0) {
                continue;
            }
            // The primitives after the first one.
            let rest = reference + (1u << COUNT_BITS) - 1;
            let are_items = (reference & ITEMS) == ITEMS;
            if (!are_items || items[5 * first + 4].x != INSTANCE) {
                var hit = best;
                hit.is_cut_out = false;
                if (are_items) {
                    intersect_shape(inner_o, inner_d, after, first, instance, &hit);
                } else {
                    intersect_triangle(shear, first, instance, &hit);
                }
                after = 0;
                next = vec2u(select(LEAF, rest, count > 1), 0);
                if (!hit.is_cut_out || accepts(whole(hit), o, d)) {
                    best = hit;
                    if (is_any && best.place != NO_HIT) {
                        break;
                    }
                } else if (are_items) {
                    // The same shape may be hit beyond.
                    after = hit.t;
                    next.x = reference;
                }
                continue;
            }
            // The instance that the ray enters; the others wait.
            if (count > 1) {
                stack[top] = vec2u(rest, 0);
                top++;
            }
            let row = instance_rows(first);
            let placed = items[5 * first + 3];
            inner_o = vec3f(dot(row[0], vec4f(o, 1)), dot(row[1], vec4f(o, 1)), dot(row[2], vec4f(o, 1)));
            inner_d = vec3f(dot(row[0].xyz, d), dot(row[1].xyz, d), dot(row[2].xyz, d));
            ray = slabs(inner_o, inner_d, bitcast<f32>(placed.z));
            shear = sheared(inner_o, inner_d);
            instance = first;
            outside = top;
            stack[outside] = vec2u(placed.y, 0);
            stack[outside + 1] = vec2u(placed.x, 0);
            top += 2;
            continue;
        }
        let at = 6 * reference;
        let head = nodes[at];
        let origin = (bitcast<vec3f>(head.xyz) - ray.o) * ray.inverse;
        let exponents = vec3u(head.w, head.w >> 8, head.w >> 16) & vec3u(255);
        let step = bitcast<vec3f>(exponents << vec3u(23)) * ray.inverse;
        let near = origin - ray.margin;
        let far = origin + ray.margin;
        // Where the ray goes down along an axis, it enters boxes by their high planes.
        let is_down = ray.inverse < vec3f();
        let q = array(nodes[at + 1], nodes[at + 2], nodes[at + 3]);
        let enter_x = select(q[0].xy, q[1].zw, is_down.x);
        let enter_y = select(q[0].zw, q[2].xy, is_down.y);
        let enter_z = select(q[1].xy, q[2].zw, is_down.z);
        let leave_x = select(q[1].zw, q[0].xy, is_down.x);
        let leave_y = select(q[2].xy, q[0].zw, is_down.y);
        let leave_z = select(q[2].zw, q[1].xy, is_down.z);
        let first = four_boxes(
            planes(vec3u(enter_x.x, enter_y.x, enter_z.x), near, step),
            planes(vec3u(leave_x.x, leave_y.x, leave_z.x), far, step), nodes[at + 4], best.t,
        );
        let second = four_boxes(
            planes(vec3u(enter_x.y, enter_y.y, enter_z.y), near, step),
            planes(vec3u(leave_x.y, leave_y.y, leave_z.y), far, step), nodes[at + 5], best.t,
        );
        // Children have entries of their own where the stack has enough for what is below.
        if (top + 7 + (head.w >> 24) <= STACK) {
            take_four(nodes[at + 4], first, &next, &stack, &top);
            take_four(nodes[at + 5], second, &next, &stack, &top);
            continue;
        }
        let together = bits(first.are_hit) | (bits(second.are_hit) << 4);
        if (together != 0) {
            stack[top] = vec2u(reference | TOGETHER, together);
            top++;
        }
    }
    return whole(best);
}
