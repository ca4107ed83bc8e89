// Lights with surfaces: points of them, and their densities.

// Whether the surface of a light is a triangle or a rectangle.
fn is_flat(at: u32) -> bool {
    return !HAS_ROUND_LIGHTS || word(at) == LightTag_Triangle || word(at) == LightTag_Rectangle;
}

fn sample_surface(at: u32, context: ShapeSampleContext, u: vec2f, lambda: SampledWavelengths) -> LightSample {
    let record = surface_record(at);
    var inward: Placement;
    var reference = context;
    if (is_placed(at)) {
        inward = way_to_surface(at);
        reference = context_inside(inward, context);
    }
    var point: ShapeSample;
    if (is_flat(record)) {
        point = FlatShape_sample_from(flat_light(record), reference, u).v0;
    } else {
        let cone = cone_of(record, reference);
        if (cone.sine > 0 && !shines_through_holes(at, record)) {
            point = sample_cone(record, cone, u);
        } else {
            point = point_by_area(record, u);
            point.pdf = ShapeSampleContext_pdf_per_solid_angle(reference, point.pdf, point.p.p, point.n);
        }
    }
    if (is_placed(at)) {
        leave_instance(inward, &point);
    }
    var sample = no_light();
    let to_light = point.p.p - context.p.p;
    if (Vec3_length_squared(to_light) == 0) {
        return sample;
    }
    sample.wi = Vec3_normalize(to_light);
    if (is_placed(at)) {
        point.pdf *= solid_angle_factor(inward.linear, sample.wi);
    }
    if (!(point.pdf > 0 && point.pdf < infinity()) || is_cut_out_of_light(at, point.p.p, point.n, point.uv)) {
        return sample;
    }
    sample.l = image_share_at(at, point.p.p, point.uv, lambda);
    sample.pdf = point.pdf;
    sample.p = point.p;
    sample.n = point.n;
    sample.uv = point.uv;
    sample.valid = emits(at, point.n, -sample.wi);
    return sample;
}

// The cone in which a sphere is seen: sine, 1 − cosine of its half angle, and its axis. Within the
// sphere, and of other shapes, the sine is 0.
struct Cone {
    axis: vec3f,
    sine: f32,
    one_minus_cos: f32,
}

fn cone_of(at: u32, context: ShapeSampleContext) -> Cone {
    let ball = numbers_at(at + 4);
    let toward = ball.xyz - context.p.p;
    let distance = length(toward);
    let radius = ball.w;
    if (word(at) != LightTag_Sphere || distance - length(context.p.error) <= radius) {
        return Cone(vec3f(), 0, 2);
    }
    let sine = radius / distance;
    return Cone(toward / distance, sine, sine * sine / (1 + safe_sqrt(1 - sine * sine)));
}

// The direction from the centre of a sphere to a point of it, by area.
fn outward_by_area(at: u32, u: vec2f) -> vec3f {
    let rotation = Rows(vector(at + 8), vector(at + 12), vector(at + 16));
    return times(rotation, sample_uniform_sphere(vec2f(1 - u.x, u.y)));
}

// A point of a sphere in the cone in which it is seen.
fn sample_cone(at: u32, cone: Cone, u: vec2f) -> ShapeSample {
    let ball = numbers_at(at + 4);
    let below_one = cone.one_minus_cos * u.x;
    let cosine = 1 - below_one;
    let sin2 = below_one * (1 + cosine);
    let cos_alpha = sin2 / cone.sine + cosine * safe_sqrt(1 - sin2 / (cone.sine * cone.sine));
    let local = spherical_direction(safe_sqrt(1 - cos_alpha * cos_alpha), cos_alpha, u.y * 6.2831855);
    let x = coordinate_system(cone.axis).v1;
    let outward = -(x * local.x + cross(cone.axis, x) * local.y + cone.axis * local.z);
    return ShapeSample(
        point_of_ball(ball, outward), outward * number(at + 11), vec2f(), 1 / (6.2831855 * cone.one_minus_cos),
    );
}

fn point_of_ball(ball: vec4f, outward: vec3f) -> Point3Error {
    return Point3Error(ball.xyz + outward * ball.w, POINT_ERROR * (abs(ball.xyz) + vec3f(ball.w)));
}

// A point of the surface of a light, with its density per area.
fn point_by_area(at: u32, u: vec2f) -> ShapeSample {
    var point: ShapeSample;
    if (is_flat(at)) {
        let flat_shape = flat_light(at);
        point.uv = u;
        if (flat_shape.is_triangle) {
            point.uv = sample_uniform_triangle(u).yz;
        }
        point.p = FlatShape_point(flat_shape, point.uv);
        point.n = flat_shape.n;
    } else if (word(at) == LightTag_Sphere) {
        let outward = outward_by_area(at, u);
        point.p = point_of_ball(numbers_at(at + 4), outward);
        point.n = outward * number(at + 11);
    } else if (word(at) == LightTag_Patch) {
        point = patch_by_area(at, u);
    } else {
        point = revolved_by_area(at, u);
    }
    point.pdf = surface_density(at, point.n, point.uv);
    return point;
}

