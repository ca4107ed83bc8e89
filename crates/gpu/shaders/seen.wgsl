// Lights that the camera sees, and nothing else.

fn radiance(ray: Ray, near: Differentials, lambda: ptr<function, SampledWavelengths>) -> vec4f {
    let hit = nearest(ray);
    var l = vec4f();
    if (!hit.found) {
        for (var i = 0u; i < world.infinite_count; i++) {
            l += sky(word(world.infinite + i), ray.o, ray.d, *lambda).l;
        }
        return l;
    }
    let s = surface_at(hit, ray);
    if (s.light != 0) {
        l = light_radiance(light_record(s.light - 1), s, *lambda);
    }
    return l;
}
