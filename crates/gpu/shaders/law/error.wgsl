// Translated from crates/math/src/error.rs
// by `cargo xtask wgsl`, which translates it again.

// A point with the bound of the absolute error of each of its coordinates.
struct Point3Error {
    p: vec3f,
    error: vec3f,
}

// A point with its error bound.
fn Point3Error_new(p: vec3f, error: vec3f) -> Point3Error {
    return Point3Error(p, error);
}

// The origin of a ray in direction `w` that cannot intersect the surface with geometric normal `n`
// at `p` again.
fn offset_ray_origin(p: Point3Error, n: vec3f, w: vec3f) -> vec3f {
    let distance_1 = Vec3_dot(abs(n), p.error);
    let offset = n * select(distance_1, -distance_1, Vec3_dot(w, n) < 0.0f);
    let q = p.p + offset;
    let step_1 = Vec3_copysign(abs(q) * 1.1920929e-7f, offset);
    let offset_1 = offset.x;
    let q_1 = q.x;
    let step_2 = step_1.x;
    let offset_2 = offset.y;
    let q_2 = q.y;
    let step_3 = step_1.y;
    let offset_3 = offset.z;
    let q_3 = q.z;
    let step_4 = step_1.z;
    return vec3f(select(q_1 + step_2, q_1, offset_1 == 0.0f), select(q_2 + step_3, q_2, offset_2 == 0.0f), select(q_3 + step_4, q_3, offset_3 == 0.0f));
}
