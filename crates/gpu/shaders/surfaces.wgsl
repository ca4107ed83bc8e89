// The points of surfaces that rays hit.

// A bound of the errors of points that are computed in several steps, relative to their numbers.
const POINT_ERROR = 6e-7;

struct Surface {
    p: Point3Error,
    // The geometric normal, on the side of the shading normal.
    n: vec3f,
    // On which side of it the front of a single-sided surface is, 1 or -1; 0 of others.
    front: f32,
    uv: vec2f,
    dpdu: vec3f,
    dpdv: vec3f,
    // The shading normal, the shading tangents, and the derivatives of the normal by u and v.
    ns: vec3f,
    ss: vec3f,
    ts: vec3f,
    dndu: vec3f,
    dndv: vec3f,
    // Back along the ray.
    wo: vec3f,
    material: u32,
    // The light plus one; 0 where it does not emit.
    light: u32,
}

fn context_of(s: Surface) -> ShapeSampleContext {
    return ShapeSampleContext(s.p, s.n, s.ns, 0);
}

// The shading normal on the side that is seen: the other side of a surface is another one.
fn seen_normal(s: Surface) -> vec3f {
    return select(-s.ns, s.ns, dot(s.n, s.wo) > 0);
}

fn spawn(s: Surface, d: vec3f) -> Ray {
    return Ray_spawn(s.p, s.n, d, shutter_time);
}

// The point of a hit by a ray of unit direction.
fn surface_at(hit: Hit, ray: Ray) -> Surface {
    let geometry = world.geometries + 8 * hit.geometry;
    var s: Surface;
    var o = ray.o;
    var d = ray.d;
    var row: array<vec4f, 3>;
    if (hit.instance != NO_HIT) {
        row = instance_rows(hit.instance);
        o = vec3f(dot(row[0], vec4f(o, 1)), dot(row[1], vec4f(o, 1)), dot(row[2], vec4f(o, 1)));
        d = vec3f(dot(row[0].xyz, d), dot(row[1].xyz, d), dot(row[2].xyz, d));
    }
    if (hit.is_triangle) {
        s = triangle_point(hit, word(geometry + 2), word(geometry + 3) == 1);
    } else {
        s = shape_point(hit, o, d);
    }
    if (hit.instance != NO_HIT) {
        place_surface(&s, Rows(row[0].xyz, row[1].xyz, row[2].xyz), vec3f(row[0].w, row[1].w, row[2].w));
    }
    s.front *= f32(HAS_SINGLE_SIDED && word(geometry + 5) == 1);
    s.wo = Vec3_normalize(-ray.d);
    s.material = word(geometry);
    s.light = word(geometry + 1);
    if (s.light != 0) {
        s.light += hit.primitive;
        if (HAS_PLACED_LIGHTS && hit.instance != NO_HIT) {
            s.light += items[5 * hit.instance + 4].w;
        }
    }
    return s;
}

// Takes a point out of an instance, given the matrix and translation that take points inside.
fn place_surface(s: ptr<function, Surface>, inward: Rows, translation: vec3f) {
    let outward = inverse(inward);
    let ns = (*s).ns;
    (*s).p = placed_point(outward, translation, (*s).p);
    (*s).n = Vec3_normalize(transposed(inward, (*s).n));
    (*s).ns = face_forward(Vec3_normalize(transposed(inward, (*s).ns)), (*s).n);
    (*s).dpdu = times(outward, (*s).dpdu);
    (*s).dpdv = times(outward, (*s).dpdv);
    (*s).ss = times(outward, (*s).ss);
    (*s).ts = times(outward, (*s).ts);
    (*s).dndu = normal_change(inward, ns, (*s).dndu);
    (*s).dndv = normal_change(inward, ns, (*s).dndv);
}

// A point outside of an instance, given the inverse of the matrix, and the translation, that take
// points inside.
fn placed_point(outward: Rows, translation: vec3f, inside: Point3Error) -> Point3Error {
    let size = times(absolute(outward), inside.error + POINT_ERROR * (abs(inside.p) + abs(translation)));
    return Point3Error(times(outward, inside.p - translation), size);
}

