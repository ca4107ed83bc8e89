// Translated from crates/math/src/frame.rs
// by `cargo xtask wgsl`, which translates it again.

// Three orthonormal axes; local +z is the main axis (the normal of a surface, the axis of a beam).
struct Frame {
    x: vec3f,
    y: vec3f,
    z: vec3f,
}

// A frame with the unit vector `z`, and any x and y.
fn Frame_from_z(z: vec3f) -> Frame {
    let parts = coordinate_system(z);
    let x = parts.v0;
    let y = parts.v1;
    return Frame(x, y, z);
}

// The frame with the unit vector `z`, and the direction nearest to `x` that is perpendicular
// to it; [`Frame::from_z`] where `x` is zero or parallel to `z`.
fn Frame_from_z_and_x(z: vec3f, x: vec3f) -> Frame {
    let parts = Vec3_normalize_masked(x - (z * Vec3_dot(z, x)));
    let x_1 = parts.v0;
    let valid = parts.v1;
    let x_2 = Vec3_normalize(x_1 - (z * Vec3_dot(z, x_1)));
    let frame = Frame(x_2, Vec3_cross(z, x_2), z);
    if (valid) {
        return frame;
    } else {
        return Frame_select(valid, frame, Frame_from_z(z));
    }
}

// `a` where the mask is true, else `b`.
fn Frame_select(mask: bool, a: Frame, b: Frame) -> Frame {
    let a_1 = a.x;
    let b_1 = b.x;
    let a_2 = a.y;
    let b_2 = b.y;
    let a_3 = a.z;
    let b_3 = b.z;
    return Frame(select(b_1, a_1, mask), select(b_2, a_2, mask), select(b_3, a_3, mask));
}

// Outer coordinates to local ones.
fn Frame_to_local(this_: Frame, v: vec3f) -> vec3f {
    return vec3f(Vec3_dot(v, this_.x), Vec3_dot(v, this_.y), Vec3_dot(v, this_.z));
}

// Local coordinates to outer ones.
fn Frame_from_local(this_: Frame, v: vec3f) -> vec3f {
    return ((this_.x * v.x) + (this_.y * v.y)) + (this_.z * v.z);
}

// Two unit vectors that make a right-handed frame with the unit vector `z`, without a branch
// ([Duff et al. 2017]).
fn coordinate_system(z: vec3f) -> Tuple_Vec3_Vec3 {
    let sign_1 = copysign(1.0f, z.z);
    let a = -1.0f / (sign_1 + z.z);
    let b = (z.x * z.y) * a;
    let x = vec3f(1.0f + (((sign_1 * z.x) * z.x) * a), sign_1 * b, (-sign_1) * z.x);
    return Tuple_Vec3_Vec3(x, vec3f(b, sign_1 + ((z.y * z.y) * a), -z.y));
}
