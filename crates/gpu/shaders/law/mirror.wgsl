// Translated from crates/scattering/src/bxdf/openpbr/mirror.rs
// by `cargo xtask wgsl`, which translates it again.

// The facets that mirror one direction into another. All is zero where the surface is smooth.
struct Mirror {
    f: f32,
    pdf: f32,
    cosine: f32,
}

// The facets of a surface for two directions.
fn Mirror_new(facets: TrowbridgeReitz, wo: vec3f, wi: vec3f) -> Mirror {
    let parts = Vec3_normalize_masked(wo + wi);
    let wm = parts.v0;
    let is_found = parts.v1;
    let is_found_1 = is_found & !TrowbridgeReitz_effectively_smooth(facets);
    let quarter = (0.25f * TrowbridgeReitz_d(facets, wm)) / wo.z;
    let visible = 1.0f + TrowbridgeReitz_lambda(facets, wo);
    let f = quarter / (wi.z * (visible + TrowbridgeReitz_lambda(facets, wi)));
    return Mirror(select(0.0f, f, is_found_1), select(0.0f, quarter / visible, is_found_1), select(0.0f, Vec3_dot(wo, wm), is_found_1));
}
