// Translated from crates/scene/src/footprint.rs
// by `cargo xtask wgsl`, which translates it again.

// Derivatives of the surface point by film position, in pixels, for each lane.
struct Footprint {
    dpdx: vec3f,
    dpdy: vec3f,
    dudx: f32,
    dudy: f32,
    dvdx: f32,
    dvdy: f32,
}

// That of ∂p/∂x and ∂p/∂y, where the surface has the tangents ∂p/∂u and ∂p/∂v.
fn Footprint_new(argument_0: array<vec3f, 2>, argument_1: array<vec3f, 2>) -> Footprint {
    let dpdx = argument_0[0];
    let dpdy = argument_0[1];
    let dpdu = argument_1[0];
    let dpdv = argument_1[1];
    let scale_u = balance(Vec3_max_element(abs(dpdu)));
    let scale_v = balance(Vec3_max_element(abs(dpdv)));
    let dpdu_1 = dpdu * scale_u;
    let dpdv_1 = dpdv * scale_v;
    let a = Vec3_dot(dpdu_1, dpdu_1);
    let b = Vec3_dot(dpdu_1, dpdv_1);
    let c = Vec3_dot(dpdv_1, dpdv_1);
    let inverse = or_zero(1.0f / difference_of_products(a, c, b, b));
    let x = Vec3_dot(dpdu_1, dpdx);
    let y = Vec3_dot(dpdv_1, dpdx);
    let dudx = bounded((difference_of_products(c, x, b, y) * inverse) * scale_u);
    let dvdx = bounded((difference_of_products(a, y, b, x) * inverse) * scale_v);
    let x_1 = Vec3_dot(dpdu_1, dpdy);
    let y_1 = Vec3_dot(dpdv_1, dpdy);
    let dudy = bounded((difference_of_products(c, x_1, b, y_1) * inverse) * scale_u);
    let dvdy = bounded((difference_of_products(a, y_1, b, x_1) * inverse) * scale_v);
    return Footprint(dpdx, dpdy, dudx, dudy, dvdx, dvdy);
}

fn bounded(x: f32) -> f32 {
    return real_min(real_max(or_zero(x), -1e8f), 1e8f);
}

// Zero for infinities and NaN.
fn or_zero(x: f32) -> f32 {
    return select(0.0f, x, abs(x) <= 3.4028234e38f);
}

// From `p` to the point of a ray on the plane through `p` with normal `n`, where there is one.
fn on_plane(o: vec3f, d: vec3f, p: vec3f, n: vec3f) -> Tuple_Vec3_bool {
    let t = Vec3_dot(n, p - o) / Vec3_dot(n, d);
    return Tuple_Vec3_bool((o + (d * t)) - p, abs(t) <= 3.4028234e38f);
}
