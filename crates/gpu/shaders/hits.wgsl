// Hits of rays, and rays that meet triangles; `shapes.wgsl` has those that meet what is not one.
//
// A kernel that traces declares the buffers `world`, `triangles` and `items`; `src/bvh/` has their
// formats. It has `accepts`, which says whether a hit counts on a surface that is cut out or
// single-sided; `accepts_all`, whether all hits of the ray count; `HAS_CURVES`, whether there are
// curves; `ribbon_normal`, the normal of one; `HAS_MOTION`, whether instances move; and
// `moved_rows`, the matrix of one at the time of rays.
//
// Its `trace` is that of `trace.wgsl` or of `ray_query.wgsl`.

const NO_HIT = 0xffffffffu;

// The bits of references: leaves, leaves of items, the number of primitives.
const LEAF = 0x80000000u;
const ITEMS = 0x40000000u;
const COUNT_BITS = 5u;

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
    is_marked: bool,
}

// A ray prepared for triangles: translated and sheared so that it becomes the z axis.
struct Sheared {
    axis: u32,
    o: vec3f,
    shear: vec3f,
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

// A triangle as a ray sees it: the corners, and the edge functions.
struct ShearedTriangle {
    a: vec3f,
    b: vec3f,
    c: vec3f,
    e: vec3f,
}

fn sheared_triangle(ray: Sheared, index: u32) -> ShearedTriangle {
    let a = sheared_point(ray, bitcast<vec3f>(triangles[3 * index].xyz));
    let b = sheared_point(ray, bitcast<vec3f>(triangles[3 * index + 1].xyz));
    let c = sheared_point(ray, bitcast<vec3f>(triangles[3 * index + 2].xyz));
    let e = vec3f(edge_function(b.xy, c.xy), edge_function(c.xy, a.xy), edge_function(a.xy, b.xy));
    return ShearedTriangle(a, b, c, e);
}

fn is_beside(seen: ShearedTriangle) -> bool {
    return any(seen.e < vec3f()) && any(seen.e > vec3f());
}

// The distance of the triangle, given the inverse of the sum of edge functions.
fn distance_of(seen: ShearedTriangle, inverse: f32) -> f32 {
    return (seen.e.x * seen.a.z + (seen.e.y * seen.b.z + seen.e.z * seen.c.z)) * inverse;
}

// A bound of the error of that distance ([Pharr 2023 §6.8.7]); what is nearer may be behind.
fn error_of_distance(seen: ShearedTriangle, inverse: f32) -> f32 {
    let x = max(abs(seen.a.x), max(abs(seen.b.x), abs(seen.c.x)));
    let y = max(abs(seen.a.y), max(abs(seen.b.y), abs(seen.c.y)));
    let z = max(abs(seen.a.z), max(abs(seen.b.z), abs(seen.c.z)));
    let largest = max(abs(seen.e.x), max(abs(seen.e.y), abs(seen.e.z)));
    let dx = 2.9802322e-7 * (x + z);
    let dy = 2.9802322e-7 * (y + z);
    let de = 2 * (1.1920929e-7 * x * y + dy * x + dx * y);
    return 3 * (1.7881393e-7 * largest * z + de * z + largest * (1.7881393e-7 * z)) * abs(inverse);
}

// Takes the hit on a triangle if it is the nearest so far: at 0 < t < `best.t`, or at the same
// distance as another hit and before it.
fn intersect_triangle(ray: Sheared, index: u32, instance: u32, best: ptr<function, Nearest>) {
    let seen = sheared_triangle(ray, index);
    let determinant = seen.e.x + seen.e.y + seen.e.z;
    if (is_beside(seen) || determinant == 0) {
        return;
    }
    let inverse = 1 / determinant;
    let t = distance_of(seen, inverse);
    if (!(t > 0 && t <= (*best).t) || !(t > error_of_distance(seen, inverse))) {
        return;
    }
    if (t == (*best).t) {
        let before = (*best).place;
        if (before == NO_HIT || !(*best).is_triangle || instance != (*best).instance) {
            return;
        }
        let ids = vec2u(triangles[3 * index].w, triangles[3 * index + 1].w);
        let others = vec2u(triangles[3 * before].w, triangles[3 * before + 1].w);
        if (ids.x > others.x || (ids.x == others.x && ids.y >= others.y)) {
            return;
        }
    }
    *best = Nearest(t, seen.e.yz * inverse, index, true, instance, triangles[3 * index + 2].w == 1);
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
