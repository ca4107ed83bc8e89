// Translated from crates/lanes/src/function/arc.rs
// by `cargo xtask wgsl`, which translates it again.

const arc_FRAC_PI_2_REST: f32 = -4.371139e-8f;

// arcsin x in [−π/2, π/2], with an error below 1.4 ulp; NaN where |x| > 1.
fn arc_asin(x: f32) -> f32 {
    let parts = arcsine(abs(x));
    let is_small = parts.v0;
    let arc = parts.v1;
    let near_one = 1.5707964f - ((arc + arc) - arc_FRAC_PI_2_REST);
    return copysign(select(near_one, arc, is_small), x);
}

// arccos x in [0, π], with an error below 1.2 ulp; NaN where |x| > 1.
fn arc_acos(x: f32) -> f32 {
    let parts = arcsine(abs(x));
    let is_small = parts.v0;
    let arc = parts.v1;
    let arc_1 = copysign(arc, x);
    let is_negative = x < 0.0f;
    let near_zero = 1.5707964f - (arc_1 - arc_FRAC_PI_2_REST);
    let twice = arc_1 + arc_1;
    let near_minus_one = 3.1415927f + (twice + (2.0f * arc_FRAC_PI_2_REST));
    return select(select(twice, near_minus_one, is_negative), near_zero, is_small);
}

// Of 0 ≤ x ≤ 1 the arcsine where the mask is true; elsewhere half of the arccosine.
fn arcsine(x: f32) -> Tuple_bool_f32 {
    let is_small = x < 0.55f;
    let z = select(0.5f - (0.5f * x), x * x, is_small);
    let s = select(sqrt(z), x, is_small);
    return Tuple_bool_f32(is_small, s + ((s * z) * (((((4.520694e-2f * z + 8.645301e-3f) * z + 3.342478e-2f) * z + 4.431311e-2f) * z + 7.501619e-2f) * z + 0.1666664f)));
}

// arctan x in [−π/2, π/2], with an error below 1.6 ulp.
fn arc_atan(x: f32) -> f32 {
    let magnitude = abs(x);
    let is_large = magnitude > 1.0f;
    let arc = arctangent(select(magnitude, 1.0f, is_large) / select(1.0f, magnitude, is_large));
    let from_above = 1.5707964f - (arc - arc_FRAC_PI_2_REST);
    return copysign(select(arc, from_above, is_large), x);
}

// The angle in [−π, π] from the x axis to the point (x, y), with an error below 2 ulp. It has the
// sign of y. Signs of zeros count, and infinite coordinates are equally far.
fn arc_atan2(y: f32, x: f32) -> f32 {
    let a = abs(y);
    let b = abs(x);
    let is_steep = a > b;
    let small = select(a, b, is_steep);
    let large = select(b, a, is_steep);
    let quotient = small / select(large, 1.0f, large == 0.0f);
    let infinity = infinity();
    let quotient_1 = select(quotient, 1.0f, (small == infinity) & (large == infinity));
    let arc = arctangent(quotient_1);
    let is_left = copysign(1.0f, x) < 0.0f;
    let arc_1 = select(arc, -arc, is_left != is_steep);
    let straight = 1.5707964f + 1.5707964f;
    let start = select(0.0f, straight, is_left);
    let start_rest = select(0.0f, arc_FRAC_PI_2_REST + arc_FRAC_PI_2_REST, is_left);
    let arc_2 = select(start, 1.5707964f, is_steep) + (arc_1 + select(start_rest, arc_FRAC_PI_2_REST, is_steep));
    return copysign(arc_2, y);
}

// arctan x for 0 ≤ x ≤ 1, with a relative error of 2⁻²⁸·⁵ before rounding.
fn arctangent(x: f32) -> f32 {
    let z = x * x;
    return x + ((x * z) * ((((((((-1.791502e-3f * z + 1.0904536e-2f) * z + -3.1157765e-2f) * z + 5.7935804e-2f) * z + -8.402056e-2f) * z + 0.109516546f) * z + -0.14264126f) * z + 0.19998536f) * z + -0.333333f));
}
