// Rays by the ray queries of hardware, through the `structure` that a kernel declares instead of
// `nodes` beside what `hits.wgsl` needs; `src/structure.rs` builds it.
//
// Instead of the references of trees, groups have the indices of their first triangle and of their
// first shape, which is `NO_HIT` of the top group where no group has any.

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
        return InnerRay(o, d, world.top.roots, NO_HIT);
    }
    let row = instance_rows(item);
    let inner_o = vec3f(dot(row[0], vec4f(o, 1)), dot(row[1], vec4f(o, 1)), dot(row[2], vec4f(o, 1)));
    let inner_d = vec3f(dot(row[0].xyz, d), dot(row[1].xyz, d), dot(row[2].xyz, d));
    return InnerRay(inner_o, inner_d, items[5 * item + 3].xy, item);
}

// The hit on a triangle that the hardware has found, with numbers as those of `intersect_triangle`.
// Those of the hardware stay where it decides for this one of two triangles at an edge, and that
// test for the other one. What is nearer than the bound of its error, and may be behind, has t = 0.
fn met_triangle(ray: InnerRay, index: u32, found: RayIntersection) -> Nearest {
    let seen = sheared_triangle(sheared(ray.o, ray.d), index);
    let determinant = seen.e.x + seen.e.y + seen.e.z;
    let is_marked = triangles[3 * index + 2].w == 1;
    var met = Nearest(found.t, found.barycentrics, index, true, ray.instance, is_marked);
    if (determinant == 0) {
        return met;
    }
    let inverse = 1 / determinant;
    if (!is_beside(seen)) {
        met.t = distance_of(seen, inverse);
        met.uv = seen.e.yz * inverse;
    }
    if (!(met.t > error_of_distance(seen, inverse))) {
        met.t = 0;
    }
    return met;
}

// The nearest hit at 0 < t < `t_max`; if `is_any`, whichever is found first.
fn trace(o: vec3f, d: vec3f, t_max: f32, is_any: bool) -> Hit {
    var best = Nearest(t_max, vec2f(), NO_HIT, false, NO_HIT, false);
    var flags = select(RAY_FLAG_NONE, RAY_FLAG_TERMINATE_ON_FIRST_HIT, is_any);
    if (accepts_all()) {
        // No triangle is a candidate.
        flags |= RAY_FLAG_FORCE_OPAQUE;
    }
    // Shapes without bounds, which are not in the structure, come first.
    let first_open = (world.top.unbounded & ~(LEAF | ITEMS)) >> COUNT_BITS;
    var open = world.top.unbounded & ((1u << COUNT_BITS) - 1);
    var query: ray_query;
    var is_begun = false;
    // Triangles are hit beyond.
    var t_min = 0.0;
    // One query is for triangles, and the next for shapes: naga 30 compares the distance of a shape
    // with a wrong one if a triangle was found before.
    var mask = MaskBit_Triangles;
    loop {
        var ray = InnerRay(o, d, world.top.roots, NO_HIT);
        var hit = best;
        var shape = NO_HIT;
        if (open > 0) {
            open--;
            shape = first_open + open;
        } else {
            if (!is_begun) {
                if (!(best.t > t_min) || (is_any && best.place != NO_HIT)) {
                    break;
                }
                is_begun = true;
                rayQueryInitialize(&query, structure, RayDesc(flags, mask, t_min, min(best.t, LARGEST), o, d));
            }
            let is_candidate = rayQueryProceed(&query);
            var found: RayIntersection;
            if (is_candidate) {
                found = rayQueryGetCandidateIntersection(&query);
            } else {
                found = rayQueryGetCommittedIntersection(&query);
            }
            ray = inner_ray(o, d, found.instance_custom_data);
            if (mask == MaskBit_Shapes) {
                if (!is_candidate) {
                    break;
                }
                shape = ray.firsts.y + found.primitive_index;
            } else {
                if (is_candidate || found.kind == RAY_QUERY_INTERSECTION_TRIANGLE) {
                    hit = met_triangle(ray, ray.firsts.x + found.primitive_index, found);
                }
                if (!is_candidate) {
                    // Triangles without holes are no candidates.
                    if (hit.t == 0) {
                        // Once more, beyond this one.
                        t_min = max(max(t_min, found.t) * 1.000001, 1e-30);
                    } else {
                        best = hit;
                        if (world.top.roots.y == NO_HIT) {
                            break;
                        }
                        t_min = 0;
                        mask = MaskBit_Shapes;
                    }
                    is_begun = false;
                    continue;
                }
                if (hit.t == 0) {
                    continue;
                }
            }
        }
        // The first hit of the shape that counts.
        var after = 0.0;
        loop {
            if (shape != NO_HIT) {
                hit = best;
                hit.is_marked = false;
                intersect_shape(ray.o, ray.d, after, shape, ray.instance, &hit);
            }
            if (!(hit.t < best.t)) {
                break;
            }
            if (!hit.is_marked || accepts(whole(hit), o, d)) {
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
