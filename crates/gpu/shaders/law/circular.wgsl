// Translated from crates/lanes/src/function/circular.rs
// by `cargo xtask wgsl`, which translates it again.

// sin x, of radians, with an error below 1.6 ulp. Angles from 800 on take longer.
fn circular_sin(x: f32) -> f32 {
    return sin_cos(x).v0;
}

// Both [`sin`] and [`cos`].
fn sin_cos(x: f32) -> Tuple_f32_f32 {
    let magnitude = abs(x);
    let parts = circular_reduce(magnitude);
    let r = parts.v0;
    let quadrant = parts.v1;
    let z = r * r;
    let sin_1 = r + ((r * z) * ((-1.9518263e-4f * z + 8.332189e-3f) * z + -0.16666655f));
    let quartic = (z * z) * ((2.4432553e-5f * z + -1.3887311e-3f) * z + 4.1666646e-2f);
    let cos_1 = 1.0f - ((0.5f * z) - quartic);
    let is_odd = (quadrant & 1u) == 1u;
    let sin_sign = ((quadrant & 2u) << 30) ^ (bitcast<u32>(x) & u32(1 << 31));
    let quadrant_1 = quadrant + 1u;
    let cos_sign = (quadrant_1 & 2u) << 30;
    return Tuple_f32_f32(bitcast<f32>(bitcast<u32>(select(sin_1, cos_1, is_odd)) ^ sin_sign), bitcast<f32>(bitcast<u32>(select(cos_1, sin_1, is_odd)) ^ cos_sign));
}
