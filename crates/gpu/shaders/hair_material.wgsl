// Hair: what the records of `src/flatten/materials.rs` become at a point. `Hair` is a law.

// Absorption by a unit of eumelanin and of pheomelanin (`scene/src/material/hair.rs`).
const EUMELANIN = vec3f(0.419, 0.697, 1.37);
const PHEOMELANIN = vec3f(0.187, 0.4, 1.05);

// A fibre at a point, given what its absorption is given by and the values of its textures.
fn hair_at(given: vec2u, values: array<vec4f, MOST_TEXTURES>, v: f32, lambda: SampledWavelengths) -> Hair {
    let roughness = clamp(vec2f(values[0].x, values[1].x), vec2f(0.01), vec2f(1));
    var sigma_a = max(values[4], vec4f());
    if (given.x == AbsorptionTag_Color) {
        sigma_a = Hair_sigma_a_from_reflectance(clamp(values[4], vec4f(), vec4f(1)), roughness.y);
    } else if (given.x == AbsorptionTag_Pigments) {
        let rgb = EUMELANIN * max(values[4].x, 0) + PHEOMELANIN * max(values[5].x, 0);
        sigma_a = rgb_spectrum(given.y, SpectrumTypeTag_Unbounded, rgb, lambda);
    }
    return Hair_new(2 * v - 1, max(values[2].x, 0.01), sigma_a, roughness, values[3].x);
}
