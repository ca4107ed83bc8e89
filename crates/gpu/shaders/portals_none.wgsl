// In place of portals in kernels of scenes that have none.

fn portal_seen(at: u32, o: vec3f, d: vec3f, lambda: SampledWavelengths) -> Sky {
    return Sky(vec4f(), 0);
}

fn sample_portal(at: u32, p: vec3f, u: vec2f, lambda: SampledWavelengths, sample: ptr<function, LightSample>) {
}
