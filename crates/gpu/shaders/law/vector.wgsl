// Translated from crates/math/src/vector.rs
// by `cargo xtask wgsl`, which translates it again.

// The square of the length.
fn Vec2_length_squared(this_: vec2f) -> f32 {
    return Vec2_dot(this_, this_);
}

// The Euclidean length.
fn Vec3_length(this_: vec3f) -> f32 {
    return sqrt(Vec3_dot(this_, this_));
}

// The square of the length.
fn Vec3_length_squared(this_: vec3f) -> f32 {
    return Vec3_dot(this_, this_);
}

// The vector of length one with the same direction; not finite for the zero vector.
fn Vec3_normalize(this_: vec3f) -> vec3f {
    let v = Vec3_balanced(this_);
    return v * (1.0f / Vec3_length(v));
}

// The vector of length one with the same direction, and where there is one: not where
// a coordinate is not finite, or all are zero.
fn Vec3_normalize_masked(this_: vec3f) -> Tuple_Vec3_bool {
    let v = Vec3_balanced(this_);
    let inverse = 1.0f / Vec3_length(v);
    let valid = (inverse > 0.0f) & (inverse < infinity());
    return Tuple_Vec3_bool(v * inverse, valid);
}

// The vector times a power of two that makes the magnitude of its largest coordinate
// one to two, so that squares and cubes of coordinates neither overflow nor vanish.
// Zero, infinities and NaN stay.
fn Vec3_balanced(this_: vec3f) -> vec3f {
    return this_ * balance(Vec3_max_element(abs(this_)));
}

// The larger of each pair of coordinates; that of `b` where either is NaN.
fn Vec3_max(this_: vec3f, b: vec3f) -> vec3f {
    return vec3f(real_max(this_.x, b.x), real_max(this_.y, b.y), real_max(this_.z, b.z));
}

// The magnitudes of `self` with the signs of `sign`.
fn Vec3_copysign(this_: vec3f, sign_1: vec3f) -> vec3f {
    return vec3f(copysign(this_.x, sign_1.x), copysign(this_.y, sign_1.y), copysign(this_.z, sign_1.z));
}

// The scalar product.
fn Vec2_dot(this_: vec2f, b: vec2f) -> f32 {
    return (this_.x * b.x) + (this_.y * b.y);
}

// The scalar product.
fn Vec3_dot(this_: vec3f, b: vec3f) -> f32 {
    return ((this_.x * b.x) + (this_.y * b.y)) + (this_.z * b.z);
}

// The vector product.
fn Vec3_cross(this_: vec3f, b: vec3f) -> vec3f {
    return vec3f((this_.y * b.z) - (b.y * this_.z), (this_.z * b.x) - (b.z * this_.x), (this_.x * b.y) - (b.x * this_.y));
}

// Where all coordinates are finite.
fn Vec3_are_finite(this_: vec3f) -> bool {
    return ((abs(this_.x) <= 3.4028234e38f) & (abs(this_.y) <= 3.4028234e38f)) & (abs(this_.z) <= 3.4028234e38f);
}

// The largest coordinate.
fn Vec3_max_element(this_: vec3f) -> f32 {
    return real_max(this_.x, real_max(this_.y, this_.z));
}

const Vec3_X: vec3f = vec3f(1.0f, 0.0f, 0.0f);

const Vec3_Z: vec3f = vec3f(0.0f, 0.0f, 1.0f);
