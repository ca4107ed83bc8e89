// Translated from crates/scattering/src/microfacet.rs
// by `cargo xtask wgsl`, which translates it again.

// The Trowbridge–Reitz distribution of microfacet normals.
struct TrowbridgeReitz {
    alpha_x: f32,
    alpha_y: f32,
}

// The roughnesses α along x and y of the local frame, each ≥ 0. Unless both are so small that
// the surface counts as [smooth](Self::effectively_smooth), neither is let below 0.0001.
fn TrowbridgeReitz_new(alpha_x: f32, alpha_y: f32) -> TrowbridgeReitz {
    let smooth_1 = TrowbridgeReitz_effectively_smooth(TrowbridgeReitz(alpha_x, alpha_y));
    let alpha_x_1 = select(real_max(alpha_x, 1e-4f), alpha_x, smooth_1);
    let alpha_y_1 = select(real_max(alpha_y, 1e-4f), alpha_y, smooth_1);
    return TrowbridgeReitz(alpha_x_1, alpha_y_1);
}

// The α of a perceptually uniform roughness in [0, 1]: its square root.
fn TrowbridgeReitz_roughness_to_alpha(roughness: f32) -> f32 {
    return sqrt(roughness);
}

// Whether the surface is to be treated as a perfect mirror: both α below 0.001.
fn TrowbridgeReitz_effectively_smooth(this_: TrowbridgeReitz) -> bool {
    return real_max(this_.alpha_x, this_.alpha_y) < 1e-3f;
}

// D: the area of microfacets with normal `wm`, per solid angle and area of surface.
fn TrowbridgeReitz_d(this_: TrowbridgeReitz, wm: vec3f) -> f32 {
    let stretch = (sqr(wm.x / this_.alpha_x) + sqr(wm.y / this_.alpha_y)) + sqr(wm.z);
    return 1.0f / (((3.1415927f * this_.alpha_x) * this_.alpha_y) * sqr(stretch));
}

// Λ: microfacet area invisible from `w` (back-facing or masked) over the area visible.
fn TrowbridgeReitz_lambda(this_: TrowbridgeReitz, w: vec3f) -> f32 {
    let alpha2_tan2 = (sqr(w.x * this_.alpha_x) + sqr(w.y * this_.alpha_y)) / sqr(w.z);
    return (sqrt(1.0f + alpha2_tan2) - 1.0f) * 0.5f;
}

// G₁: the fraction of the microfacets facing `w` that are visible from it.
fn TrowbridgeReitz_g1(this_: TrowbridgeReitz, w: vec3f) -> f32 {
    return 1.0f / (1.0f + TrowbridgeReitz_lambda(this_, w));
}

// G: the fraction of microfacets visible from both directions, height-correlated.
fn TrowbridgeReitz_g(this_: TrowbridgeReitz, wo: vec3f, wi: vec3f) -> f32 {
    return 1.0f / ((1.0f + TrowbridgeReitz_lambda(this_, wo)) + TrowbridgeReitz_lambda(this_, wi));
}

// D_w: the density per solid angle of the normal `wm` among those that `w`, off the horizon,
// sees.
fn TrowbridgeReitz_d_visible(this_: TrowbridgeReitz, w: vec3f, wm: vec3f) -> f32 {
    return ((TrowbridgeReitz_g1(this_, w) / abs(w.z)) * TrowbridgeReitz_d(this_, wm)) * abs(Vec3_dot(w, wm));
}

// A normal in the upper hemisphere with the density of [`Self::pdf`].
fn TrowbridgeReitz_sample_wm(this_: TrowbridgeReitz, w: vec3f, u: vec2f) -> vec3f {
    let stretched = Vec3_normalize(vec3f(this_.alpha_x * w.x, this_.alpha_y * w.y, w.z));
    let wh = select(stretched, -stretched, stretched.z < 0.0f);
    let across = Vec3_normalize(vec3f(-wh.y, wh.x, 0.0f));
    let t1 = select(Vec3_X, across, wh.z < 0.99999f);
    let t2 = Vec3_cross(wh, t1);
    let parts = sample_uniform_disk_polar(u);
    let x = parts.x;
    let y = parts.y;
    let y_1 = lerp((1.0f + wh.z) * 0.5f, safe_sqrt(1.0f - (x * x)), y);
    let nh = ((t1 * x) + (t2 * y_1)) + (wh * safe_sqrt((1.0f - (x * x)) - (y_1 * y_1)));
    return Vec3_normalize(vec3f(this_.alpha_x * nh.x, this_.alpha_y * nh.y, real_max(nh.z, 1e-6f)));
}

// The density of [`Self::sample_wm`]: [`Self::d_visible`].
fn TrowbridgeReitz_pdf(this_: TrowbridgeReitz, w: vec3f, wm: vec3f) -> f32 {
    return TrowbridgeReitz_d_visible(this_, w, wm);
}

// The distribution whose α are `scale` times as large.
fn TrowbridgeReitz_scaled(this_: TrowbridgeReitz, scale_1: f32) -> TrowbridgeReitz {
    return TrowbridgeReitz_new(this_.alpha_x * scale_1, this_.alpha_y * scale_1);
}

// √(α_x α_y).
fn TrowbridgeReitz_mean_alpha(this_: TrowbridgeReitz) -> f32 {
    return sqrt(this_.alpha_x * this_.alpha_y);
}

// The distribution whose α² are larger by `scale` times those of `by`.
fn TrowbridgeReitz_widened(this_: TrowbridgeReitz, by: TrowbridgeReitz, scale_1: f32) -> TrowbridgeReitz {
    let alpha_x = sqrt(sqr(this_.alpha_x) + (scale_1 * sqr(by.alpha_x)));
    let alpha_y = sqrt(sqr(this_.alpha_y) + (scale_1 * sqr(by.alpha_y)));
    return TrowbridgeReitz_new(alpha_x, alpha_y);
}

// Roughens nearly smooth surfaces where the mask is true, so that paths with small probability
// are found: α below 0.3 is doubled, clamped to [0.1, 0.3].
fn TrowbridgeReitz_regularize(this_: ptr<function, TrowbridgeReitz>, mask: bool) {
    {
        let rough = real_min(real_max(2.0f * (*this_).alpha_x, 0.1f), 0.3f);
        (*this_).alpha_x = select((*this_).alpha_x, rough, mask & ((*this_).alpha_x < 0.3f));
    }
    {
        let rough_1 = real_min(real_max(2.0f * (*this_).alpha_y, 0.1f), 0.3f);
        (*this_).alpha_y = select((*this_).alpha_y, rough_1, mask & ((*this_).alpha_y < 0.3f));
    }
}
