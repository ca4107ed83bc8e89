// Translated from crates/math/src/float.rs
// by `cargo xtask wgsl`, which translates it again.

const float_MACHINE_EPSILON: f32 = 1.1920929e-7f * 0.5f;

const float_ONE_MINUS_EPSILON: f32 = 1.0f - float_MACHINE_EPSILON;

// The bound (1 ± ε)ⁿ ⊂ 1 ± γ(n) on the relative error of `n` rounded operations.
fn gamma(n: u32) -> f32 {
    let ne = f32(n) * float_MACHINE_EPSILON;
    return ne / (1.0f - ne);
}

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

// Hermite step: 0 below `a`, 1 above `b`, smooth between.
fn smooth_step(x: f32, a: f32, b: f32) -> f32 {
    if (a == b) {
        if (x < a) {
            return 0.0f;
        } else {
            return 1.0f;
        }
    }
    let t = real_min(real_max((x - a) / (b - a), 0.0f), 1.0f);
    return (t * t) * (3.0f - (2.0f * t));
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
