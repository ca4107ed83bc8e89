// Rays and shapes that are not triangles: patches, quadrics and curves. `src/bvh/item.rs` has the
// format of their items.

// Takes the hit on a shape if it is the nearest so far of those beyond `after`.
fn intersect_shape(o: vec3f, d: vec3f, after: f32, index: u32, instance: u32, best: ptr<function, Nearest>) {
    let at = 5 * index;
    let ids = items[at + 4];
    var uv = vec2f();
    var t = -1.0;
    if (ids.x == ItemTag_Patch) {
        t = hit_patch(o, d, at, after, (*best).t, &uv);
    } else if (HAS_CURVES && ids.x >= ItemTag_FlatCurve) {
        t = hit_curve(o, d, at, after, (*best).t, &uv);
    } else if (ids.x == ItemTag_Ball) {
        let ball = bitcast<vec4f>(items[at]);
        t = hit_round(o - ball.xyz, d, true, whole_sphere(ball.w), after, (*best).t);
    } else {
        let row = array(bitcast<vec4f>(items[at]), bitcast<vec4f>(items[at + 1]), bitcast<vec4f>(items[at + 2]));
        // Relative to the object's origin, so that little is lost near it.
        let q = o - vec3f(row[0].w, row[1].w, row[2].w);
        let inner_o = vec3f(dot(row[0].xyz, q), dot(row[1].xyz, q), dot(row[2].xyz, q));
        let inner_d = vec3f(dot(row[0].xyz, d), dot(row[1].xyz, d), dot(row[2].xyz, d));
        let numbers = bitcast<vec4f>(items[at + 3]);
        if (ids.x == ItemTag_Disk || ids.x == ItemTag_Plane) {
            t = hit_flat(inner_o, inner_d, dot(abs(row[2].xyz), abs(q)), ids.x == ItemTag_Disk, numbers, (*best).t);
        } else {
            t = hit_round(inner_o, inner_d, ids.x == ItemTag_Sphere, numbers, after, (*best).t);
        }
    }
    if (t > after) {
        *best = Nearest(t, uv, index, false, instance, (ids.w & ItemBit_Marked) != 0);
    }
}

// The numbers of a whole sphere.
fn whole_sphere(radius: f32) -> vec4f {
    return vec4f(radius, -radius, radius, 6.2831855);
}

// Errors of distances, relative to the numbers that they come from.
const ROUNDING = 4e-7;

// A patch, of which hits are where t is above 0.
fn hit_patch(o: vec3f, d: vec3f, at: u32, after: f32, t_max: f32, uv: ptr<function, vec2f>) -> f32 {
    let twist = bitcast<vec3f>(items[at + 3].xyz);
    if (any(twist != vec3f())) {
        return hit_curved(o, d, at, twist, after, t_max, uv);
    }
    // Cramer's rule for o + t·d = corner + u·right + v·up ([Möller 1997]).
    let right = bitcast<vec3f>(items[at + 1].xyz);
    let up = bitcast<vec3f>(items[at + 2].xyz);
    let q = o - bitcast<vec3f>(items[at].xyz);
    let normal = cross(right, up);
    let inverse = -1 / dot(d, normal);
    let t = dot(q, normal) * inverse;
    let moment = cross(q, d);
    let u = dot(up, moment) * inverse;
    let v = -dot(right, moment) * inverse;
    // Patches with a common edge overlap a little, so that no ray leaks.
    let is_inside = min(u, v) >= -1e-6 && max(u, v) <= 1.000001;
    let error = ROUNDING * dot(abs(q), abs(normal)) * abs(inverse);
    *uv = clamp(vec2f(u, v), vec2f(), vec2f(1));
    return select(0, t, is_inside && t > error && t < t_max);
}

