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

// The types of spectra that RGB values become.
const ALBEDO = 0u;
const UNBOUNDED = 1u;
const ILLUMINANT = 2u;

// The spectrum of an RGB value of a colour space, which has no component below 0.
fn rgb_spectrum(space: u32, kind: u32, rgb: vec3f, lambda: SampledWavelengths) -> vec4f {
    var scale = 1.0;
    var color = min(rgb, vec3f(1));
    if (kind != ALBEDO) {
        scale = 2 * max(rgb.x, max(rgb.y, rgb.z));
        color = select(vec3f(), rgb / scale, scale > 0);
    }
    let polynomial = RgbSigmoidPolynomial(uplifted(space, color));
    var values: vec4f;
    for (var i = 0; i < 4; i++) {
        values[i] = RgbSigmoidPolynomial_at(polynomial, lambda.lambda[i]) * scale;
        if (kind == ILLUMINANT) {
            values[i] *= dense_spectrum(tables[space + 4], lambda.lambda[i]);
        }
    }
    return values;
}

const UPLIFT_VALUES = 48u;
const UPLIFT_RATIOS = 42u;

// A cell of nodes, and a position in it.
struct UpliftCell {
    below: u32,
    t: f32,
}

fn ratio_cell(ratios: u32, ratio: f32) -> UpliftCell {
    let position = (sqrt(0.36 + 1.6 * ratio) - 0.6) / 0.8 * f32(UPLIFT_RATIOS - 1);
    let below = u32(clamp(position, 0, f32(UPLIFT_RATIOS - 2)));
    let low = number(ratios + below);
    return UpliftCell(below, (ratio - low) / (number(ratios + below + 1) - low));
}

fn value_coordinate(z: f32) -> f32 {
    return (z - 0.5) / sqrt(z * (1.05 - z));
}

// The coefficients of the reflectance of an RGB value: `RgbToSpectrumTable::polynomial` of
// `spectrum/src/uplift.rs`, whose tables the record of a colour space has.
fn uplifted(space: u32, rgb: vec3f) -> vec3f {
    if (rgb.x == rgb.y && rgb.y == rgb.z) {
        // Finite where the reflectance is 0 or 1.
        return vec3f(0, 0, (rgb.x - 0.5) / sqrt(max(rgb.x * (1 - rgb.x), 1e-30)));
    }
    let nodes = tables[space];
    let values = tables[space + 1];
    let coordinates = tables[space + 2];
    // The largest component comes first, and of equal ones the last.
    let green_leads = rgb.y >= rgb.x;
    let blue_leads = rgb.z >= max(rgb.x, rgb.y);
    let largest = select(select(0u, 1u, green_leads), 2u, blue_leads);
    let turned = select(select(rgb, rgb.yzx, green_leads), rgb.zxy, blue_leads);
    let x = ratio_cell(tables[space + 3], turned.y / turned.x);
    let y = ratio_cell(tables[space + 3], turned.z / turned.x);
    let darkest = number(values);
    let value = max(turned.x, darkest);
    var below = 0u;
    for (var step = 32u; step > 0; step /= 2) {
        below = select(below, below + step, number(values + below + step) <= value);
    }
    below = min(below, UPLIFT_VALUES - 2);
    let low = number(coordinates + below);
    let t = vec3f(x.t, y.t, (value_coordinate(value) - low) / (number(coordinates + below + 1) - low));
    let first = ((largest * UPLIFT_VALUES + below) * UPLIFT_RATIOS + y.below) * UPLIFT_RATIOS + x.below;
    var sum = vec3f();
    for (var corner = 0u; corner < 8; corner++) {
        let offset = vec3u(corner & 1, (corner >> 1) & 1, corner >> 2);
        let weights = select(1 - t, t, offset == vec3u(1));
        let node = first + offset.x + UPLIFT_RATIOS * (offset.y + UPLIFT_RATIOS * offset.z);
        sum += weights.x * weights.y * weights.z * vector(nodes + 4 * node);
    }
    // All wavelengths get darker together.
    if (turned.x < darkest) {
        sum.z *= sqrt(darkest / turned.x);
    }
    return sum;
}
