// Rays by the ray queries of hardware, through the `structure` that a kernel declares instead of
// `nodes` beside what `hits.wgsl` needs; `src/structure.rs` builds it.
//
// Instead of the references of trees, groups have the indices of their first triangle and of their
// first shape.

// What the hardware says instead of an instance's item where there is none.
const OUTSIDE = 0xffffffu;

const LARGEST = 0x1.fffffep+127f;

// A ray within an instance, or outside of all.
struct InnerRay {
    o: vec3f,
    d: vec3f,
    // The first triangle and the first shape of the group.
    firsts: vec2u,
    instance: u32,
}

fn inner_ray(o: vec3f, d: vec3f, item: u32) -> InnerRay {
    if (item == OUTSIDE) {
        return InnerRay(o, d, world.roots, NO_HIT);
    }
    let row = instance_rows(item);
    let inner_o = vec3f(dot(row[0], vec4f(o, 1)), dot(row[1], vec4f(o, 1)), dot(row[2], vec4f(o, 1)));
    let inner_d = vec3f(dot(row[0].xyz, d), dot(row[1].xyz, d), dot(row[2].xyz, d));
    return InnerRay(inner_o, inner_d, items[5 * item + 3].xy, item);
}

// The hit on a triangle that the hardware has found, with numbers as those of `intersect_triangle`.
// The numbers of the hardware stay where it decides for this one of two triangles at an edge, and
// the other test for the other one. At t = 0 what is found may be behind; `error` is the bound.
fn met_triangle(ray: InnerRay, index: u32, found: RayIntersection, error: ptr<function, f32>) -> Nearest {
    let seen = sheared_triangle(sheared(ray.o, ray.d), index);
    let determinant = seen.e.x + seen.e.y + seen.e.z;
    let is_cut_out = triangles[3 * index + 2].w == 1;
    var met = Nearest(found.t, found.barycentrics, index, true, ray.instance, is_cut_out);
    *error = 0;
    if (determinant != 0) {
        let inverse = 1 / determinant;
        *error = error_of_distance(seen, inverse);
        if (!is_beside(seen)) {
            met.t = distance_of(seen, inverse);
            met.uv = seen.e.yz * inverse;
        }
    }
    if (!(met.t > *error)) {
        met.t = 0;
    }
    return met;
}

// The nearest hit at 0 < t < `t_max`; if `is_any`, whichever is found first.
fn trace(o: vec3f, d: vec3f, t_max: f32, is_any: bool) -> Hit {
    var best = Nearest(t_max, vec2f(), NO_HIT, false, NO_HIT, false);
    let flags = select(RAY_FLAG_NONE, RAY_FLAG_TERMINATE_ON_FIRST_HIT, is_any);
    // Shapes without bounds, which are not in the structure, come first.
    let first_open = (world.unbounded & ~(LEAF | ITEMS)) >> COUNT_BITS;
    var open = world.unbounded & ((1u << COUNT_BITS) - 1);
    var query: ray_query;
    var is_begun = false;
    // Triangles of the structure are hit beyond.
    var t_min = 0.0;
    loop {
        var ray = InnerRay(o, d, world.roots, NO_HIT);
        var hit = best;
        var shape = NO_HIT;
        if (open > 0) {
            open--;
            shape = first_open + open;
        } else {
            if (!is_begun) {
                if (is_any && best.place != NO_HIT) {
                    break;
                }
                is_begun = true;
                rayQueryInitialize(&query, structure, RayDesc(flags, 0xff, t_min, min(best.t, LARGEST), o, d));
            }
            let is_candidate = rayQueryProceed(&query);
            var found: RayIntersection;
            if (is_candidate) {
                found = rayQueryGetCandidateIntersection(&query);
            } else {
                found = rayQueryGetCommittedIntersection(&query);
            }
            let is_triangle = found.kind == RAY_QUERY_INTERSECTION_TRIANGLE;
            if (!is_candidate && !is_triangle) {
                break;
            }
            ray = inner_ray(o, d, found.instance_custom_data);
            if (is_triangle) {
                let index = ray.firsts.x + found.primitive_index;
                if (!is_candidate && best.is_triangle && best.place == index && best.instance == ray.instance) {
                    break;
                }
                var error = 0.0;
                hit = met_triangle(ray, index, found, &error);
                if (!is_candidate) {
                    // Triangles without holes are no candidates.
                    if (hit.t > 0) {
                        best = hit;
                        break;
                    }
                    // Once more, beyond what may be behind.
                    t_min = max(max(error, found.t) * 1.000001, 1e-30);
                    is_begun = false;
                    continue;
                }
                if (hit.t == 0) {
                    continue;
                }
            } else {
                shape = ray.firsts.y + found.primitive_index;
            }
        }
        // The first hit of the shape that counts.
        var after = 0.0;
        loop {
            if (shape != NO_HIT) {
                hit = best;
                hit.is_cut_out = false;
                intersect_shape(ray.o, ray.d, after, shape, ray.instance, &hit);
            }
            if (!(hit.t < best.t)) {
                break;
            }
            if (!hit.is_cut_out || accepts(whole(hit), o, d)) {
                best = hit;
                if (!is_begun) {
                    break;
                }
                if (hit.is_triangle) {
                    rayQueryConfirmIntersection(&query);
                } else {
                    // naga takes no expression there that is not evaluated before.
                    let t = hit.t;
                    rayQueryGenerateIntersection(&query, t);
                }
                break;
            }
            if (shape == NO_HIT) {
                break;
            }
            after = hit.t;
        }
    }
    return whole(best);
}
