// What is seen at the middle of each pixel of a frame.

@group(0) @binding(5) var<uniform> frame: FrameParameters;
@group(0) @binding(6) var<storage, read_write> seen: array<Seen>;
@group(0) @binding(8) var<storage, read_write> film: Film;

// One wavelength for each colour: guides need not be exact, but without noise.
const GUIDES = vec4f(610, 550, 460, 550);

// The least share of the largest component of a guide, so that others may be divided by it.
const LEAST_GUIDE = 0.02;

fn guide_of_sky(o: vec3f, d: vec3f, lambda: SampledWavelengths) -> vec3f {
    var l = vec3f();
    for (var i = 0u; i < world.infinite_count; i++) {
        l += sky(word(world.infinite + i), o, d, lambda).l.xyz;
    }
    return l;
}

fn reflectance(bsdf: Bsdf) -> vec3f {
    switch (bsdf.kind) {
        case MaterialTag_Diffuse, MaterialTag_CoatedDiffuse: { return bsdf.diffuse.reflectance.xyz; }
        case MaterialTag_DiffuseTransmission: {
            return bsdf.translucent.reflectance.xyz + bsdf.translucent.transmittance.xyz;
        }
        default: { return vec3f(1); }
    }
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let camera = camera_sample(frame.low + id.xy, frame.index);
    var lambda = SampledWavelengths(GUIDES, vec4f(1));
    let hit = nearest(camera.ray);
    var found = Seen(camera.ray.d, infinity(), vec3f(), 0, vec3f());
    if (hit.found) {
        var s = surface_at(hit, camera.ray);
        found.p = s.p.p;
        found.distance = hit.t;
        found.n = seen_normal(s);
        found.id = 1 + s.material;
        if (s.light != 0) {
            found.guide = light_radiance(light_record(s.light - 1), s, lambda).xyz;
        }
        if (all(found.guide == vec3f())) {
            let bsdf = bsdf_at(&s, texture_context(s, camera.near), &lambda);
            found.guide = select(vec3f(1), reflectance(bsdf), IS_REFLECTED);
        } else {
            found.id = 0x80000000u | s.light;
        }
    } else {
        found.guide = guide_of_sky(camera.ray.o, camera.ray.d, lambda);
    }
    let largest = max(found.guide.x, max(found.guide.y, found.guide.z));
    found.guide = select(vec3f(1), max(found.guide, vec3f(LEAST_GUIDE * largest)), largest > 1e-6);
    let at = id.y * frame.size.x + id.x;
    seen[frame.half * frame.size.x * frame.size.y + at] = found;
    keep_hit(at, hit);
}
