// Lights: the records of `src/flatten/lights.rs`.

// Whether a light is at a point: these have kinds of their own.
fn is_at_point(kind: u32) -> bool {
    return kind == LightTag_Point || kind == LightTag_Spot || kind == LightTag_Goniometric
        || kind == LightTag_Projection;
}

// Whether a light is infinitely far away.
fn is_far(kind: u32) -> bool {
    return kind == LightTag_Distant || kind == LightTag_UniformInfinite || kind == LightTag_ImageInfinite
        || kind == LightTag_PortalInfinite;
}

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
    return word(world.lights + light);
}

fn is_delta(at: u32) -> bool {
    let head = words_at(at);
    // No ray hits a surface that is invisible.
    return is_at_point(head.x) || head.x == LightTag_Distant || (head.w & 2) != 0;
}

// The spectrum of a light times its scale.
fn emission(at: u32, lambda: SampledWavelengths) -> vec4f {
    let head = words_at(at);
    return spectrum(head.y, lambda) * bitcast<f32>(head.z);
}

// Whether a light without a surface moves.
fn light_moves(at: u32) -> bool {
    return HAS_MOTION && word(at + 3) != 0;
}

// From the space of such a light, at the time of the sample.
fn out_of_light(at: u32) -> Placement {
    return placement_at(kept_motion(word(at + 3) >> 2), shutter_time);
}

// The position of a light at a point.
fn light_position(at: u32) -> vec3f {
    let p = vector(at + 4);
    if (!light_moves(at)) {
        return p;
    }
    let outward = out_of_light(at);
    if (word(at) == LightTag_Goniometric || word(at) == LightTag_Projection) {
        return outward.translation;
    }
    return times_point(outward, p);
}

// The direction of a light that is kept at a place of the tables.
fn light_direction(at: u32, place: u32) -> vec3f {
    let w = vector(place);
    if (!light_moves(at)) {
        return w;
    }
    return unit_or(times(out_of_light(at).linear, w), w);
}

fn flat_light(at: u32) -> FlatShape {
    let sides = array(vector(at + 8), vector(at + 12));
    return FlatShape(vector(at + 4), sides, vector(at + 16), word(at) == LightTag_Triangle);
}

// Whether both sides of a surface emit.
fn is_two_sided(at: u32) -> bool {
    return (word(at + 3) & 1) == 1;
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
    let kind = word(at);
    var sample: LightSample;
    if (is_far(kind)) {
        sample = sample_far_light(at, context.p.p, u, lambda, allow_incomplete);
    } else if (HAS_POINT_LIGHTS && is_at_point(kind)) {
        sample = sample_point_light(at, context, lambda);
    } else if (HAS_SURFACE_LIGHTS) {
        sample = sample_surface(at, context, u, lambda);
    }
    sample.l *= emission(at, lambda);
    sample.valid = sample.valid && !is_black(sample.l);
    return sample;
}

// The samples of each kind of light have in `l` what its emission is multiplied by.

fn sample_point_light(at: u32, context: ShapeSampleContext, lambda: SampledWavelengths) -> LightSample {
    var sample = no_light();
    sample.p = Point3Error(light_position(at), vec3f());
    let way = sample.p.p - context.p.p;
    let scale = balance(max(max(abs(way.x), abs(way.y)), abs(way.z)));
    let to_light = way * scale;
    let distance2 = Vec3_length_squared(to_light);
    if (distance2 == 0) {
        return sample;
    }
    sample.wi = to_light / sqrt(distance2);
    sample.l = point_share(at, -sample.wi, lambda) / distance2 * scale * scale;
    sample.pdf = 1;
    sample.valid = true;
    return sample;
}

// What the intensity of a light at a point is multiplied by along `w`.
fn point_share(at: u32, w: vec3f, lambda: SampledWavelengths) -> vec4f {
    switch (word(at)) {
        case LightTag_Spot: {
            let cosine = dot(w, light_direction(at, at + 8));
            let falloff = numbers_at(at + 12);
            return vec4f(smooth_step(cosine, falloff.y, falloff.x));
        }
        case LightTag_Goniometric: {
            return vec4f(density_of(word(at + 32), position_on_square(in_light(at, w))));
        }
        case LightTag_Projection: {
            let on_slide = position_on_slide(at, in_light(at, w));
            if (on_slide.z == 0) {
                return vec4f();
            }
            let slide = words_at(at + 32);
            return image_pixel(slide.yz, slide.w, on_slide.xy, lambda);
        }
        default: { return vec4f(1); }
    }
}

// A direction in the space of a light with an image.
fn in_light(at: u32, w: vec3f) -> vec3f {
    if (light_moves(at)) {
        return times(inverse(out_of_light(at).linear), w);
    }
    return times(Rows(vector(at + 8), vector(at + 12), vector(at + 16)), w);
}

// The position on the square of the sphere of a direction in the space of a goniometric light,
// whose y is the projection's z.
fn position_on_square(local: vec3f) -> vec2f {
    return equal_area_sphere_to_square(Vec3_normalize(local.xzy));
}

