// Translated from crates/math/src/octahedral.rs
// by `cargo xtask wgsl`, which translates it again.

// The unit direction of a point of [0, 1]².
fn equal_area_square_to_sphere(p: vec2f) -> vec3f {
    let u = (2.0f * p.x) - 1.0f;
    let v = (2.0f * p.y) - 1.0f;
    let up = abs(u);
    let vp = abs(v);
    let signed_distance = 1.0f - (up + vp);
    let r = 1.0f - abs(signed_distance);
    let turn_1 = select(((vp - up) / r) + 1.0f, 1.0f, r == 0.0f);
    let z = copysign(1.0f - (r * r), signed_distance);
    let parts = sin_cos(turn_1 * 0.7853982f);
    let sin_phi_1 = parts.v0;
    let cos_phi_1 = parts.v1;
    let radius_1 = r * safe_sqrt(2.0f - (r * r));
    return vec3f(copysign(cos_phi_1, u) * radius_1, copysign(sin_phi_1, v) * radius_1, z);
}

// The point of [0, 1]² of a unit direction: the inverse of [`equal_area_square_to_sphere`].
fn equal_area_sphere_to_square(d: vec3f) -> vec2f {
    let x = abs(d.x);
    let y = abs(d.y);
    let z = abs(d.z);
    let r = real_min(sqrt(((x * x) + (y * y)) / (1.0f + z)), 1.0f);
    let large = select(y, x, x > y);
    let small = select(x, y, x > y);
    let angle = select(arc_atan(small / large) * 0.63661975f, 0.0f, large == 0.0f);
    let phi = select(angle, 1.0f - angle, x < y);
    let u = r - (phi * r);
    let v = phi * r;
    let is_below = d.z < 0.0f;
    let u_1 = select(u, 1.0f - v, is_below);
    let v_1 = select(v, 1.0f - u, is_below);
    return vec2f((copysign(u_1, d.x) + 1.0f) * 0.5f, (copysign(v_1, d.y) + 1.0f) * 0.5f);
}

// Wraps a point slightly outside of [0, 1]² to the point inside with the same direction.
fn wrap_equal_area_square(p: vec2f) -> vec2f {
    let is_left = p.x < 0.0f;
    let is_right = p.x > 1.0f;
    let x = select(select(p.x, 2.0f - p.x, is_right), -p.x, is_left);
    let y = select(p.y, 1.0f - p.y, is_left | is_right);
    let is_above_1 = y < 0.0f;
    let is_below = y > 1.0f;
    let x_1 = select(x, 1.0f - x, is_above_1 | is_below);
    return vec2f(x_1, select(select(y, 2.0f - y, is_below), -y, is_above_1));
}
