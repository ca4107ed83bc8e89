// Lights: the records of `src/flatten/lights.rs`.

const POINT_LIGHT = 0u;
const SPOT_LIGHT = 1u;
const DISTANT_LIGHT = 2u;
const TRIANGLE_LIGHT = 3u;
const RECTANGLE_LIGHT = 4u;
const SPHERE_LIGHT = 5u;
const UNIFORM_LIGHT = 6u;
const IMAGE_LIGHT = 7u;
const DISK_LIGHT = 8u;
const CYLINDER_LIGHT = 9u;
const GONIOMETRIC_LIGHT = 10u;
const PROJECTION_LIGHT = 11u;
const PATCH_LIGHT = 12u;
const PORTAL_LIGHT = 13u;
const PLACED_LIGHT = 14u;

// Incident light, before its visibility is tested.
struct LightSample {
    l: vec4f,
    wi: vec3f,
    pdf: f32,
    p: Point3Error,
    n: vec3f,
    // The parameters of the point on its surface.
    uv: vec2f,
    // Infinitely far away, where there is no point.
    is_distant: bool,
    valid: bool,
}

fn no_light() -> LightSample {
    return LightSample(vec4f(), vec3f(), 0, Point3Error(vec3f(), vec3f()), vec3f(), vec2f(), false, false);
}

fn light_record(light: u32) -> u32 {
    return tables[world.lights + light];
}

fn is_delta(at: u32) -> bool {
    let kind = tables[at];
    let has_no_surface = kind <= DISTANT_LIGHT || kind == GONIOMETRIC_LIGHT || kind == PROJECTION_LIGHT;
    // No ray hits a surface that is invisible.
    return has_no_surface || (tables[at + 3] & 2) != 0;
}

// The spectrum of a light times its scale.
fn emission(at: u32, lambda: SampledWavelengths) -> vec4f {
    return spectrum(tables[at + 1], lambda) * number(at + 2);
}

fn flat_light(at: u32) -> FlatShape {
    let sides = array(vector(at + 7), vector(at + 10));
    return FlatShape(vector(at + 4), sides, vector(at + 13), tables[at] == TRIANGLE_LIGHT);
}

// Whether both sides of a surface emit.
fn is_two_sided(at: u32) -> bool {
    return (tables[at + 3] & 1) == 1;
}

// Whether a surface with the normal `n` emits along `w`.
fn emits(at: u32, n: vec3f, w: vec3f) -> bool {
    return is_two_sided(at) || !(dot(n, w) < 0);
}

// The radiance that the surface of a light sends back along the ray that hits it.
fn light_radiance(at: u32, s: Surface, lambda: SampledWavelengths) -> vec4f {
    if (!emits(at, s.n, s.wo)) {
        return vec4f();
    }
    var l = emission(at, lambda);
    if (emission_image(at) != 0) {
        l *= image_share(emission_image(at), s.uv, lambda);
    }
    return l;
}

// The shadow ray from a surface to a light sample, and its end.
struct ShadowRay {
    ray: Ray,
    t_max: f32,
}

fn shadow_ray(s: Surface, light: LightSample) -> ShadowRay {
    if (light.is_distant) {
        return ShadowRay(spawn(s, light.wi), infinity());
    }
    return ShadowRay(Ray_between(s.p, s.n, light.p, light.n, 0), 0.9999);
}

// A direction to a light. With `allow_incomplete` it may leave out what BSDF sampling finds.
fn sample_light(
    light: u32,
    context: ShapeSampleContext,
    u: vec2f,
    lambda: SampledWavelengths,
    allow_incomplete: bool,
) -> LightSample {
    let at = light_record(light);
    var sample: LightSample;
    switch (tables[at]) {
        case POINT_LIGHT, SPOT_LIGHT, GONIOMETRIC_LIGHT, PROJECTION_LIGHT: {
            sample = sample_point_light(at, context, lambda);
        }
        case DISTANT_LIGHT, UNIFORM_LIGHT, IMAGE_LIGHT, PORTAL_LIGHT: {
            sample = sample_far_light(at, context.p.p, u, lambda, allow_incomplete);
        }
        default: { sample = sample_surface(at, context, u, lambda); }
    }
    sample.l *= emission(at, lambda);
    sample.valid = sample.valid && !is_black(sample.l);
    return sample;
}

