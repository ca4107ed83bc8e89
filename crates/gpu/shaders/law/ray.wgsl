// Translated from crates/math/src/ray.rs
// by `cargo xtask wgsl`, which translates it again.

const CameraEnd_Neither = 0u;
const CameraEnd_Origin = 1u;
const CameraEnd_Target = 2u;

// A ray. The direction need not have unit length; t is in lengths of the direction.
struct Ray {
    o: vec3f,
    d: vec3f,
    time: f32,
    camera: u32,
}

// A ray from `o` along `d`.
fn Ray_new(o: vec3f, d: vec3f, time: f32) -> Ray {
    return Ray(o, d, time, CameraEnd_Neither);
}

// The point o + t·d.
fn Ray_at(this_: Ray, t: f32) -> vec3f {
    return this_.o + (this_.d * t);
}

// The ray that leaves a surface at `p` with geometric normal `n` along `d`.
fn Ray_spawn(p: Point3Error, n: vec3f, d: vec3f, time: f32) -> Ray {
    return Ray_new(offset_ray_origin(p, n, d), d, time);
}

// The ray from one surface to another, on which t = 1 is the (offset) target; pass
// [`Ray::SHADOW_END`] as its end. An end without a surface (a point light, a camera) has the
// normal zero.
fn Ray_between(from_1: Point3Error, from_n: vec3f, to: Point3Error, to_n: vec3f, time: f32) -> Ray {
    let o = offset_ray_origin(from_1, from_n, to.p - from_1.p);
    let target_1 = offset_ray_origin(to, to_n, o - to.p);
    return Ray_new(o, target_1 - o, time);
}
