// Ambient occlusion: one shadow ray over the hemisphere of the first surface.

fn radiance(ray: Ray, near: Differentials, lambda: ptr<function, SampledWavelengths>) -> vec4f {
    var l = vec4f();
    // The camera ray, and then the shadow ray, at one place of the program, because traversal is
    // long.
    var next = ray;
    for (var i = 0u; i < 2; i++) {
        let is_shadow = i == 1;
        let hit = traced(next, select(infinity(), world.max_distance, is_shadow), is_shadow);
        if (is_shadow) {
            return select(l, vec4f(), hit.found);
        }
        if (!hit.found) {
            break;
        }
        let s = surface_at(hit, ray);
        let u = get_2d();
        var wi: vec3f;
        var pdf = 0.15915494;
        if (world.cos_sample == 1) {
            wi = sample_cosine_hemisphere(u);
            pdf = cosine_hemisphere_pdf(wi.z);
        } else {
            wi = sample_uniform_hemisphere(u);
        }
        let n = face_forward(s.n, s.wo);
        let scale = select(world.white_scale * wi.z / (3.1415927 * pdf), 0, pdf == 0);
        l = spectrum(world.white, *lambda) * scale;
        if (is_black(l)) {
            break;
        }
        next = Ray_spawn(s.p, s.n, Frame_from_local(Frame_from_z(n), wi), 0);
    }
    return vec4f();
}
