// Spectra: the records of `src/flatten/spectra.rs`.

const SPECTRUM_CONSTANT = 0u;
const SPECTRUM_LINEAR = 1u;
const SPECTRUM_DENSE = 2u;

// The value of a spectrum at a wavelength in nanometres.
fn spectrum_at(at: u32, lambda: f32) -> f32 {
    switch (tables[at]) {
        case SPECTRUM_CONSTANT: { return number(at + 1); }
        case SPECTRUM_LINEAR: { return linear_spectrum(at, lambda); }
        case SPECTRUM_DENSE: { return dense_spectrum(at, lambda); }
        default: {}
    }
    let value = number(at + 1) * RgbSigmoidPolynomial_at(RgbSigmoidPolynomial(vector(at + 2)), lambda);
    if (tables[at] == 3) {
        return value;
    }
    return value * dense_spectrum(tables[at + 5], lambda);
}

// Linear between wavelengths, and 0 beyond them.
fn linear_spectrum(at: u32, lambda: f32) -> f32 {
    let count = tables[at + 1];
    let wavelengths = at + 2;
    if (!(lambda >= number(wavelengths) && lambda <= number(wavelengths + count - 1))) {
        return 0;
    }
    // The last wavelength that is at most `lambda`.
    var below = 0u;
    var above = count;
    while (above - below > 1) {
        let middle = (below + above) / 2;
        if (number(wavelengths + middle) <= lambda) {
            below = middle;
        } else {
            above = middle;
        }
    }
    let values = wavelengths + count;
    let value = number(values + below);
    if (below + 1 == count) {
        return value;
    }
    let from_ = number(wavelengths + below);
    let slope = (number(values + below + 1) - value) / (number(wavelengths + below + 1) - from_);
    return value + slope * (lambda - from_);
}

// The value at the nearest of 471 nanometres.
fn dense_spectrum(at: u32, lambda: f32) -> f32 {
    let offset = lambda - 359.5;
    if (!(offset >= 0 && offset < 471)) {
        return 0;
    }
    return number(at + 1 + u32(offset));
}

fn spectrum(at: u32, lambda: SampledWavelengths) -> vec4f {
    if (tables[at] == SPECTRUM_CONSTANT) {
        return vec4f(number(at + 1));
    }
    var values: vec4f;
    for (var i = 0; i < 4; i++) {
        values[i] = spectrum_at(at, lambda.lambda[i]);
    }
    return values;
}
