// The lights' ends of paths: the record of `src/flatten/light_paths.rs`, how light paths begin, and
// the densities with which they do.

const UNIFORM_DIRECTION = 0.07957747;

// A point of a light, or a direction to it; the normal is zero where it has none.
struct LightPoint {
    light: u32,
    p: vec3f,
    n: vec3f,
    uv: vec2f,
    is_distant: bool,
}

// The ray with which a light path begins; of its throughput the choice of the light is a part.
struct Emission {
    ray: Ray,
    beta: vec4f,
    origin: LightPoint,
    valid: bool,
}

// Of the light's end of a path: the density per solid angle with which a surface chooses it, that
// per area and solid angle with which the light sends the ray, and the cosine at the light.
struct LightEnd {
    direct: f32,
    emission: f32,
    cos_theta: f32,
    is_delta: bool,
}

fn count_of_light_paths() -> f32 {
    return number(world.light_paths + 2);
}

fn sphere_of_scene() -> vec4f {
    return numbers_at(world.light_paths + 4);
}

// Whether light paths to a film position add to a pixel.
fn is_reached(film: vec2f) -> bool {
    let reach = numbers_at(world.light_paths + 8);
    return all(film >= reach.xy) && all(film <= reach.zw);
}

// The density of a direction from the point of a spot light, at a cosine to its axis.
fn spot_density(at: u32, cosine: f32) -> f32 {
    let falloff = numbers_at(at + 12);
    let start = falloff.x;
    let end = falloff.y;
    let solid_angle = 6.2831855 * ((1 - start) + (start - end) / 2);
    return select(0, smooth_step(cosine, end, start) / solid_angle, solid_angle > 0);
}

// A direction around the axis of a spot light: in the cone of full intensity or in the ring around
// it, which has half as much on average.
fn spot_direction(at: u32, u: vec2f) -> vec3f {
    let falloff = numbers_at(at + 12);
    let start = falloff.x;
    let end = falloff.y;
    let cone = 1 - start;
    let ring = 0.5 * (start - end);
    let chosen = u.x * (cone + ring);
    if (ring <= 0 || (cone > 0 && chosen < cone)) {
        return sample_uniform_cone(vec2f(clamp(chosen / cone, 0, float_ONE_MINUS_EPSILON), u.y), start);
    }
    // The root of 2t³ − t⁴, to which Newton's iteration falls.
    let share = clamp((chosen - cone) / ring, 0, float_ONE_MINUS_EPSILON);
    var t = pow(share, 1.0 / 3.0);
    if (t > 0) {
        for (var i = 0; i < 5; i++) {
            t -= (t * t * t * (2 - t) - share) / (t * t * (6 - 4 * t));
        }
    }
    let cosine = lerp(t, end, start);
    return spherical_direction(safe_sqrt(1 - cosine * cosine), cosine, 6.2831855 * u.y);
}

// The direction in which a light with an image at a point sends a ray.
fn image_direction(at: u32, u: vec2f) -> vec3f {
    let st = draw_2d(word(at + 32), u).xy;
    var local: vec3f;
    if (word(at) == LightTag_Goniometric) {
        local = equal_area_square_to_sphere(st).xzy;
    } else {
        let screen = numbers_at(at + 36);
        local = vec3f(lerp(st.x, screen.x, screen.z), lerp(1 - st.y, screen.y, screen.w), 1);
    }
    return Vec3_normalize(times(Rows(vector(at + 20), vector(at + 24), vector(at + 28)), local));
}

// The density of these directions.
fn image_direction_density(at: u32, w: vec3f) -> f32 {
    let local = in_light(at, w);
    let length2 = Vec3_length_squared(local);
    let x = vector(at + 8);
    // Solid angle in the space of the light over that of render space.
    let factor = abs(dot(x, cross(vector(at + 12), vector(at + 16)))) / (length2 * sqrt(length2));
    if (word(at) == LightTag_Goniometric) {
        return UNIFORM_DIRECTION * density_of(word(at + 32), position_on_square(local)) * factor;
    }
    let on_slide = position_on_slide(at, local);
    let screen = numbers_at(at + 36);
    let area = (screen.z - screen.x) * (screen.w - screen.y);
    let cosine = local.z / sqrt(length2);
    let density = density_of(word(at + 32), on_slide.xy) / (area * cosine * cosine * cosine);
    return select(0, density * factor, on_slide.z == 1);
}

// The density of a direction from a light at a point.
fn point_direction_density(at: u32, w: vec3f) -> f32 {
    switch (word(at)) {
        case LightTag_Point: { return UNIFORM_DIRECTION; }
        case LightTag_Spot: { return spot_density(at, dot(w, vector(at + 8))); }
        default: { return image_direction_density(at, w); }
    }
}

// The density of a direction from a surface.
fn surface_direction_density(at: u32, n: vec3f, w: vec3f) -> f32 {
    let cosine = dot(n, w);
    if (is_two_sided(at)) {
        return 0.5 * cosine_hemisphere_pdf(abs(cosine));
    }
    return cosine_hemisphere_pdf(max(cosine, 0));
}

