// Translated from crates/math/src/float.rs
// by `cargo xtask wgsl`, which translates it again.

const float_MACHINE_EPSILON: f32 = 1.1920929e-7f * 0.5f;

const float_ONE_MINUS_EPSILON: f32 = 1.0f - float_MACHINE_EPSILON;

// `x²`.
fn sqr(x: f32) -> f32 {
    return x * x;
}

// Square root; values below zero, which are due to rounding, count as zero.
fn safe_sqrt(x: f32) -> f32 {
    return sqrt(real_max(x, 0.0f));
}

// `(1 − t)·a + t·b`.
fn lerp(t: f32, a: f32, b: f32) -> f32 {
    return ((1.0f - t) * a) + (t * b);
}

// `a·b − c·d`, correct to about one unit in the last place even when the products nearly cancel.
fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    let cd = c * d;
    let difference = fma(a, b, -cd);
    let error = fma(-c, d, cd);
    return difference + error;
}

// `a·b + c·d`, correct to about one unit in the last place.
fn sum_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    return difference_of_products(a, b, -c, d);
}
