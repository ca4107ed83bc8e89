// Translated from crates/sampling/src/warp/interval.rs
// by `cargo xtask wgsl`, which translates it again.

// A number in [0, 1] with density proportional to `lerp(x, a, b)`, for a, b ≥ 0.
fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    let x = (u * (a + b)) / (a + sqrt(lerp(u, a * a, b * b)));
    let x_1 = real_min(x, float_ONE_MINUS_EPSILON);
    let at_zero = (u == 0.0f) & (a == 0.0f);
    return select(select(x_1, 0.0f, at_zero), u, (a + b) <= 0.0f);
}

// Density of [`sample_linear`].
fn linear_pdf(x: f32, a: f32, b: f32) -> f32 {
    let inside = (x >= 0.0f) & (x <= 1.0f);
    let pdf = (lerp(x, a, b) * 2.0f) / (a + b);
    let pdf_1 = select(pdf, 1.0f, (a + b) <= 0.0f);
    return select(0.0f, pdf_1, inside);
}

// A number in [−r, r] with a density that falls linearly from 0 to both ends.
fn sample_tent(u: f32, r: f32) -> f32 {
    let rises = u < 0.5f;
    let doubled = 2.0f * u;
    let y = doubled - 1.0f;
    let v = select(y, doubled, rises);
    let a = select(1.0f, 0.0f, rises);
    let b = select(0.0f, 1.0f, rises);
    let x = sample_linear(v, a, b);
    return r * select(x, x - 1.0f, rises);
}