// A ray that a light emits, chosen by `u` for the light, and by `u_position` and `u_direction`.
fn emit(u: f32, u_position: vec2f, u_direction: vec2f, lambda: SampledWavelengths) -> Emission {
    var e: Emission;
    if (world.light_count == 0) {
        return e;
    }
    let choice = choose_by_power(word(world.light_paths + 1), u);
    let at = light_record(choice.light);
    e.origin.light = choice.light;
    e.valid = choice.valid;
    // What the emission is multiplied by.
    var share = vec4f(1);
    var pdf = 1.0;
    var w: vec3f;
    let kind = word(at);
    if (is_far(kind)) {
        let seen = sample_far_light(at, vec3f(), u_direction, lambda, false);
        share = seen.l;
        let sphere = sphere_of_scene();
        let disk = vec3f(sample_uniform_disk_concentric(u_position), 1);
        let o = sphere.xyz + Frame_from_local(Frame_from_z(seen.wi), disk) * sphere.w;
        e.ray = Ray_new(o, -seen.wi, 0);
        e.origin.is_distant = true;
        e.valid = e.valid && seen.valid;
        pdf = seen.pdf / (3.1415927 * sphere.w * sphere.w);
    } else if (HAS_POINT_LIGHTS && is_at_point(kind)) {
        e.origin.p = vector(at + 4);
        switch (kind) {
            case LightTag_Point: { w = sample_uniform_sphere(u_direction); }
            case LightTag_Spot: {
                w = Frame_from_local(Frame_from_z(vector(at + 8)), spot_direction(at, u_direction));
            }
            default: { w = image_direction(at, u_direction); }
        }
        pdf = point_direction_density(at, w);
        share = point_share(at, w, lambda);
        e.ray = Ray_new(e.origin.p, w, 0);
    } else if (HAS_SURFACE_LIGHTS) {
        let point = point_on_light(at, u_position);
        e.valid = e.valid && !is_cut_out_of_light(at, point.p.p, point.n, point.uv);
        var u_side = u_direction;
        var side = point.n;
        if (is_two_sided(at)) {
            u_side.x *= 2;
            if (u_side.x >= 1) {
                u_side.x -= 1;
                side = -side;
            }
        }
        w = Frame_from_local(Frame_from_z(side), sample_cosine_hemisphere(u_side));
        e.origin.p = point.p.p;
        e.origin.n = point.n;
        e.origin.uv = point.uv;
        e.ray = Ray_spawn(point.p, point.n, w, 0);
        share = image_share_at(at, point.p.p, point.uv, lambda) * abs(dot(point.n, w));
        pdf = point.pdf * surface_direction_density(at, point.n, w);
    }
    let l = emission(at, lambda) * share;
    e.valid = e.valid && pdf > 0 && !is_black(l);
    e.beta = l / (pdf * choice.pmf);
    return e;
}

// The density of a direction to an infinitely distant light; of one direction, 1.
fn far_density(at: u32, wi: vec3f) -> f32 {
    if (HAS_SKY_IMAGES && word(at) == LightTag_ImageInfinite) {
        return sky_density(at, sky_position(at, wi), wi, false);
    }
    return select(UNIFORM_DIRECTION, 1, word(at) == LightTag_Distant);
}

// The density per solid angle with which a surface chooses a light and a point of it, or a
// direction, which is `wi`.
fn direct_pdf(point: LightPoint, context: ShapeSampleContext, wi: vec3f) -> f32 {
    let at = light_record(point.light);
    var pdf = 1.0;
    let kind = word(at);
    if (is_far(kind)) {
        pdf = far_density(at, wi);
    } else if (HAS_POINT_LIGHTS && is_at_point(kind)) {
        pdf = Vec3_length_squared(point.p - context.p.p);
    } else if (HAS_SURFACE_LIGHTS) {
        pdf = pdf_of_point(point.light, context, point.p, point.n, point.uv);
    }
    return light_pmf(context, point.light) * pdf;
}

// The light's end of a path, in the unit direction `wi` from a surface.
fn light_end(point: LightPoint, from_: vec3f, wi: vec3f, direct: f32) -> LightEnd {
    let at = light_record(point.light);
    var pdf = 1.0;
    var cosine = 1.0;
    let kind = word(at);
    if (is_far(kind)) {
        pdf = disk_density(from_, wi) * far_density(at, wi);
    } else if (HAS_POINT_LIGHTS && is_at_point(kind)) {
        pdf = point_direction_density(at, -wi);
    } else if (HAS_SURFACE_LIGHTS) {
        pdf = density_on_light(at, point.n, point.uv) * surface_direction_density(at, point.n, -wi);
        cosine = abs(dot(point.n, wi));
    }
    let pmf = number(word(world.light_paths + 1) + 4 * point.light + 1);
    return LightEnd(direct, pmf * pdf, cosine, is_delta(at));
}

// The density of a ray's point on the disk from which distant light comes; 0 where it misses the
// scene's sphere or begins beyond the disk.
fn disk_density(o: vec3f, d: vec3f) -> f32 {
    let sphere = sphere_of_scene();
    let to_center = sphere.xyz - o;
    let along = dot(to_center, d);
    let beside = to_center - d * along;
    let misses = dot(beside, beside) > sphere.w * sphere.w || -along > sphere.w;
    return select(1 / (3.1415927 * sphere.w * sphere.w), 0, misses);
}