// The derivative of a unit normal outside, given normal and derivative inside.
fn normal_change(inward: Rows, inner_n: vec3f, inner_dn: vec3f) -> vec3f {
    let n = transposed(inward, inner_n);
    let dn = transposed(inward, inner_dn);
    let squared = dot(n, n);
    return (dn - n * (dot(n, dn) / squared)) / sqrt(squared);
}

// A mix of three vectors of the attributes.
fn mixed(v: array<vec3f, 3>, b: vec3f) -> vec3f {
    return v[0] * b.x + v[1] * b.y + v[2] * b.z;
}

// Three numbers from any word on.
fn loose_vector(at: u32) -> vec3f {
    return vec3f(number(at), number(at + 1), number(at + 2));
}

// The vectors at the corners of a triangle.
fn at_corners(at: u32) -> array<vec3f, 3> {
    return array(loose_vector(at), loose_vector(at + 3), loose_vector(at + 6));
}

fn triangle_point(hit: Hit, attributes: u32, flips: bool) -> Surface {
    let at = 3 * hit.place;
    let corner = bitcast<vec3f>(triangles[at].xyz);
    let du = bitcast<vec3f>(triangles[at + 1].xyz) - corner;
    let dv = bitcast<vec3f>(triangles[at + 2].xyz) - corner;
    let b = vec3f(1 - hit.uv.x - hit.uv.y, hit.uv);
    var s: Surface;
    let error = gamma(5) * (abs(corner) + abs(du * b.y) + abs(dv * b.z));
    s.p = Point3Error(corner + du * b.y + dv * b.z, error);
    s.n = Vec3_normalize(cross(Vec3_balanced(du), Vec3_balanced(dv))) * select(1.0, -1.0, flips);
    s.front = 1;
    var uv = array(vec2f(), vec2f(1, 0), vec2f(1, 1));
    var next = attributes + 1;
    var flags = 0u;
    if (attributes != 0) {
        flags = word(attributes);
        let numbers = select(0u, 9u, (flags & AttributeBit_Normals) != 0) + select(0u, 6u, (flags & AttributeBit_Coordinates) != 0)
            + select(0u, 9u, (flags & AttributeBit_Tangents) != 0);
        next += numbers * hit.primitive;
    }
    let normals = next;
    next += select(0u, 9u, (flags & AttributeBit_Normals) != 0);
    if ((flags & AttributeBit_Coordinates) != 0) {
        for (var i = 0u; i < 3; i++) {
            uv[i] = vec2f(number(next + 2 * i), number(next + 2 * i + 1));
        }
        next += 6;
    }
    s.uv = uv[0] * b.x + uv[1] * b.y + uv[2] * b.z;
    set_tangents(&s, du, dv, uv[1] - uv[0], uv[2] - uv[0]);
    s.ns = s.n;
    s.ss = s.dpdu;
    s.ts = s.dpdv;
    if ((flags & AttributeBit_Normals) != 0) {
        let n = at_corners(normals);
        let ns = Vec3_normalize_masked(mixed(n, b));
        s.ns = select(s.n, ns.v0, ns.v1);
        s.front = select(1.0, -1.0, dot(s.n, s.ns) < 0);
        s.n *= s.front;
        let inverse = 1 / area(uv[1] - uv[0], uv[2] - uv[0]);
        let nu = n[1] - n[0];
        let nv = n[2] - n[0];
        let dndu = (nu * (uv[2].y - uv[0].y) - nv * (uv[1].y - uv[0].y)) * inverse;
        let dndv = (nv * (uv[1].x - uv[0].x) - nu * (uv[2].x - uv[0].x)) * inverse;
        let is_regular = abs(inverse) < infinity();
        s.dndu = select(vec3f(), dndu, is_regular);
        s.dndv = select(vec3f(), dndv, is_regular);
    }
    if ((flags & AttributeBit_Tangents) != 0) {
        let ss = mixed(at_corners(next), b);
        s.ss = select(s.dpdu, ss, dot(ss, ss) > 0);
    }
    if ((flags & (AttributeBit_Normals | AttributeBit_Tangents)) != 0) {
        s.ts = cross(s.ns, s.ss);
        s.ss = cross(s.ts, s.ns);
        if (dot(s.ts, s.ts) == 0) {
            let any_tangents = coordinate_system(s.ns);
            s.ss = any_tangents.v0;
            s.ts = any_tangents.v1;
        }
    }
    return s;
}

