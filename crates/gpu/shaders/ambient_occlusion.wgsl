// Ambient occlusion: one shadow ray over the hemisphere of the first surface.

fn radiance(ray: Ray, near: Differentials, lambda: ptr<function, SampledWavelengths>) -> vec4f {
    let hit = nearest(ray);
    if (!hit.found) {
        return vec4f();
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
    let l = spectrum(world.white, *lambda) * scale;
    let outward = Ray_spawn(s.p, s.n, Frame_from_local(Frame_from_z(n), wi), 0);
    if (is_black(l) || occluded(outward, world.max_distance)) {
        return vec4f();
    }
    return l;
}
