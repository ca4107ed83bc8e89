// Whitted's ray tracing: the light of all lights with shadows, perfect reflection and refraction.

// `MAX_RAYS` is how many rays may wait: one for each scattering event of a path, and one more.
// `HAS_AMBIENT` says that skies of one colour cast no shadows.

// A ray of the tree.
struct Branch {
    ray: Ray,
    near: Differentials,
    beta: vec4f,
    depth: u32,
}

fn radiance(ray: Ray, near: Differentials, lambda: ptr<function, SampledWavelengths>) -> vec4f {
    var l = vec4f();
    var waiting: array<Branch, MAX_RAYS>;
    waiting[0] = Branch(ray, near, vec4f(1), 0);
    var count = 1u;
    while (count > 0) {
        count--;
        let branch = waiting[count];
        let hit = nearest(branch.ray);
        if (!hit.found) {
            for (var i = 0u; i < world.infinite_count; i++) {
                l += branch.beta * sky(word(world.infinite + i), branch.ray.o, branch.ray.d, *lambda).l;
            }
            continue;
        }
        var s = surface_at(hit, branch.ray);
        if (s.light != 0) {
            l += branch.beta * light_radiance(light_record(s.light - 1), s, *lambda);
        }
        let textures = texture_context(s, branch.near);
        let bsdf = bsdf_at(&s, textures, lambda);
        if (branch.depth == world.max_depth) {
            continue;
        }
        l += branch.beta * all_lights(s, bsdf, *lambda, true, HAS_AMBIENT);
        if ((bxdf_flags(bsdf) & BxdfFlags_SPECULAR) == 0) {
            continue;
        }
        // The refracted ray waits for all that the reflected one finds.
        let sides = array(Directions_Reflection, Directions_Transmission);
        var samples: array<BsdfSample, 2>;
        for (var i = 0u; i < 2; i++) {
            var u: array<vec2f, 2>;
            for (var j = 0u; j < 2; j++) {
                u[j] = next_numbers(j == 1);
            }
            samples[i] = bsdf_sample_of(bsdf, s.wo, u[0].x, u[1], sides[i]);
        }
        for (var i = 2u; i > 0; i--) {
            let sample = samples[i - 1];
            if (sample.valid && (sample.flags & BxdfFlags_SPECULAR) != 0) {
                let beta = branch.beta * sample.f * (abs(dot(sample.wi, s.ns)) / sample.pdf);
                let beside = scattered_differentials(s, textures, branch.near, sample);
                waiting[count] = Branch(spawn(s, sample.wi), beside, beta, branch.depth + 1);
                count++;
            }
        }
    }
    return l;
}
