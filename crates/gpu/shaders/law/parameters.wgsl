// Translated from crates/scattering/src/bxdf/openpbr/parameters.rs
// by `cargo xtask wgsl`, which translates it again.

// What a surface is, at a point and the wavelengths of a path. Weights, colours and roughnesses
// lie in [0, 1], indices are at least 1.
struct OpenPbrParameters {
    base_weight: f32,
    base_color: vec4f,
    base_diffuse_roughness: f32,
    base_metalness: f32,
    specular_weight: f32,
    specular_color: vec4f,
    specular_roughness: f32,
    specular_roughness_anisotropy: f32,
    specular_ior: f32,
    transmission_weight: f32,
    transmission_color: vec4f,
    subsurface_weight: f32,
    subsurface_color: vec4f,
    subsurface_radius: vec4f,
    subsurface_scatter_anisotropy: f32,
    coat_weight: f32,
    coat_color: vec4f,
    coat_roughness: f32,
    coat_roughness_anisotropy: f32,
    coat_ior: f32,
    coat_darkening: f32,
    geometry_coat_normal: vec3f,
    fuzz_weight: f32,
    fuzz_color: vec4f,
    fuzz_roughness: f32,
    thin_film_weight: f32,
    thin_film_thickness: f32,
    thin_film_ior: f32,
    geometry_thin_walled: bool,
}