// The normal of a patch, as long as its area element.
fn patch_normal(at: u32, uv: vec2f) -> vec3f {
    let twist = vector(at + 16);
    return cross(vector(at + 8) + twist * uv.y, vector(at + 12) + twist * uv.x);
}

// The density with which parameters of a patch are chosen: by an image, or by the area elements at
// its corners.
fn patch_density(at: u32, uv: vec2f) -> f32 {
    if (HAS_EMISSION_IMAGES && word(at + 25) != 0) {
        return density_of(word(at + 25), uv);
    }
    return bilinear_pdf(uv, numbers_at(at + 20));
}

// A point of a patch, without its density.
fn patch_by_area(at: u32, u: vec2f) -> ShapeSample {
    var uv: vec2f;
    if (HAS_EMISSION_IMAGES && word(at + 25) != 0) {
        uv = draw_2d(word(at + 25), u).xy;
    } else {
        uv = sample_bilinear(u, numbers_at(at + 20));
    }
    let corner = vector(at + 4);
    let sides = vector(at + 8) * uv.x + vector(at + 12) * uv.y + vector(at + 16) * (uv.x * uv.y);
    let p = Point3Error(corner + sides, POINT_ERROR * (abs(corner) + abs(sides)));
    let n = Vec3_normalize(patch_normal(at, uv)) * number(at + 24);
    return ShapeSample(p, n, uv, 0);
}

// The density per area of a point of a surface with the normal `n`, sampled by area.
fn surface_density(at: u32, n: vec3f, uv: vec2f) -> f32 {
    if (is_flat(at)) {
        let flat_shape = flat_light(at);
        let area = length(cross(flat_shape.sides[0], flat_shape.sides[1]));
        return select(1.0, 2.0, flat_shape.is_triangle) / area;
    }
    switch (word(at)) {
        case LightTag_Sphere: {
            let radius = number(at + 7);
            return 1 / (4 * 3.1415927 * radius * radius);
        }
        case LightTag_Patch: { return patch_density(at, uv) / length(patch_normal(at, uv)); }
        default: {
            // By area in object space, of which an element grows by |det M|/|Mᵀn|.
            let m = Rows(vector(at + 4), vector(at + 8), vector(at + 12));
            return length(transposed(m, n)) / (abs(determinant(m)) * number(at + 21));
        }
    }
}

// A point of a disk, a cylinder, or a part of a sphere, without its density.
fn revolved_by_area(at: u32, u: vec2f) -> ShapeSample {
    let out = kept_placement(at + 4);
    let m = out.linear;
    let shape = numbers_at(at + 16);
    let first = shape.x;
    let low = shape.y;
    let high = shape.z;
    let angle = shape.w;
    var p: vec3f;
    var n = vec3f(0, 0, 1);
    let phi = sin_cos(u.y * angle);
    switch (word(at)) {
        case LightTag_Disk: {
            // The numbers are those of the radius and of the hole.
            let distance = sqrt(high * high + (low * low - high * high) * u.x);
            let is_whole = high == 0 && angle > 6.28318;
            let ring = vec2f(phi.v1, phi.v0) * distance;
            p = vec3f(select(ring, sample_uniform_disk_concentric(u) * low, is_whole), first);
        }
        case LightTag_Cylinder: {
            n = vec3f(phi.v1, phi.v0, 0);
            p = n * first + vec3f(0, 0, low + (high - low) * u.x);
        }
        default: {
            // Heights of a sphere are uniform over its area.
            let cosine = (low + (high - low) * u.x) / first;
            n = vec3f(vec2f(phi.v1, phi.v0) * safe_sqrt(1 - cosine * cosine), cosine);
            p = n * first;
        }
    }
    let there = times_point(out, p);
    let size = times(absolute(m), abs(p)) + abs(out.translation);
    let normal = Vec3_normalize(transposed(inverse(m), n)) * number(at + 20);
    return ShapeSample(Point3Error(there, POINT_ERROR * size), normal, vec2f(), 0);
}

// The density per solid angle with which a light's surface is sampled where a ray hits it.
fn pdf_of_surface(light: u32, context: ShapeSampleContext, s: Surface, uv: vec2f) -> f32 {
    return pdf_of_point(light, context, s.p.p, s.n, uv);
}

// The same, for a point of the surface and its normal.
fn pdf_of_point(light: u32, context: ShapeSampleContext, p: vec3f, n: vec3f, uv: vec2f) -> f32 {
    let emitter = light_record(light);
    var at = emitter;
    var reference = context;
    var point = p;
    var normal = n;
    var factor = 1.0;
    if (is_placed(at)) {
        let inward = way_to_surface(at);
        reference = context_inside(inward, context);
        point = times_point(inward, p);
        normal = Vec3_normalize(transposed(inverse(inward.linear), n));
        factor = solid_angle_factor(inward.linear, Vec3_normalize(p - context.p.p));
        at = surface_record(at);
    }
    if (is_flat(at)) {
        return FlatShape_pdf_from(flat_light(at), reference, uv) * factor;
    }
    let cone = cone_of(at, reference);
    if (cone.sine > 0 && !shines_through_holes(emitter, at)) {
        return factor / (6.2831855 * cone.one_minus_cos);
    }
    let density = surface_density(at, normal, uv);
    return ShapeSampleContext_pdf_per_solid_angle(reference, density, point, normal) * factor;
}
