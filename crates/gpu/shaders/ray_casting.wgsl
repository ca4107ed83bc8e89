// Ray casting: emission, and the light of all lights without shadows.

fn radiance(ray: Ray, near: Differentials, lambda: ptr<function, SampledWavelengths>) -> vec4f {
    let hit = nearest(ray);
    var l = vec4f();
    if (!hit.found) {
        for (var i = 0u; i < world.infinite_count; i++) {
            l += sky(word(world.infinite + i), ray.o, ray.d, *lambda).l;
        }
        return l;
    }
    var s = surface_at(hit, ray);
    if (s.light != 0) {
        l = light_radiance(light_record(s.light - 1), s, *lambda);
    }
    let bsdf = bsdf_at(&s, texture_context(s, near), lambda);
    return l + all_lights(s, bsdf, *lambda, false, false);
}