// A bilinear patch: the lines of constant u that the ray meets, and the nearest points of ray and
// line ([Reshetov 2019]).
fn hit_curved(
    o: vec3f, d: vec3f, at: u32, twist: vec3f, after: f32, t_max: f32, uv: ptr<function, vec2f>,
) -> f32 {
    let right = bitcast<vec3f>(items[at + 1].xyz);
    let up = bitcast<vec3f>(items[at + 2].xyz);
    let p00 = bitcast<vec3f>(items[at].xyz) - o;
    let p10 = p00 + right;
    let a = -dot(cross(right, twist), d);
    let c = dot(cross(p00, d), up);
    let b = dot(cross(p10, d), up + twist) - (a + c);
    let discriminant = b * b - 4 * a * c;
    if (!(discriminant >= 0)) {
        return 0;
    }
    let larger = -0.5 * (b + select(sqrt(discriminant), -sqrt(discriminant), b < 0));
    let roots = vec2f(select(c / larger, 0, larger == 0), select(larger / a, 2, a == 0));
    let error = max(after, ROUNDING * (length(p00) + length(right) + length(up)) / length(d));
    var nearest = t_max;
    var found = 0.0;
    for (var i = 0; i < 2; i++) {
        let u = roots[i];
        let start = p00 + right * u;
        let side = up + twist * u;
        let across = cross(d, side);
        let scale = dot(across, across);
        let t = dot(start, cross(side, across)) / scale;
        let v = dot(start, cross(d, across)) / scale;
        if (min(u, v) >= -1e-6 && max(u, v) <= 1.000001 && t > error && t < nearest) {
            nearest = t;
            found = t;
            *uv = clamp(vec2f(u, v), vec2f(), vec2f(1));
        }
    }
    return found;
}

// The plane z = 0, or a disk; `far` bounds what the height of the origin is computed from.
fn hit_flat(o: vec3f, d: vec3f, far: f32, is_disk: bool, numbers: vec4f, t_max: f32) -> f32 {
    let height = select(0, numbers.x, is_disk);
    let t = (height - o.z) / d.z;
    let p = o + d * t;
    let distance = length(p.xy);
    let is_inside = !is_disk || (distance <= numbers.y && distance >= numbers.z && is_swept(p, numbers.w));
    return select(0, t, is_inside && t > ROUNDING * (far + abs(height)) / abs(d.z) && t < t_max);
}

// A sphere or cylinder, or a part of it. Of the two roots the larger is found first, and the other
// from their product ([Pharr 2023 §6.8.3]).
fn hit_round(o: vec3f, d: vec3f, is_sphere: bool, numbers: vec4f, after: f32, t_max: f32) -> f32 {
    let across = vec3f(1, 1, select(0.0, 1.0, is_sphere));
    let radius = numbers.x;
    let q = o * across;
    let w = d * across;
    let a = dot(w, w);
    let middle = -dot(q, w) / a;
    let nearest = length(q + w * middle);
    let discriminant = (radius + nearest) * (radius - nearest) / a;
    if (!(discriminant >= 0)) {
        return 0;
    }
    let larger = middle + select(sqrt(discriminant), -sqrt(discriminant), middle < 0);
    let distance = length(q);
    let other = select((distance - radius) * (distance + radius) / (a * larger), 0, larger == 0);
    let error = max(after, ROUNDING * (distance + radius) * radius / (a * abs(larger)));
    let roots = vec2f(min(larger, other), max(larger, other));
    for (var i = 0; i < 2; i++) {
        let t = roots[i];
        let z = o.z + t * d.z;
        let is_whole = is_sphere && numbers.y == -radius && numbers.z == radius;
        let is_inside = (is_whole || (z >= numbers.y && z <= numbers.z)) && is_swept(o + d * t, numbers.w);
        if (t > error && t < t_max && is_inside) {
            return t;
        }
    }
    return 0;
}

// Whether the angle of a point around the z axis is at most `limit`.
fn is_swept(p: vec3f, limit: f32) -> bool {
    if (limit > 6.28318) {
        return true;
    }
    let phi = atan2(p.y, p.x);
    return select(phi, phi + 6.2831855, phi < 0) <= limit;
}

// The control points of a curve.
struct Cubic {
    p: array<vec3f, 4>,
}

// A unit vector perpendicular to a unit vector.
fn across(z: vec3f) -> vec3f {
    return normalize(cross(z, select(vec3f(1, 0, 0), vec3f(0, 1, 0), abs(z.x) > 0.7)));
}

// A vector of unit length, or another one where it has no length.
fn unit_or(v: vec3f, other: vec3f) -> vec3f {
    let squared = dot(v, v);
    return select(other, v * inverseSqrt(squared), squared > 1e-36);
}

fn curve_at(item: u32) -> Cubic {
    return Cubic(array(
        bitcast<vec3f>(items[item].xyz), bitcast<vec3f>(items[item + 1].xyz),
        bitcast<vec3f>(items[item + 2].xyz), bitcast<vec3f>(items[item + 3].xyz),
    ));
}

// The widths of a curve at its ends, and its texture coordinates there.
fn ends_of_curve(item: u32) -> vec4f {
    return bitcast<vec4f>(vec4u(items[item].w, items[item + 1].w, items[item + 2].w, items[item + 3].w));
}

