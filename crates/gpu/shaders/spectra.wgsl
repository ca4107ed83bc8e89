// Spectra: the records of `src/flatten/spectra.rs`.

// The value of a spectrum at a wavelength in nanometres.
fn spectrum_at(at: u32, lambda: f32) -> f32 {
    return spectrum_of(at, words_at(at), lambda);
}

// The same, given the first words of the spectrum.
fn spectrum_of(at: u32, head: vec4u, lambda: f32) -> f32 {
    let scale = bitcast<f32>(head.y);
    switch (head.x) {
        case SpectrumTag_Constant: { return scale; }
        case SpectrumTag_Linear: { return linear_spectrum(at, head.y, lambda); }
        case SpectrumTag_Dense: { return dense_spectrum(at, lambda); }
        default: {}
    }
    let value = scale * RgbSigmoidPolynomial_at(RgbSigmoidPolynomial(vector(at + 4)), lambda);
    if (head.x == SpectrumTag_Rgb) {
        return value;
    }
    return value * dense_spectrum(head.z, lambda);
}

// Linear between so many wavelengths, and 0 beyond them.
fn linear_spectrum(at: u32, count: u32, lambda: f32) -> f32 {
    // The last wavelength that is at most `lambda`.
    var below = 0u;
    var above = count;
    while (above - below > 1) {
        let middle = (below + above) / 2;
        if (number(at + 4 + 4 * middle) <= lambda) {
            below = middle;
        } else {
            above = middle;
        }
    }
    // A wavelength and its value, and the next ones; the last has none but itself.
    let pair = numbers_at(at + 4 + 4 * below);
    if (!(lambda >= pair.x) || (below + 1 == count && lambda > pair.x)) {
        return 0;
    }
    if (below + 1 == count) {
        return pair.y;
    }
    return pair.y + (pair.w - pair.y) / (pair.z - pair.x) * (lambda - pair.x);
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
    let head = words_at(at);
    if (head.x == SpectrumTag_Constant) {
        return vec4f(bitcast<f32>(head.y));
    }
    var values: vec4f;
    for (var i = 0; i < 4; i++) {
        values[i] = spectrum_of(at, head, lambda.lambda[i]);
    }
    return values;
}

// The spectrum of an RGB value of a colour space, which has no component below 0.
fn rgb_spectrum(space: u32, kind: u32, rgb: vec3f, lambda: SampledWavelengths) -> vec4f {
    var scale = 1.0;
    var color = min(rgb, vec3f(1));
    if (kind != SpectrumTypeTag_Albedo) {
        scale = 2 * max(rgb.x, max(rgb.y, rgb.z));
        color = select(vec3f(), rgb / scale, scale > 0);
    }
    let polynomial = RgbSigmoidPolynomial(uplifted(space, color));
    var values: vec4f;
    for (var i = 0; i < 4; i++) {
        values[i] = RgbSigmoidPolynomial_at(polynomial, lambda.lambda[i]) * scale;
        if (kind == SpectrumTypeTag_Illuminant) {
            values[i] *= dense_spectrum(word(space + 4), lambda.lambda[i]);
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
    let offsets = words_at(space);
    let nodes = offsets.x;
    let values = offsets.y;
    let coordinates = offsets.z;
    // The largest component comes first, and of equal ones the last.
    let green_leads = rgb.y >= rgb.x;
    let blue_leads = rgb.z >= max(rgb.x, rgb.y);
    let largest = select(select(0u, 1u, green_leads), 2u, blue_leads);
    let turned = select(select(rgb, rgb.yzx, green_leads), rgb.zxy, blue_leads);
    let x = ratio_cell(offsets.w, turned.y / turned.x);
    let y = ratio_cell(offsets.w, turned.z / turned.x);
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