// The samples of each kind of light have in `l` what its emission is multiplied by.

fn sample_point_light(at: u32, context: ShapeSampleContext, lambda: SampledWavelengths) -> LightSample {
    var sample = no_light();
    sample.p = Point3Error(vector(at + 4), vec3f());
    let to_light = sample.p.p - context.p.p;
    let distance2 = Vec3_length_squared(to_light);
    if (distance2 == 0) {
        return sample;
    }
    sample.wi = to_light / sqrt(distance2);
    sample.l = point_share(at, -sample.wi, lambda) / distance2;
    sample.pdf = 1;
    sample.valid = true;
    return sample;
}

// What the intensity of a light at a point is multiplied by along `w`.
fn point_share(at: u32, w: vec3f, lambda: SampledWavelengths) -> vec4f {
    switch (tables[at]) {
        case SPOT_LIGHT: { return vec4f(smooth_step(dot(w, vector(at + 7)), number(at + 11), number(at + 10))); }
        case GONIOMETRIC_LIGHT: {
            return vec4f(density_of(tables[at + 25], position_on_square(in_light(at, w))));
        }
        case PROJECTION_LIGHT: {
            let on_slide = position_on_slide(at, in_light(at, w));
            if (on_slide.z == 0) {
                return vec4f();
            }
            return image_pixel(at + 26, tables[at + 32], on_slide.xy, lambda);
        }
        default: { return vec4f(1); }
    }
}

// A direction in the space of a light with an image.
fn in_light(at: u32, w: vec3f) -> vec3f {
    return times(Rows(vector(at + 7), vector(at + 10), vector(at + 13)), w);
}

// The position on the square of the sphere of a direction in the space of a goniometric light,
// whose y is the projection's z.
fn position_on_square(local: vec3f) -> vec2f {
    return equal_area_sphere_to_square(Vec3_normalize(local.xzy));
}

// The position in the image of a projector of a direction in its space, and 1 if there is one.
fn position_on_slide(at: u32, local: vec3f) -> vec3f {
    let low = vec2f(number(at + 28), number(at + 29));
    let high = vec2f(number(at + 30), number(at + 31));
    let p = local.xy / local.z;
    let st = (p - low) / (high - low);
    let is_on_slide = local.z > 0 && all(p >= low) && all(p <= high);
    return vec3f(st.x, 1 - st.y, select(0.0, 1.0, is_on_slide));
}