fn area(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - b.x * a.y;
}

// ∂p/∂u and ∂p/∂v by the texture coordinates; any tangents where these have no area.
fn set_tangents(s: ptr<function, Surface>, du: vec3f, dv: vec3f, st_du: vec2f, st_dv: vec2f) {
    let inverse = 1 / area(st_du, st_dv);
    (*s).dpdu = (du * st_dv.y - dv * st_du.y) * inverse;
    (*s).dpdv = (dv * st_du.x - du * st_dv.x) * inverse;
    let normal = cross(Vec3_balanced((*s).dpdu), Vec3_balanced((*s).dpdv));
    let squared = dot(normal, normal);
    if (!(squared > 0 && squared < infinity())) {
        let any_tangents = coordinate_system((*s).n);
        (*s).dpdu = any_tangents.v0;
        (*s).dpdv = any_tangents.v1;
    }
}

fn shape_point(hit: Hit, o: vec3f, d: vec3f) -> Surface {
    let at = 5 * hit.place;
    let ids = items[at + 4];
    let side = select(1.0, -1.0, (ids.w & 1) != 0);
    var s: Surface;
    if (ids.x == ItemTag_Patch) {
        let corner = bitcast<vec3f>(items[at].xyz);
        let right = bitcast<vec3f>(items[at + 1].xyz);
        let up = bitcast<vec3f>(items[at + 2].xyz);
        let twist = bitcast<vec3f>(items[at + 3].xyz);
        s.uv = hit.uv;
        let along = right * hit.uv.x;
        let across = up * hit.uv.y;
        let twisted = twist * (hit.uv.x * hit.uv.y);
        let size = abs(corner) + abs(along) + abs(across) + abs(twisted);
        s.p = Point3Error(corner + along + across + twisted, gamma(5) * size);
        s.dpdu = right + twist * hit.uv.y;
        s.dpdv = up + twist * hit.uv.x;
        let largest = max(abs(s.dpdu), abs(s.dpdv));
        let scale = balance(max(max(largest.x, largest.y), largest.z));
        let normal = cross(s.dpdu * scale, s.dpdv * scale);
        let n = Vec3_normalize(normal);
        s.n = n * side;
        let du = cross(s.dpdu * scale, twist * scale);
        let dv = cross(twist * scale, s.dpdv * scale);
        s.dndu = (du - n * dot(n, du)) * (side / length(normal));
        s.dndv = (dv - n * dot(n, dv)) * (side / length(normal));
    } else if (HAS_CURVES && ids.x >= ItemTag_FlatCurve) {
        s = curve_point(hit, o, d, side);
    } else {
        let row = array(bitcast<vec4f>(items[at]), bitcast<vec4f>(items[at + 1]), bitcast<vec4f>(items[at + 2]));
        var inward = Rows(row[0].xyz, row[1].xyz, row[2].xyz);
        var center = vec3f(row[0].w, row[1].w, row[2].w);
        var kind = ids.x;
        var numbers = bitcast<vec4f>(items[at + 3]);
        if (kind == ItemTag_Ball) {
            inward = Rows(vec3f(1, 0, 0), vec3f(0, 1, 0), vec3f(0, 0, 1));
            center = row[0].xyz;
            kind = ItemTag_Sphere;
            numbers = whole_sphere(row[0].w);
        }
        let p = times(inward, o - center) + times(inward, d) * hit.t;
        s = revolved_point(kind, p, numbers);
        let outward = inverse(inward);
        let reach = abs(center) + times(absolute(outward), abs(s.p.p));
        s.p = Point3Error(center + times(outward, s.p.p), POINT_ERROR * reach);
        s.dndu = normal_change(inward, s.n, s.dndu) * side;
        s.dndv = normal_change(inward, s.n, s.dndv) * side;
        s.n = Vec3_normalize(transposed(inward, s.n)) * side;
        s.dpdu = times(outward, s.dpdu);
        s.dpdv = times(outward, s.dpdv);
    }
    s.front = 1;
    s.ns = s.n;
    s.ss = s.dpdu;
    s.ts = s.dpdv;
    return s;
}