// The position in the image of a projector of a direction in its space, and 1 if there is one.
fn position_on_slide(at: u32, local: vec3f) -> vec3f {
    let screen = numbers_at(at + 36);
    let p = local.xy / local.z;
    let st = (p - screen.xy) / (screen.zw - screen.xy);
    let is_on_slide = local.z > 0 && all(p >= screen.xy) && all(p <= screen.zw);
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
    switch (word(at)) {
        case LightTag_Distant: {
            sample.wi = light_direction(at, at + 4);
            sample.pdf = 1;
            sample.valid = true;
        }
        case LightTag_ImageInfinite: {
            if (HAS_SKY_IMAGES) {
                sample_sky(at, u, lambda, allow_incomplete, &sample);
            }
        }
        case LightTag_PortalInfinite: {
            if (HAS_PORTALS) {
                sample_portal(at, p, u, lambda, &sample);
            }
        }
        default: {
            sample.wi = sample_uniform_sphere(u);
            sample.pdf = 1 / (4 * 3.1415927);
            sample.valid = !allow_incomplete;
        }
    }
    return sample;
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
    if (HAS_SKY_IMAGES && word(at) == LightTag_ImageInfinite) {
        let st = sky_position(at, d);
        seen = Sky(seen.l * sky_image(at, st, lambda), sky_density(at, st, d, true));
    }
    if (HAS_PORTALS && word(at) == LightTag_PortalInfinite) {
        let through = portal_seen(at, o, d, lambda);
        seen = Sky(seen.l * through.l, through.pdf);
    }
    return seen;
}

// The rows of the matrix into the space of an image of the sphere.
fn into_sky(at: u32) -> Rows {
    if (light_moves(at)) {
        return inverse(out_of_light(at).linear);
    }
    return Rows(vector(at + 8), vector(at + 12), vector(at + 16));
}

// The position in an image of the sphere that is seen along a direction.
fn sky_position(at: u32, d: vec3f) -> vec2f {
    let w = Vec3_normalize(times(into_sky(at), d));
    if (word(at + 6) == ProjectionTag_EqualArea) {
        return equal_area_sphere_to_square(w);
    }
    return vec2f(spherical_phi(w) / 6.2831855, arc_atan2(length(w.xy), w.z) / 3.1415927);
}

// The density per solid angle with which the direction `w` to a position is sampled, completely or
// not.
fn sky_density(at: u32, st: vec2f, w: vec3f, allow_incomplete: bool) -> f32 {
    let solid_angle = 4 * 3.1415927 * solid_angle_density(at, st);
    let density = density_of(word(at + select(7u, 33u, allow_incomplete)), st);
    return select(density / solid_angle * solid_angle_factor(into_sky(at), w), 0, solid_angle == 0);
}

fn determinant(m: Rows) -> f32 {
    return dot(m.x, cross(m.y, m.z));
}

// The factor on a density per solid angle that the inverse of a matrix takes to the direction `w`.
fn solid_angle_factor(inward: Rows, w: vec3f) -> f32 {
    let distance = length(times(inward, w));
    return abs(determinant(Rows(inward.x / distance, inward.y / distance, inward.z / distance)));
}

// Solid angle per area of an image of the sphere, as a part of 4π.
fn solid_angle_density(at: u32, st: vec2f) -> f32 {
    return select(1.5707964 * real_max(sin_cos(3.1415927 * st.y).v0, 0), 1, word(at + 6) == ProjectionTag_EqualArea);
}

// What the pixel at a position multiplies the emission by.
fn sky_image(at: u32, st: vec2f, lambda: SampledWavelengths) -> vec4f {
    return image_pixel(words_at(at + 4).xy, word(at + 32), st, lambda);
}

// The spectrum of the pixel at a position of an image, over the illuminant.
fn image_pixel(size: vec2u, pixels: u32, st: vec2f, lambda: SampledWavelengths) -> vec4f {
    let pixel = min(vec2u(clamp(st * vec2f(size), vec2f(), vec2f(size))), size - 1);
    let rgb = numbers_at(pixels + 4 * (pixel.y * size.x + pixel.x));
    let polynomial = RgbSigmoidPolynomial(rgb.yzw);
    var l: vec4f;
    for (var i = 0; i < 4; i++) {
        l[i] = rgb.x * RgbSigmoidPolynomial_at(polynomial, lambda.lambda[i]);
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
    let drawn = draw_2d(word(at + select(7u, 33u, allow_incomplete)), u);
    let st = drawn.xy;
    var local: vec3f;
    if (word(at + 6) == ProjectionTag_EqualArea) {
        local = equal_area_square_to_sphere(st);
    } else {
        let theta = sin_cos(3.1415927 * st.y);
        local = spherical_direction(theta.v0, theta.v1, 6.2831855 * st.x);
    }
    var outward = Rows(vector(at + 20), vector(at + 24), vector(at + 28));
    if (light_moves(at)) {
        outward = out_of_light(at).linear;
    }
    let solid_angle = 4 * 3.1415927 * solid_angle_density(at, st);
    (*sample).wi = Vec3_normalize(times(outward, local));
    (*sample).l = sky_image(at, st, lambda);
    (*sample).pdf = drawn.z / solid_angle * solid_angle_factor(into_sky(at), (*sample).wi);
    (*sample).valid = drawn.z != 0 && solid_angle != 0;
}
