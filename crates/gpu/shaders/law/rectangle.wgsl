// Translated from crates/sampling/src/warp/rectangle.rs
// by `cargo xtask wgsl`, which translates it again.

// A rectangle as seen from a point, for each lane.
struct SphericalRectangle {
    origin: vec3f,
    unit: f32,
    axes: array<vec3f, 3>,
    scales: vec2f,
    x: vec2f,
    y: vec2f,
    z: f32,
    phi: vec2f,
}

// The rectangle with a corner and two sides at right angles, seen from `p`.
fn SphericalRectangle_new(p: vec3f, corner: vec3f, side_x: vec3f, side_y: vec3f) -> SphericalRectangle {
    let d = corner - p;
    let largest = Vec3_max_element(Vec3_max(abs(d), Vec3_max(abs(side_x), abs(side_y))));
    let unit = balance(largest);
    let d_1 = d * unit;
    let side_x_1 = side_x * unit;
    let side_y_1 = side_y * unit;
    let length_x = Vec3_length(side_x_1);
    let length_y = Vec3_length(side_y_1);
    let scales_0 = 1.0f / length_x;
    let scales_1 = 1.0f / length_y;
    let axis_x = side_x_1 * scales_0;
    let axis_y = side_y_1 * scales_1;
    let axis_z = Vec3_cross(axis_x, axis_y);
    let z = Vec3_dot(d_1, axis_z);
    let is_behind = z > 0.0f;
    let axis_z_1 = select(axis_z, -axis_z, is_behind);
    let x = Vec3_dot(d_1, axis_x);
    let y = Vec3_dot(d_1, axis_y);
    var rectangle = SphericalRectangle(p, unit, array<vec3f, 3>(axis_x, axis_y, axis_z_1), vec2f(scales_0, scales_1), vec2f(x, x + length_x), vec2f(y, y + length_y), -abs(z), vec2f(0.0f, 0.0f));
    rectangle.phi = vec2f(SphericalRectangle_phi_at(rectangle, rectangle.x.x), SphericalRectangle_phi_at(rectangle, rectangle.x.y));
    return rectangle;
}

// Where it has a solid angle. Elsewhere all else is meaningless.
fn SphericalRectangle_is_valid(this_: SphericalRectangle) -> bool {
    return (this_.z < 0.0f) & (this_.phi.y > this_.phi.x);
}

// In steradians.
fn SphericalRectangle_solid_angle(this_: SphericalRectangle) -> f32 {
    return this_.phi.y - this_.phi.x;
}

// The density of [`sample`](Self::sample) per solid angle.
fn SphericalRectangle_pdf(this_: SphericalRectangle) -> f32 {
    return 1.0f / (this_.phi.y - this_.phi.x);
}

// A point of the rectangle, by the parts of the sides that lead to it. Divisions are few, as
// they take most of the time.
fn SphericalRectangle_sample(this_: SphericalRectangle, u: vec2f) -> vec2f {
    let parts = this_.x;
    let x0 = parts.x;
    let x1 = parts.y;
    let parts_1 = this_.y;
    let y0 = parts_1.x;
    let y1 = parts_1.y;
    let z = this_.z;
    let scales = this_.scales;
    let z2 = z * z;
    let parts_2 = inverse_lengths(z2, this_.y);
    let r0 = parts_2.x;
    let r1 = parts_2.y;
    let b0 = -(y0 * r0);
    let b1 = y1 * r1;
    let parts_3 = sin_cos(this_.phi.x + (u.x * (this_.phi.y - this_.phi.x)));
    let sin_1 = parts_3.v0;
    let cos_1 = parts_3.v1;
    let f = (cos_1 * b0) + b1;
    let rest = (z * r0) * sin_1;
    let root = sqrt(real_max((f * f) - (rest * rest), 1.1754944e-38f));
    let x = real_min(real_max(((-z) * sin_1) / copysign(root, f), x0), x1);
    let distance2 = (x * x) + z2;
    let parts_4 = inverse_lengths(distance2, this_.y);
    let r0_1 = parts_4.x;
    let r1_1 = parts_4.y;
    let h0 = y0 * r0_1;
    let h1 = y1 * r1_1;
    let h = h0 + (u.y * (h1 - h0));
    let y = real_min(real_max(h * sqrt(distance2 / real_max(1.0f - (h * h), 1.1754944e-38f)), y0), y1);
    return vec2f(real_min(real_max((x - x0) * scales.x, 0.0f), 1.0f), real_min(real_max((y - y0) * scales.y, 0.0f), 1.0f));
}

// The `u` that [`sample`](Self::sample) sends to a point of the rectangle.
fn SphericalRectangle_invert(this_: SphericalRectangle, point: vec3f) -> vec2f {
    let d = (point - this_.origin) * this_.unit;
    let x = real_min(real_max(Vec3_dot(d, this_.axes[0]), this_.x.x), this_.x.y);
    let y = real_min(real_max(Vec3_dot(d, this_.axes[1]), this_.y.x), this_.y.y);
    let h0 = SphericalRectangle_height(this_, x, this_.y.x);
    let h1 = SphericalRectangle_height(this_, x, this_.y.y);
    let h = SphericalRectangle_height(this_, x, y);
    let u0 = (SphericalRectangle_phi_at(this_, x) - this_.phi.x) / (this_.phi.y - this_.phi.x);
    let u1 = (h - h0) / (h1 - h0);
    return vec2f(real_min(real_max(u0, 0.0f), 1.0f), real_min(real_max(u1, 0.0f), 1.0f));
}

// The height on the sphere of a point of the rectangle.
fn SphericalRectangle_height(this_: SphericalRectangle, x: f32, y: f32) -> f32 {
    return y / sqrt(((x * x) + (this_.z * this_.z)) + (y * y));
}

// φ(x), both arctangents as one.
fn SphericalRectangle_phi_at(this_: SphericalRectangle, x: f32) -> f32 {
    let parts = this_.y;
    let y0 = parts.x;
    let y1 = parts.y;
    let square = (x * x) + (this_.z * this_.z);
    let sin0 = x * y0;
    let cos0 = (-this_.z) * sqrt(square + (y0 * y0));
    let sin1 = x * y1;
    let cos1 = (-this_.z) * sqrt(square + (y1 * y1));
    return arc_atan2((sin1 * cos0) - (cos1 * sin0), (cos1 * cos0) + (sin1 * sin0));
}

// 1/√(square + y²) of both y, by one division.
fn inverse_lengths(square: f32, argument_1: vec2f) -> vec2f {
    let y0 = argument_1.x;
    let y1 = argument_1.y;
    let length0 = sqrt(square + (y0 * y0));
    let length1 = sqrt(square + (y1 * y1));
    let inverse = 1.0f / (length0 * length1);
    return vec2f(length1 * inverse, length0 * inverse);
}