fn sample_far_light(
    at: u32,
    p: vec3f,
    u: vec2f,
    lambda: SampledWavelengths,
    allow_incomplete: bool,
) -> LightSample {
    var sample = no_light();
    sample.l = vec4f(1);
    sample.is_distant = true;
    switch (tables[at]) {
        case DISTANT_LIGHT: {
            sample.wi = vector(at + 4);
            sample.pdf = 1;
            sample.valid = true;
        }
        case IMAGE_LIGHT: { sample_sky(at, u, lambda, allow_incomplete, &sample); }
        case PORTAL_LIGHT: { sample_portal(at, p, u, lambda, &sample); }
        default: {
            sample.wi = sample_uniform_sphere(u);
            sample.pdf = 1 / (4 * 3.1415927);
            sample.valid = !allow_incomplete;
        }
    }
    return sample;
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
    switch (tables[record]) {
        case TRIANGLE_LIGHT, RECTANGLE_LIGHT: {
            point = FlatShape_sample_from(flat_light(record), reference, u).v0;
        }
        case SPHERE_LIGHT: { point = sample_sphere(record, reference, u); }
        default: {
            point = point_by_area(record, u);
            point.pdf *= ShapeSampleContext_area_per_solid_angle(reference, point.p.p, point.n);
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
        point.pdf *= solid_angle_factor(inward, sample.wi);
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
// sphere the sine is 0.
struct Cone {
    axis: vec3f,
    sine: f32,
    one_minus_cos: f32,
}

fn cone_of(at: u32, context: ShapeSampleContext) -> Cone {
    let toward = vector(at + 4) - context.p.p;
    let distance = length(toward);
    let radius = number(at + 7);
    if (distance - length(context.p.error) <= radius) {
        return Cone(vec3f(), 0, 2);
    }
    let sine = radius / distance;
    return Cone(toward / distance, sine, sine * sine / (1 + safe_sqrt(1 - sine * sine)));
}

// The direction from the centre of a sphere to a point of it, by area.
fn outward_by_area(at: u32, u: vec2f) -> vec3f {
    let rotation = Rows(vector(at + 9), vector(at + 12), vector(at + 15));
    return times(rotation, sample_uniform_sphere(vec2f(1 - u.x, u.y)));
}

// A point of a sphere: by the cone from outside, by area from inside.
fn sample_sphere(at: u32, context: ShapeSampleContext, u: vec2f) -> ShapeSample {
    let center = vector(at + 4);
    let radius = number(at + 7);
    let cone = cone_of(at, context);
    var outward: vec3f;
    var pdf = 1 / (6.2831855 * cone.one_minus_cos);
    if (cone.sine > 0) {
        let below_one = cone.one_minus_cos * u.x;
        let cosine = 1 - below_one;
        let sin2 = below_one * (1 + cosine);
        let cos_alpha = sin2 / cone.sine + cosine * safe_sqrt(1 - sin2 / (cone.sine * cone.sine));
        let local = spherical_direction(safe_sqrt(1 - cos_alpha * cos_alpha), cos_alpha, u.y * 6.2831855);
        let x = coordinate_system(cone.axis).v1;
        outward = -(x * local.x + cross(cone.axis, x) * local.y + cone.axis * local.z);
    } else {
        outward = outward_by_area(at, u);
    }
    let p = center + outward * radius;
    let n = outward * number(at + 8);
    if (cone.sine == 0) {
        pdf = ShapeSampleContext_area_per_solid_angle(context, p, n) * surface_density(at, vec2f());
    }
    return ShapeSample(Point3Error(p, POINT_ERROR * (abs(center) + vec3f(radius))), n, vec2f(), pdf);
}

// A point of the surface of a light, with its density per area.
fn point_by_area(at: u32, u: vec2f) -> ShapeSample {
    switch (tables[at]) {
        case TRIANGLE_LIGHT, RECTANGLE_LIGHT: {
            let flat_shape = flat_light(at);
            var uv = u;
            if (flat_shape.is_triangle) {
                uv = sample_uniform_triangle(u).yz;
            }
            return ShapeSample(FlatShape_point(flat_shape, uv), flat_shape.n, uv, surface_density(at, uv));
        }
        case SPHERE_LIGHT: {
            let center = vector(at + 4);
            let radius = number(at + 7);
            let outward = outward_by_area(at, u);
            let error = POINT_ERROR * (abs(center) + vec3f(radius));
            let p = Point3Error(center + outward * radius, error);
            return ShapeSample(p, outward * number(at + 8), vec2f(), surface_density(at, vec2f()));
        }
        case PATCH_LIGHT: { return patch_by_area(at, u); }
        default: { return revolved_by_area(at, u); }
    }
}

// The normal of a patch, as long as its area element.
fn patch_normal(at: u32, uv: vec2f) -> vec3f {
    let twist = vector(at + 13);
    return cross(vector(at + 7) + twist * uv.y, vector(at + 10) + twist * uv.x);
}

// The area elements at the corners of a patch.
fn patch_weights(at: u32) -> vec4f {
    return vec4f(number(at + 16), number(at + 17), number(at + 18), number(at + 19));
}

// The density with which parameters of a patch are chosen.
fn patch_density(at: u32, uv: vec2f) -> f32 {
    if (HAS_EMISSION_IMAGES && tables[at + 21] != 0) {
        return density_of(tables[at + 21], uv);
    }
    return bilinear_pdf(uv, patch_weights(at));
}

fn patch_by_area(at: u32, u: vec2f) -> ShapeSample {
    var uv: vec2f;
    if (HAS_EMISSION_IMAGES && tables[at + 21] != 0) {
        uv = draw_2d(tables[at + 21], u).xy;
    } else {
        uv = sample_bilinear(u, patch_weights(at));
    }
    let sides = vector(at + 7) * uv.x + vector(at + 10) * uv.y + vector(at + 13) * (uv.x * uv.y);
    let p = Point3Error(vector(at + 4) + sides, POINT_ERROR * (abs(vector(at + 4)) + abs(sides)));
    let n = Vec3_normalize(patch_normal(at, uv)) * number(at + 20);
    return ShapeSample(p, n, uv, surface_density(at, uv));
}

// The density per area of points of a surface, sampled by area.
fn surface_density(at: u32, uv: vec2f) -> f32 {
    switch (tables[at]) {
        case TRIANGLE_LIGHT, RECTANGLE_LIGHT: {
            let flat_shape = flat_light(at);
            let area = length(cross(flat_shape.sides[0], flat_shape.sides[1]));
            return select(1.0, 2.0, flat_shape.is_triangle) / area;
        }
        case SPHERE_LIGHT: {
            let radius = number(at + 7);
            return 1 / (4 * 3.1415927 * radius * radius);
        }
        case PATCH_LIGHT: { return patch_density(at, uv) / length(patch_normal(at, uv)); }
        default: { return 1 / number(at + 21); }
    }
}

// A point of a disk or a cylinder.
fn revolved_by_area(at: u32, u: vec2f) -> ShapeSample {
    let m = Rows(vector(at + 4), vector(at + 8), vector(at + 12));
    let translation = vec3f(number(at + 7), number(at + 11), number(at + 15));
    let first = number(at + 16);
    var p: vec3f;
    var n = vec3f(0, 0, 1);
    let phi = sin_cos(u.y * number(at + 19));
    if (tables[at] == DISK_LIGHT) {
        let radius = number(at + 17);
        let hole = number(at + 18);
        let distance = sqrt(hole * hole + (radius * radius - hole * hole) * u.x);
        let is_whole = hole == 0 && number(at + 19) > 6.28318;
        let ring = vec2f(phi.v1, phi.v0) * distance;
        p = vec3f(select(ring, sample_uniform_disk_concentric(u) * radius, is_whole), first);
    } else {
        let low = number(at + 17);
        n = vec3f(phi.v1, phi.v0, 0);
        p = n * first + vec3f(0, 0, low + (number(at + 18) - low) * u.x);
    }
    let placed = times(m, p) + translation;
    let size = times(absolute(m), abs(p)) + abs(translation);
    let normal = Vec3_normalize(times(m, n)) * number(at + 20);
    return ShapeSample(Point3Error(placed, POINT_ERROR * size), normal, vec2f(), 1 / number(at + 21));
}

// The density per solid angle with which a light's surface is sampled where a ray hits it.
fn pdf_of_surface(light: u32, context: ShapeSampleContext, s: Surface, uv: vec2f) -> f32 {
    return pdf_of_point(light, context, s.p.p, s.n, uv);
}

// The same, for a point of the surface and its normal.
fn pdf_of_point(light: u32, context: ShapeSampleContext, p: vec3f, n: vec3f, uv: vec2f) -> f32 {
    var at = light_record(light);
    var reference = context;
    var point = p;
    var normal = n;
    var factor = 1.0;
    if (is_placed(at)) {
        let inward = way_to_surface(at);
        reference = context_inside(inward, context);
        point = times(inward.linear, p) + inward.translation;
        normal = Vec3_normalize(transposed(inverse(inward.linear), n));
        factor = solid_angle_factor(inward, Vec3_normalize(p - context.p.p));
        at = surface_record(at);
    }
    switch (tables[at]) {
        case TRIANGLE_LIGHT, RECTANGLE_LIGHT: {
            return FlatShape_pdf_from(flat_light(at), reference, uv) * factor;
        }
        case SPHERE_LIGHT: {
            let cone = cone_of(at, reference);
            if (cone.sine > 0) {
                return factor / (6.2831855 * cone.one_minus_cos);
            }
        }
        default: {}
    }
    let by_area = ShapeSampleContext_area_per_solid_angle(reference, point, normal);
    return by_area * surface_density(at, uv) * factor;
}

// The radiance of an infinite light along a ray that leaves the scene, and the density with which
// it is sampled where sampling may be incomplete.
struct Sky {
    l: vec4f,
    pdf: f32,
}

fn sky(light: u32, o: vec3f, d: vec3f, lambda: SampledWavelengths) -> Sky {
    let at = light_record(light);
    var seen = Sky(emission(at, lambda), 0);
    if (tables[at] == IMAGE_LIGHT) {
        let st = sky_position(at, d);
        seen = Sky(seen.l * sky_image(at, st, lambda), sky_density(at, st, true));
    }
    if (HAS_PORTALS && tables[at] == PORTAL_LIGHT) {
        let through = portal_seen(at, o, d, lambda);
        seen = Sky(seen.l * through.l, through.pdf);
    }
    return seen;
}

// The position in an image of the sphere that is seen along a direction.
fn sky_position(at: u32, d: vec3f) -> vec2f {
    let w = Vec3_normalize(times(Rows(vector(at + 8), vector(at + 11), vector(at + 14)), d));
    if (tables[at + 6] == 0) {
        return equal_area_sphere_to_square(w);
    }
    return vec2f(spherical_phi(w) / 6.2831855, arc_atan2(length(w.xy), w.z) / 3.1415927);
}

// The density per solid angle with which the direction to a position is sampled, completely or not.
fn sky_density(at: u32, st: vec2f, allow_incomplete: bool) -> f32 {
    let solid_angle = 4 * 3.1415927 * solid_angle_density(at, st);
    let density = density_of(tables[at + select(7u, 27u, allow_incomplete)], st);
    return select(density / solid_angle, 0, solid_angle == 0);
}

// Solid angle per area of an image of the sphere, as a part of 4π.
fn solid_angle_density(at: u32, st: vec2f) -> f32 {
    return select(1.5707964 * real_max(sin_cos(3.1415927 * st.y).v0, 0), 1, tables[at + 6] == 0);
}

// What the pixel at a position multiplies the emission by.
fn sky_image(at: u32, st: vec2f, lambda: SampledWavelengths) -> vec4f {
    return image_pixel(at + 4, tables[at + 26], st, lambda);
}

// The spectrum of the pixel at a position of an image, over the illuminant.
fn image_pixel(size_at: u32, pixels: u32, st: vec2f, lambda: SampledWavelengths) -> vec4f {
    let size = vec2u(tables[size_at], tables[size_at + 1]);
    let pixel = min(vec2u(clamp(st * vec2f(size), vec2f(), vec2f(size))), size - 1);
    let rgb = pixels + 4 * (pixel.y * size.x + pixel.x);
    let polynomial = RgbSigmoidPolynomial(vector(rgb + 1));
    var l: vec4f;
    for (var i = 0; i < 4; i++) {
        l[i] = number(rgb) * RgbSigmoidPolynomial_at(polynomial, lambda.lambda[i]);
    }
    return l;
}

fn sample_sky(
    at: u32,
    u: vec2f,
    lambda: SampledWavelengths,
    allow_incomplete: bool,
    sample: ptr<function, LightSample>,
) {
    let drawn = draw_2d(tables[at + select(7u, 27u, allow_incomplete)], u);
    let st = drawn.xy;
    var local: vec3f;
    if (tables[at + 6] == 0) {
        local = equal_area_square_to_sphere(st);
    } else {
        let theta = sin_cos(3.1415927 * st.y);
        local = spherical_direction(theta.v0, theta.v1, 6.2831855 * st.x);
    }
    let solid_angle = 4 * 3.1415927 * solid_angle_density(at, st);
    (*sample).wi = Vec3_normalize(times(Rows(vector(at + 17), vector(at + 20), vector(at + 23)), local));
    (*sample).l = sky_image(at, st, lambda);
    (*sample).pdf = drawn.z / solid_angle;
    (*sample).valid = drawn.z != 0 && solid_angle != 0;
}
