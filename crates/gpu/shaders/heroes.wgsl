// The wavelength that chooses how far paths fly, as `integrators/src/transport/media/` has it.

// The wavelength that chooses, and the probability of each to be it.
struct Heroes {
    probabilities: vec4f,
    hero: u32,
}

// The mean of densities over the wavelengths that could have chosen a path.
fn mean_of(heroes: Heroes, densities: vec4f) -> f32 {
    return dot(densities, heroes.probabilities);
}

// exp(−σ·d).
fn attenuation(sigma: vec4f, distance: f32) -> vec4f {
    var passed: vec4f;
    for (var i = 0; i < 4; i++) {
        passed[i] = exponential_exp(-sigma[i] * distance);
    }
    return passed;
}
