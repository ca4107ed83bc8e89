// In place of bodies in kernels of scenes that have none.

fn medium_under(record: u32, facets: TrowbridgeReitz, a: vec4f, b: vec4f) -> array<vec4f, 2> {
    return array<vec4f, 2>();
}

fn boundary_factor(bsdf: Bsdf, wo: vec3f, wi: vec3f, is_sample: bool) -> f32 {
    return 1;
}

fn keep_boundary(bsdf: ptr<function, Bsdf>) {
}

fn body_f(bsdf: Bsdf, wo: vec3f, wi: vec3f) -> vec4f {
    return vec4f();
}

fn body_pdf(bsdf: Bsdf, wo: vec3f, wi: vec3f) -> f32 {
    return 0;
}

fn body_sample(bsdf: Bsdf, wo: vec3f, uc: f32, u: vec2f) -> BsdfSample {
    return BsdfSample_invalid();
}

fn exit_f(bsdf: Bsdf, wo: vec3f, wi: vec3f) -> vec4f {
    return vec4f();
}

fn exit_pdf(wo: vec3f, wi: vec3f) -> f32 {
    return 0;
}

fn exit_sample(bsdf: Bsdf, wo: vec3f, u: vec2f) -> BsdfSample {
    return BsdfSample_invalid();
}
