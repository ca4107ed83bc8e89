// Translated from crates/geometry/src/flat_shape.rs
// by `cargo xtask wgsl`, which translates it again.

// Triangles and rectangles, one for each lane.
struct FlatShape {
    corner: vec3f,
    sides: array<vec3f, 2>,
    n: vec3f,
    is_triangle: bool,
}

// Points by solid angle and by the cosine at a reference point, with their densities per solid
// angle, and the lanes that have one: none sees its primitive edge-on. `uv` of a point are the
// parts of the sides that lead to it.
fn FlatShape_sample_from(this_: FlatShape, reference: ShapeSampleContext, u: vec2f) -> Tuple_ShapeSample_bool {
    var uv = u;
    var pdf = 0.0f;
    var is_seen = false;
    if (this_.is_triangle) {
        let seen = FlatShape_triangle(this_, reference);
        let parts = SeenTriangle_sample(seen, u);
        let point = parts.v0;
        let density = parts.v1;
        is_seen = this_.is_triangle & SeenTriangle_is_valid(seen);
        uv = select(uv, point, is_seen);
        pdf = select(pdf, density, is_seen);
    }
    if (!this_.is_triangle) {
        let seen_1 = FlatShape_rectangle(this_, reference);
        let parts_1 = SeenRectangle_sample(seen_1, u);
        let point_1 = parts_1.v0;
        let density_1 = parts_1.v1;
        let is_rectangle = SeenRectangle_is_valid(seen_1) & !this_.is_triangle;
        uv = select(uv, point_1, is_rectangle);
        pdf = select(pdf, density_1, is_rectangle);
        is_seen = is_seen | is_rectangle;
    }
    if (!is_seen) {
        let parts_2 = sample_uniform_triangle(u);
        let b1 = parts_2.y;
        let b2 = parts_2.z;
        uv = select(uv, vec2f(b1, b2), this_.is_triangle & !is_seen);
    }
    let p = FlatShape_point(this_, uv);
    if (!is_seen) {
        pdf = select(FlatShape_pdf_by_area(this_, reference, p.p), pdf, is_seen);
    }
    let valid = (pdf > 0.0f) & (pdf < infinity());
    return Tuple_ShapeSample_bool(ShapeSample(p, this_.n, uv, pdf), valid);
}

// The densities per solid angle of [`sample_from`](Self::sample_from) towards points of the
// primitives, which are given by the parts of the sides that lead to them; 0 where they are
// seen edge-on.
fn FlatShape_pdf_from(this_: FlatShape, reference: ShapeSampleContext, uv: vec2f) -> f32 {
    var pdf = 0.0f;
    var is_seen = false;
    if (this_.is_triangle) {
        let seen = FlatShape_triangle(this_, reference);
        is_seen = this_.is_triangle & SeenTriangle_is_valid(seen);
        pdf = select(pdf, SeenTriangle_pdf(seen, uv), is_seen);
    }
    if (!this_.is_triangle) {
        let seen_1 = FlatShape_rectangle(this_, reference);
        let is_rectangle = SeenRectangle_is_valid(seen_1) & !this_.is_triangle;
        pdf = select(pdf, SeenRectangle_pdf(seen_1, FlatShape_point(this_, uv).p), is_rectangle);
        is_seen = is_seen | is_rectangle;
    }
    if (!is_seen) {
        pdf = select(FlatShape_pdf_by_area(this_, reference, FlatShape_point(this_, uv).p), pdf, is_seen);
    }
    return select(0.0f, pdf, pdf < infinity());
}

fn FlatShape_triangle(this_: FlatShape, reference: ShapeSampleContext) -> SeenTriangle {
    let parts = this_.sides;
    let right = parts[0];
    let up = parts[1];
    return SeenTriangle_new(array<vec3f, 3>(this_.corner, this_.corner + right, this_.corner + up), reference);
}

fn FlatShape_rectangle(this_: FlatShape, reference: ShapeSampleContext) -> SeenRectangle {
    return SeenRectangle_new(this_.corner, this_.sides, reference);
}

