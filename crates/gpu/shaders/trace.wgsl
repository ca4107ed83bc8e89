// Rays through the trees of a world, whose `nodes` a kernel declares beside what `hits.wgsl` needs.

// The entries of a ray's stack. They are few, because all are set to zero before each ray.
const STACK = 24u;

// The bit of a node on the stack of which some children wait together: those of some bits, instead
// of a distance.
const TOGETHER = 0x40000000u;

// A ray prepared for boxes.
struct Slabs {
    inverse: vec3f,
    o: vec3f,
    // A bound of the rounding errors of planes, of the boxes' distances, and of the triangle test.
    margin: vec3f,
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

// The nearest hit at 0 < t < `t_max`; if `is_any`, whichever is found first.
fn trace(o: vec3f, d: vec3f, t_max: f32, is_any: bool) -> Hit {
    var best = Nearest(t_max, vec2f(), NO_HIT, false, NO_HIT, false);
    // What is next, if anything, and what waits.
    var next = vec2u(LEAF, 0);
    var stack: array<vec2u, STACK>;
    stack[0] = vec2u(world.top.roots.y, 0);
    stack[1] = vec2u(world.top.roots.x, 0);
    stack[2] = vec2u(world.top.unbounded, 0);
    var top = 3u;
    // Within an instance the ray is another one; `outside` is the top of the stack there.
    var ray = slabs(o, d, world.top.size);
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
                ray = slabs(o, d, world.top.size);
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
            if (!are_items || items[5 * first + 4].x != ItemTag_Instance) {
                var hit = best;
                hit.is_marked = false;
                if (are_items) {
                    intersect_shape(inner_o, inner_d, after, first, instance, &hit);
                } else {
                    intersect_triangle(shear, first, instance, &hit);
                }
                after = 0;
                next = vec2u(select(LEAF, rest, count > 1), 0);
                if (!hit.is_marked || accepts(whole(hit), o, d)) {
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