// The point of a curve, which is known to within its width.
fn curve_point(hit: Hit, o: vec3f, d: vec3f, flip: f32) -> Surface {
    let at = 5 * hit.place;
    let kind = items[at + 4].x;
    let ends = ends_of_curve(at);
    let c = curve_at(at);
    let z = Vec3_normalize(d);
    let u = clamp((hit.uv.x - ends.z) / (ends.w - ends.z), 0, 1);
    var s: Surface;
    s.uv = hit.uv;
    let slope = slope_of_curve(c, u);
    s.dpdu = select(c.p[3] - c.p[0], slope / (ends.w - ends.z), any(slope != vec3f()));
    let tangent = unit_or(s.dpdu, across(z));
    var width = mix(ends.x, ends.y, u);
    let sideways = unit_or(cross(z, tangent), across(tangent));
    var across_it = sideways;
    if (kind == ItemTag_Tube) {
        let turn = sin_cos((hit.uv.y - 0.5) * 3.1415927);
        across_it = sideways * turn.v1 - cross(tangent, sideways) * turn.v0;
    } else if (kind == ItemTag_Ribbon) {
        let normal = ribbon_normal(hit.geometry, hit.primitive, u);
        width *= abs(dot(normal, z));
        across_it = unit_or(cross(normal, tangent), sideways);
    }
    s.dpdv = across_it * width;
    s.n = Vec3_normalize(cross(tangent, across_it)) * flip;
    let p = o + d * hit.t;
    s.p = Point3Error(p, vec3f(width) + POINT_ERROR * (abs(o) + abs(d * hit.t)));
    return s;
}

// The normal of a ribbon, between those at the ends of a primitive.
fn ribbon_normal(geometry: u32, primitive: u32, u: f32) -> vec3f {
    let at = word(world.geometries + 8 * geometry + 2) + 8 * primitive;
    let start = vector(at);
    let end = vector(at + 4);
    let angle = 2 * atan2(length(end - start), length(end + start));
    let sine = sin(angle);
    // The plane of rotation is undefined at angles of 0 and π.
    if (sine < 1e-6) {
        return select(end, start, u < 0.5);
    }
    return (start * sin((1 - u) * angle) + end * sin(u * angle)) / sine;
}

// The point of a surface around the z axis that is nearest to `p`, in object space.
fn revolved_point(kind: u32, p: vec3f, numbers: vec4f) -> Surface {
    var s: Surface;
    s.p.p = p;
    s.n = vec3f(0, 0, 1);
    let phi = spherical_phi(p);
    if (kind == ItemTag_Plane) {
        s.p.p.z = 0;
        s.uv = p.xy;
        s.dpdu = vec3f(1, 0, 0);
        s.dpdv = vec3f(0, 1, 0);
    } else if (kind == ItemTag_Disk) {
        s.p.p.z = numbers.x;
        let width = numbers.y - numbers.z;
        let distance = length(p.xy);
        s.uv = vec2f(phi / numbers.w, (numbers.y - distance) / width);
        // A direction for the tangents at the centre.
        let out = select(vec2f(1e-5 * numbers.y, 0), p.xy, distance > 0);
        s.dpdu = vec3f(-out.y, out.x, 0) * numbers.w;
        s.dpdv = vec3f(out / length(out), 0) * -width;
    } else if (kind == ItemTag_Cylinder) {
        let out = p.xy / length(p.xy);
        s.n = vec3f(out, 0);
        s.p.p = vec3f(out * numbers.x, p.z);
        s.uv = vec2f(phi / numbers.w, (p.z - numbers.y) / (numbers.z - numbers.y));
        s.dpdu = vec3f(-s.p.p.y, s.p.p.x, 0) * numbers.w;
        s.dpdv = vec3f(0, 0, numbers.z - numbers.y);
        s.dndu = s.dpdu / numbers.x;
    } else {
        s.n = Vec3_normalize(p);
        s.p.p = s.n * numbers.x;
        let low = arc_acos(clamp(numbers.y / numbers.x, -1, 1));
        let height = arc_acos(clamp(numbers.z / numbers.x, -1, 1)) - low;
        s.uv = vec2f(phi / numbers.w, (arc_acos(clamp(s.n.z, -1, 1)) - low) / height);
        // A direction for the tangents at the pole.
        let out = select(vec2f(1e-5 * numbers.x, 0), s.p.p.xy, any(s.p.p.xy != vec2f()));
        let across = length(out);
        s.dpdu = vec3f(-out.y, out.x, 0) * numbers.w;
        s.dpdv = vec3f(s.p.p.z * out / across, -across) * height;
        s.dndu = s.dpdu / numbers.x;
        s.dndv = s.dpdv / numbers.x;
    }
    return s;
}

