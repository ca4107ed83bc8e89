// Translated from crates/sampling/src/warp/triangle.rs
// by `cargo xtask wgsl`, which translates it again.

// Barycentric coordinates, uniform over a triangle.
fn sample_uniform_triangle(u: vec2f) -> vec3f {
    let below = u.x < u.y;
    let half = select(u.y, u.x, below) * 0.5f;
    let rest = select(u.x, u.y, below) - half;
    let b0 = select(rest, half, below);
    let b1 = select(half, rest, below);
    return vec3f(b0, b1, (1.0f - b0) - b1);
}

// A triangle as seen from a point, for each lane.
struct SphericalTriangle {
    to_corner: vec3f,
    sides: array<vec3f, 2>,
    distances: vec3f,
    a: vec3f,
    b: vec3f,
    one_plus_cos: f32,
    volume: f32,
    solid_angle: f32,
}

// The triangle with these corners seen from `p`.
fn SphericalTriangle_new(corners: array<vec3f, 3>, p: vec3f) -> SphericalTriangle {
    let p0 = corners[0];
    let p1 = corners[1];
    let p2 = corners[2];
    let v0 = p0 - p;
    let v1 = p1 - p;
    let v2 = p2 - p;
    let unit = balance(Vec3_max_element(Vec3_max(abs(v0), Vec3_max(abs(v1), abs(v2)))));
    let v0_1 = v0 * unit;
    let v1_1 = v1 * unit;
    let v2_1 = v2 * unit;
    let sides_0 = (p1 - p0) * unit;
    let sides_1 = (p2 - p0) * unit;
    let l0 = Vec3_length(v0_1);
    let l1 = Vec3_length(v1_1);
    let l2 = Vec3_length(v2_1);
    let a = v0_1 * (1.0f / l0);
    let b = v1_1 * (1.0f / l1);
    let c = v2_1 * (1.0f / l2);
    let n = Vec3_cross(sides_0 * (1.0f / l1), sides_1 * (1.0f / l2));
    let nearest = select(v0_1, v1_1, l1 < l0);
    let nearest_1 = select(nearest, v2_1, l2 < real_min(l0, l1));
    let volume = abs(Vec3_dot(nearest_1, n) * (1.0f / l0));
    let one_plus_cos = 0.5f * Vec3_length_squared(a + b);
    let solid_angle = 2.0f * arc_atan2(volume, one_plus_cos + Vec3_dot(c, a + b));
    return SphericalTriangle(v0_1, array<vec3f, 2>(sides_0, sides_1), vec3f(l0, l1, l2), a, b, one_plus_cos, volume, solid_angle);
}

// Where it has a solid angle. Elsewhere all else is meaningless.
fn SphericalTriangle_is_valid(this_: SphericalTriangle) -> bool {
    return (this_.volume > 0.0f) & (this_.solid_angle > 0.0f);
}

// In steradians.
fn SphericalTriangle_solid_angle(this_: SphericalTriangle) -> f32 {
    return this_.solid_angle;
}

// The density of [`sample`](Self::sample) per solid angle.
fn SphericalTriangle_pdf(this_: SphericalTriangle) -> f32 {
    return 1.0f / this_.solid_angle;
}

// A point of the triangle, by its barycentric coordinates at corners 1 and 2.
fn SphericalTriangle_sample(this_: SphericalTriangle, u: vec2f) -> vec2f {
    let parts = this_.distances;
    let l0 = parts.x;
    let l1 = parts.y;
    let l2 = parts.z;
    let side = Line_new(l0, this_.a, this_.sides[1]);
    let parts_1 = sin_cos((0.5f * u.x) * this_.solid_angle);
    let sin_1 = parts_1.v0;
    let cos_1 = parts_1.v1;
    let across = this_.sides[1] - (this_.a * side.along);
    let above = sin_1 * this_.one_plus_cos;
    let below = ((cos_1 * (this_.volume * l2)) - (sin_1 * (Vec3_dot(this_.sides[0], across) / l1))) / side.height;
    let below_1 = real_max(below, 0.0f);
    let t = Line_place(side, (2.0f * above) * below_1, (below_1 - above) * (below_1 + above));
    let line = Line_new(l1, this_.b, (this_.sides[1] * t) - this_.sides[0]);
    let rise = u.y * Line_one_minus_cos(line, 1.0f);
    let sin_2 = sqrt(real_max(rise * (2.0f - rise), 0.0f));
    let s = Line_place(line, sin_2, 1.0f - rise);
    return vec2f(1.0f - s, s * t);
}

// The `u` that [`sample`](Self::sample) sends to a point of the triangle.
fn SphericalTriangle_invert(this_: SphericalTriangle, point: vec2f) -> vec2f {
    let parts = this_.distances;
    let l1 = parts.y;
    let l2 = parts.z;
    let s = real_max(1.0f - point.x, 0.0f);
    let t = real_min(real_max(select(0.0f, point.y / s, s > 0.0f), 0.0f), 1.0f);
    let to_side = this_.to_corner + (this_.sides[1] * t);
    let denominator = (this_.one_plus_cos * Vec3_length(to_side)) + Vec3_dot(to_side, this_.a + this_.b);
    let cut_off = 2.0f * arc_atan2(t * (this_.volume * l2), denominator);
    let line = Line_new(l1, this_.b, (this_.sides[1] * t) - this_.sides[0]);
    let u = vec2f(cut_off / this_.solid_angle, Line_one_minus_cos(line, s) / Line_one_minus_cos(line, 1.0f));
    return vec2f(real_min(real_max(u.x, 0.0f), 1.0f), real_min(real_max(u.y, 0.0f), 1.0f));
}

// A line from a corner, in the plane of the line and the point that it is seen from.
struct Line {
    distance_: f32,
    along: f32,
    height: f32,
}

fn Line_new(distance_1: f32, direction: vec3f, line: vec3f) -> Line {
    let along = Vec3_dot(line, direction);
    return Line(distance_1, along, Vec3_length(line - (direction * along)));
}

// The place in [0, 1] along the line that is seen at an angle from the corner, given by sine
// and cosine up to a common factor.
fn Line_place(this_: Line, sin_1: f32, cos_1: f32) -> f32 {
    let below = real_max((this_.height * cos_1) - (this_.along * sin_1), 1.1754944e-38f);
    return real_min(real_max((this_.distance_ * sin_1) / below, 0.0f), 1.0f);
}

// 1 − cos of the angle from the corner at which a place is seen, without cancellation.
fn Line_one_minus_cos(this_: Line, place_1: f32) -> f32 {
    let x = this_.distance_ + (place_1 * this_.along);
    let y = place_1 * this_.height;
    let distance_1 = sqrt((x * x) + (y * y));
    return select(distance_1 - x, (y * y) / (distance_1 + x), x > 0.0f) / distance_1;
}
