// The light that a camera path hits: of what is `is_reserved` for others nothing, and weighted by
// `hit_weight` where light sampling could have found it, too. Both are the kernel's, as is `Path`.

// The weighted radiance along a ray that leaves the scene.
fn escaped(path: Path, lambda: SampledWavelengths) -> vec4f {
    if (is_reserved(path)) {
        return vec4f();
    }
    var sum = vec4f();
    for (var i = 0u; i < world.infinite_count; i++) {
        let light = word(world.infinite + i);
        let seen = sky(light, path.ray.o, path.ray.d, lambda);
        var weight = 1.0;
        if (path.is_found_twice) {
            weight = hit_weight(path, light, seen.pdf);
        }
        sum += seen.l * weight;
    }
    return sum;
}

// The weighted emission of a surface back along the ray.
fn emitted(path: Path, s: Surface, uv: vec2f, lambda: SampledWavelengths) -> vec4f {
    if (!HAS_SURFACE_LIGHTS || s.light == 0 || is_reserved(path)) {
        return vec4f();
    }
    let light = s.light - 1;
    let l = light_radiance(light_record(light), s, lambda);
    if (is_black(l) || !path.is_found_twice) {
        return l;
    }
    return l * hit_weight(path, light, pdf_of_surface(light, path.origin, s, uv));
}