// The probability that a hit counts: the alpha of its surface.
fn alpha_at(hit: Hit, s: Surface) -> f32 {
    let alpha = word(world.geometries + 8 * hit.geometry + 4);
    if (!HAS_HOLES || alpha == 0) {
        return 1;
    }
    let context = TextureContext(s.p.p, s.n, s.uv, Footprint());
    return clamp(texture(alpha, context, SampledWavelengths()).x, 0, 1);
}

// Whether interfaces do not stop the ray that is traced.
var<private> passes_interfaces: bool;

// Whether all hits of the ray that is traced count.
fn accepts_all() -> bool {
    return !HAS_HOLES && (!HAS_SINGLE_SIDED || end_at_camera == CameraEnd_Neither);
}

// Whether a single-sided surface turns its back to the camera at an end of the ray.
fn turns_its_back(hit: Hit, o: vec3f, d: vec3f) -> bool {
    let geometry = world.geometries + 8 * hit.geometry;
    if (end_at_camera == CameraEnd_Neither || word(geometry + 5) == 0) {
        return false;
    }
    var inner_o = o;
    var inner_d = d;
    if (hit.instance != NO_HIT) {
        let row = instance_rows(hit.instance);
        inner_o = vec3f(dot(row[0], vec4f(o, 1)), dot(row[1], vec4f(o, 1)), dot(row[2], vec4f(o, 1)));
        inner_d = vec3f(dot(row[0].xyz, d), dot(row[1].xyz, d), dot(row[2].xyz, d));
    }
    var front: vec3f;
    if (hit.is_triangle) {
        let corner = bitcast<vec3f>(triangles[3 * hit.place].xyz);
        let du = bitcast<vec3f>(triangles[3 * hit.place + 1].xyz) - corner;
        let dv = bitcast<vec3f>(triangles[3 * hit.place + 2].xyz) - corner;
        front = cross(du, dv) * select(1.0, -1.0, word(geometry + 3) == 1);
    } else {
        front = shape_point(hit, inner_o, inner_d).n;
    }
    let from_camera = select(-inner_d, inner_d, end_at_camera == CameraEnd_Origin);
    return dot(front, from_camera) > 0;
}

// Whether a hit on a surface that is cut out or single-sided counts: where it is cut out, by a hash
// of the ray and the distance.
fn accepts(hit: Hit, o: vec3f, d: vec3f) -> bool {
    if (HAS_SINGLE_SIDED && turns_its_back(hit, o, d)) {
        return false;
    }
    if (!HAS_HOLES) {
        return true;
    }
    if (HAS_MEDIA && is_interface(word(world.geometries + 8 * hit.geometry))) {
        return !passes_interfaces;
    }
    if (word(world.geometries + 8 * hit.geometry + 4) == 0) {
        return true;
    }
    let alpha = alpha_at(hit, surface_at(hit, Ray_new(o, d, 0)));
    return alpha >= 1 || (alpha > 0 && hashed(o, d, bitcast<u32>(hit.t)) < alpha);
}