fn blossom(c: Cubic, r: f32, s: f32, t: f32) -> vec3f {
    let a = array(mix(c.p[0], c.p[1], r), mix(c.p[1], c.p[2], r), mix(c.p[2], c.p[3], r));
    return mix(mix(a[0], a[1], s), mix(a[1], a[2], s), t);
}

// The derivative of a curve.
fn slope_of_curve(c: Cubic, u: f32) -> vec3f {
    return 3 * mix(mix(c.p[1] - c.p[0], c.p[2] - c.p[1], u), mix(c.p[2] - c.p[1], c.p[3] - c.p[2], u), u);
}

// How many times a curve is bisected: its parts deviate by less than a twentieth of the width from
// straight lines.
fn bisections(c: Cubic, width: f32) -> u32 {
    let bend = max(abs(c.p[0] - 2 * c.p[1] + c.p[2]), abs(c.p[1] - 2 * c.p[2] + c.p[3]));
    let ratio = 1.0606602 * max(bend.x, max(bend.y, bend.z)) / (0.05 * width);
    return u32(clamp(floor(log2(max(ratio, 1)) * 0.5), 0, 10));
}

// The nearest point of a curve that the ray passes within half its width. Parts that it may pass
// are bisected: part `index` of 2^`level` comes before those that follow ([Pharr 2023 §6.7],
// `geometry/src/curve/mod.rs`).
fn hit_curve(o: vec3f, d: vec3f, at: u32, after: f32, t_max: f32, uv: ptr<function, vec2f>) -> f32 {
    let ids = items[at + 4];
    let ends = ends_of_curve(at);
    let length_of_d = length(d);
    let z = d / length_of_d;
    // The curve as the ray sees it.
    var c = curve_at(at);
    let y = unit_or(cross(z, c.p[3] - c.p[0]), across(z));
    let x = cross(y, z);
    for (var i = 0; i < 4; i++) {
        let p = c.p[i] - o;
        c.p[i] = vec3f(dot(x, p), dot(y, p), dot(z, p));
    }
    let levels = bisections(c, max(ends.x, ends.y));
    var nearest = t_max;
    var found = 0.0;
    var level = 0u;
    var index = 0u;
    loop {
        let size = 1 / f32(1u << level);
        let u0 = f32(index) * size;
        let u1 = u0 + size;
        let p = array(blossom(c, u0, u0, u0), blossom(c, u0, u0, u1), blossom(c, u0, u1, u1), blossom(c, u1, u1, u1));
        let radius = 0.5 * max(mix(ends.x, ends.y, u0), mix(ends.x, ends.y, u1));
        let low = min(min(p[0], p[1]), min(p[2], p[3]));
        let high = max(max(p[0], p[1]), max(p[2], p[3]));
        let is_near = radius > 0 && all(low.xy <= vec2f(radius)) && all(high.xy >= vec2f(-radius))
            && high.z >= 0 && low.z <= nearest * length_of_d;
        if (is_near && level < levels) {
            level++;
            index *= 2;
            continue;
        }
        let chord = p[3].xy - p[0].xy;
        // Beyond the lines across the curve at its ends, another part is nearer, or none.
        let is_within = dot(p[1].xy - p[0].xy, p[0].xy) <= 0 && dot(p[2].xy - p[3].xy, p[3].xy) <= 0;
        if (is_near && is_within && dot(chord, chord) > 0) {
            let w = clamp(-dot(p[0].xy, chord) / dot(chord, chord), 0, 1);
            let u = u0 + w * size;
            var width = mix(ends.x, ends.y, u);
            if (ids.x == ItemTag_Ribbon) {
                width *= abs(dot(ribbon_normal(ids.y, ids.z, u), z));
            }
            let q = blossom(Cubic(p), w, w, w);
            let distance = length(q.xy);
            let t = q.z / length_of_d;
            if (distance <= 0.5 * width && t > after && t < nearest) {
                let along = slope_of_curve(Cubic(p), w);
                let is_left = along.y * q.x > along.x * q.y;
                let offset = select(distance / width, 0, width <= 0);
                nearest = t;
                found = t;
                *uv = vec2f(mix(ends.z, ends.w, u), 0.5 + select(-offset, offset, is_left));
            }
        }
        // The next part that does not begin within this one.
        while ((index & 1) == 1) {
            index >>= 1;
            level--;
        }
        if (level == 0) {
            break;
        }
        index++;
    }
    return found;
}
