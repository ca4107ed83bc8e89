// Translated from crates/geometry/src/shape/sample.rs
// by `cargo xtask wgsl`, which translates it again.

// A point sampled on a shape.
struct ShapeSample {
    p: Point3Error,
    n: vec3f,
    uv: vec2f,
    pdf: f32,
}

// The reference point that a shape is sampled from.
struct ShapeSampleContext {
    p: Point3Error,
    n: vec3f,
    ns: vec3f,
    time: f32,
}

// The ray that leaves along `w`.
fn ShapeSampleContext_spawn_ray(this_: ShapeSampleContext, w: vec3f) -> Ray {
    return Ray_spawn(this_.p, this_.n, w, this_.time);
}

// The density per solid angle of a density per area at `p` with unit normal `n`: times dA/dω =
// d²/|cos θ|; with a normal of another length, divided by that.
fn ShapeSampleContext_pdf_per_solid_angle(this_: ShapeSampleContext, pdf_area: f32, p: vec3f, n: vec3f) -> f32 {
    let toward = p - this_.p.p;
    let scale_1 = balance(Vec3_max_element(abs(toward)));
    let toward_1 = toward * scale_1;
    let distance2 = Vec3_length_squared(toward_1);
    let unit = balance(scale_1);
    return ((pdf_area * unit) * ((distance2 * sqrt(distance2)) / abs(Vec3_dot(n, toward_1)))) * unit;
}

// Weights of the corners of the unit square for bilinear sampling by the cosine at this point,
// given directions to the corners; at least 0.01.
fn ShapeSampleContext_cosine_weights(this_: ShapeSampleContext, corners: array<vec3f, 4>) -> vec4f {
    var weights_1 = vec4f(0.0f, 0.0f, 0.0f, 0.0f);
    for (var i = 0u; i < 4; i++) {
        let w = Vec3_balanced(corners[i]);
        let cosine = abs(Vec3_dot(w, this_.ns) * coarse_inverse_sqrt(Vec3_length_squared(w)));
        weights_1[i] = real_max(cosine, 0.01f);
    }
    return weights_1;
}
