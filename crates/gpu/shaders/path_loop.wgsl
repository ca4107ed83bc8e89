// A whole path by one thread: the megakernel of path tracing.

fn radiance(ray: Ray, near: Differentials, lambda: ptr<function, SampledWavelengths>) -> vec4f {
    var l = vec4f();
    var path = new_path(ray, near);
    var direct: DirectLight;
    var goes_on = true;
    loop {
        // The shadow ray of the last vertex, and then the ray to the next one, at one place of the
        // program, because traversal is long.
        var hit: Hit;
        for (var i = 0u; i < 2; i++) {
            let is_shadow = i == 0;
            if (select(!goes_on, is_black(direct.l), is_shadow)) {
                continue;
            }
            var ray = path.ray;
            if (is_shadow) {
                ray = direct.shadow.ray;
            }
            passes_interfaces = is_shadow && !direct.is_delta;
            hit = traced(ray, select(reach_of_path(), direct.shadow.t_max, is_shadow), is_shadow);
            if (is_shadow && !hit.found) {
                l += direct.l;
            }
        }
        if (!goes_on) {
            break;
        }
        goes_on = shade(&path, hit, lambda, &direct, &l);
    }
    return l;
}
