// Camera paths at what they hit.
//
// Of light that is `is_reserved` for others they add nothing, and weight it by `hit_weight` where
// light sampling could have found it, too. Both are the kernel's, as is `Path`.

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

// Leads a path that has hit an interface at distance `t` on.
fn pass_interface(path: ptr<function, Path>, s: Surface, t: f32) {
    var near = (*path).near;
    var ray = (*path).ray;
    pass_through(&ray, &near, s, t);
    (*path).near = near;
    (*path).ray = ray;
}

// The BSDF that a path samples of a material: of a body the boundary alone, and roughened where
// that is wanted of paths that rough surfaces have scattered before.
fn roughen(bsdf: ptr<function, Bsdf>, rough_before: bool) {
    keep_boundary(bsdf);
    if (has_setting(SettingBit_Regularizes) && rough_before) {
        regularize(bsdf);
    }
}

// The density of the direction of a sample, which of one that is a walk is known for that alone.
fn density_of_sample(bsdf: Bsdf, wo: vec3f, sample: BsdfSample) -> f32 {
    if (HAS_COATS && sample.pdf_is_proportional) {
        return bsdf_pdf(bsdf, wo, sample.wi);
    }
    return sample.pdf;
}