fn FlatShape_pdf_by_area(this_: FlatShape, reference: ShapeSampleContext, p: vec3f) -> f32 {
    let cross_1 = Vec3_cross(this_.sides[0], this_.sides[1]);
    let n = cross_1 * select(1.0f, 0.5f, this_.is_triangle);
    return ShapeSampleContext_pdf_per_solid_angle(reference, 1.0f, p, n);
}

fn FlatShape_point(this_: FlatShape, uv: vec2f) -> Point3Error {
    let x = this_.sides[0] * uv.x;
    let y = this_.sides[1] * uv.y;
    let error = ((abs(this_.corner) + abs(x)) + abs(y)) * gamma(4);
    return Point3Error_new((this_.corner + x) + y, error);
}

// A triangle as seen from a point, for each lane.
struct SeenTriangle {
    seen: SphericalTriangle,
    weights: vec4f,
}

fn SeenTriangle_new(corners: array<vec3f, 3>, reference: ShapeSampleContext) -> SeenTriangle {
    let p = reference.p.p;
    let w0 = corners[0] - p;
    let w1 = corners[1] - p;
    let w2 = corners[2] - p;
    let weights_1 = ShapeSampleContext_cosine_weights(reference, array<vec3f, 4>(w1, w1, w0, w2));
    return SeenTriangle(SphericalTriangle_new(corners, p), weights_1);
}

// Where it is sampled by solid angle.
fn SeenTriangle_is_valid(this_: SeenTriangle) -> bool {
    let solid_angle = SphericalTriangle_solid_angle(this_.seen);
    return (SphericalTriangle_is_valid(this_.seen) & (solid_angle >= 3e-4f)) & (solid_angle <= 6.22f);
}

// Barycentric coordinates at corners 1 and 2, with their density per solid angle.
fn SeenTriangle_sample(this_: SeenTriangle, u: vec2f) -> Tuple_Vec2_f32 {
    let u_1 = sample_bilinear(u, this_.weights);
    return Tuple_Vec2_f32(SphericalTriangle_sample(this_.seen, u_1), bilinear_pdf(u_1, this_.weights) * SphericalTriangle_pdf(this_.seen));
}

// The density of [`sample`](Self::sample) at a point given by barycentric coordinates.
fn SeenTriangle_pdf(this_: SeenTriangle, point: vec2f) -> f32 {
    return bilinear_pdf(SphericalTriangle_invert(this_.seen, point), this_.weights) * SphericalTriangle_pdf(this_.seen);
}

// A rectangle as seen from a point, for each lane.
struct SeenRectangle {
    seen: SphericalRectangle,
    weights: vec4f,
}

fn SeenRectangle_new(corner: vec3f, sides: array<vec3f, 2>, reference: ShapeSampleContext) -> SeenRectangle {
    let right = sides[0];
    let up = sides[1];
    let w = corner - reference.p.p;
    return SeenRectangle(SphericalRectangle_new(reference.p.p, corner, right, up), ShapeSampleContext_cosine_weights(reference, array<vec3f, 4>(w, w + right, w + up, (w + right) + up)));
}

// Where it is sampled by solid angle.
fn SeenRectangle_is_valid(this_: SeenRectangle) -> bool {
    return SphericalRectangle_is_valid(this_.seen) & (SphericalRectangle_solid_angle(this_.seen) > 1e-2f);
}

// The parts of the sides, with their density per solid angle.
fn SeenRectangle_sample(this_: SeenRectangle, u: vec2f) -> Tuple_Vec2_f32 {
    let u_1 = sample_bilinear(u, this_.weights);
    return Tuple_Vec2_f32(SphericalRectangle_sample(this_.seen, u_1), bilinear_pdf(u_1, this_.weights) * SphericalRectangle_pdf(this_.seen));
}

// The density of [`sample`](Self::sample) at a point.
fn SeenRectangle_pdf(this_: SeenRectangle, point: vec3f) -> f32 {
    return bilinear_pdf(SphericalRectangle_invert(this_.seen, point), this_.weights) * SphericalRectangle_pdf(this_.seen);
}
