// Made
// by `cargo xtask wgsl`, which translates it again.

struct Tuple_Facet_bool {
    v0: Facet,
    v1: bool,
}

struct Tuple_SampledSpectrum_bool {
    v0: vec4f,
    v1: bool,
}

struct Tuple_ShapeSample_bool {
    v0: ShapeSample,
    v1: bool,
}

struct Tuple_Vec2_f32 {
    v0: vec2f,
    v1: f32,
}

struct Tuple_Vec3_Vec3 {
    v0: vec3f,
    v1: vec3f,
}

struct Tuple_Vec3_bool {
    v0: vec3f,
    v1: bool,
}

struct Tuple_Vec3_f32 {
    v0: vec3f,
    v1: f32,
}

struct Tuple_Vec3_f32_bool {
    v0: vec3f,
    v1: f32,
    v2: bool,
}

struct Tuple_bool_f32 {
    v0: bool,
    v1: f32,
}

struct Tuple_f32_bool {
    v0: f32,
    v1: bool,
}

struct Tuple_f32_f32 {
    v0: f32,
    v1: f32,
}

struct Tuple_f32_u32 {
    v0: f32,
    v1: u32,
}

struct Tuple_u32_f32 {
    v0: u32,
    v1: f32,
}
