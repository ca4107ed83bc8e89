// Simple path tracing and walks in uniform directions, as `simple_path.rs` and `random_walk.rs` of
// `integrators/src/camera_paths/` have them.

fn radiance(ray: Ray, near: Differentials, lambda: ptr<function, SampledWavelengths>) -> vec4f {
    var l = vec4f();
    var beta = vec4f(1);
    var next = ray;
    var beside = near;
    var depth = 0u;
    // Whether lights count that the ray hits.
    var counts = true;
    var direct: DirectLight;
    var goes_on = true;
    let samples_lights = has_setting(SettingBit_SamplesLights);
    // Each turn follows the last vertex's shadow ray, or the ray to the next vertex, at one place
    // of the program, because traversal is long.
    loop {
        let is_shadow = !is_black(direct.l);
        if (!is_shadow && !goes_on) {
            break;
        }
        var ray_now = next;
        if (is_shadow) {
            ray_now = direct.shadow.ray;
        }
        let hit = traced(ray_now, select(infinity(), direct.shadow.t_max, is_shadow), is_shadow);
        if (is_shadow) {
            l += select(direct.l, vec4f(), hit.found);
            direct.l = vec4f();
            continue;
        }
        if (!hit.found) {
            for (var i = 0u; i < world.infinite_count && counts; i++) {
                l += beta * sky(word(world.infinite + i), next.o, next.d, *lambda).l;
            }
            break;
        }
        var s = surface_at(hit, next);
        if (s.light != 0 && counts) {
            l += beta * light_radiance(light_record(s.light - 1), s, *lambda);
        }
        if (HAS_MEDIA && is_interface(s.material)) {
            pass_through(&next, &beside, s, hit.t);
            // Interfaces occlude shadow rays here, so that only the path itself finds lights
            // beyond.
            counts = true;
            continue;
        }
        let bsdf = bsdf_at(&s, texture_context(s, beside), lambda);
        if (depth == world.max_depth) {
            break;
        }
        depth++;
        // What chooses the light and its point, and the lobe and its direction.
        let follows_bsdf = has_setting(SettingBit_SamplesBsdfs);
        var u: array<vec2f, 4>;
        for (var i = select(2u, 0u, samples_lights); i < 4; i++) {
            if ((i != 1 || world.light_count > 0) && (i != 2 || follows_bsdf)) {
                u[i] = next_numbers((i & 1) == 1);
            }
        }
        let flags = bxdf_flags(bsdf);
        if (samples_lights) {
            let context = light_context(s, flags);
            let choice = choose_light(context, u[0].x);
            if (choice.valid) {
                let light = sample_light(choice.light, context, u[1], *lambda, false);
                if (light.valid) {
                    direct.l = beta * scattered(s, bsdf, light) / (choice.pmf * light.pdf);
                    direct.shadow = shadow_ray(s, light);
                }
            }
        }
        var wi: vec3f;
        if (follows_bsdf) {
            let sample = bsdf_sample(bsdf, s.wo, u[2].x, u[3]);
            wi = sample.wi;
            goes_on = sample.valid;
            beta *= sample.f * (abs(dot(wi, s.ns)) / sample.pdf);
            counts = !samples_lights || (sample.flags & BxdfFlags_SPECULAR) != 0;
        } else {
            wi = sample_uniform_sphere(u[3]);
            var pdf = 1 / (4 * 3.1415927);
            let sides = flags & (BxdfFlags_REFLECTION | BxdfFlags_TRANSMISSION);
            let has_one_side = sides != (BxdfFlags_REFLECTION | BxdfFlags_TRANSMISSION);
            if (has_setting(SettingBit_MirrorsDirections) && has_one_side) {
                // Directions on the other side are mirrored, which doubles the density.
                pdf *= 2;
                let is_same_side = dot(s.wo, s.n) * dot(wi, s.n) > 0;
                wi *= select(-1.0, 1.0, is_same_side == ((flags & BxdfFlags_REFLECTION) != 0));
            }
            beta *= bsdf_f(bsdf, s.wo, wi) * (abs(dot(wi, s.ns)) / pdf);
            counts = !samples_lights;
        }
        goes_on = goes_on && !is_black(beta);
        next = spawn(s, wi);
        beside = no_differentials();
    }
    return l;
}
