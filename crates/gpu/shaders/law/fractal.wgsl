// Translated from crates/scene/src/texture/fractal.rs
// by `cargo xtask wgsl`, which translates it again.

// A sum of octaves in a texture space.
struct Fractal {
    mapping: u32,
    octaves: u32,
    roughness: f32,
}

const fractal_LACUNARITY: f32 = 1.99f;

const fractal_MEAN: f32 = 0.2f;

// Fractional Brownian motion.
fn fbm(at: TexCoord3d, octaves: u32, roughness: f32) -> f32 {
    let visible = visible_octaves(at, octaves);
    var sum = 0.0f;
    var frequency = 1.0f;
    var amplitude_1 = 1.0f;
    for (var octave = 0u; octave < octaves; octave++) {
        let share_1 = share(visible, octave);
        if (!(share_1 > 0.0f)) {
            break;
        }
        sum += (share_1 * amplitude_1) * noise(at.p * frequency);
        frequency *= fractal_LACUNARITY;
        amplitude_1 *= roughness;
    }
    return sum;
}

// Turbulence.
fn turbulence(at: TexCoord3d, octaves: u32, roughness: f32) -> f32 {
    let visible = visible_octaves(at, octaves);
    var sum = 0.0f;
    var frequency = 1.0f;
    var amplitude_1 = 1.0f;
    for (var octave = 0u; octave <= octaves; octave++) {
        let share_1 = share(visible, octave);
        var value_1 = fractal_MEAN;
        if (share_1 > 0.0f) {
            let magnitude = abs(noise(at.p * frequency));
            value_1 = (fractal_MEAN * (1.0f - share_1)) + (magnitude * share_1);
        }
        let is_counted_again = floor(visible) == f32(octave);
        let again = select(0.0f, fractal_MEAN, is_counted_again);
        var chosen: f32;
        if (octave < octaves) {
            chosen = value_1 + again;
        } else {
            chosen = again;
        }
        sum += amplitude_1 * chosen;
        frequency *= fractal_LACUNARITY;
        amplitude_1 *= roughness;
    }
    return sum;
}

// Waves in the wind.
fn windy(at: TexCoord3d) -> f32 {
    var product_1 = 1.0f;
    {
        product_1 = abs(product_1) * fbm(TexCoord3d_scaled(at, 0.1f), 3, 0.5f);
    }
    {
        product_1 = abs(product_1) * fbm(TexCoord3d_scaled(at, 1.0f), 6, 0.5f);
    }
    return product_1;
}

// How many octaves a pixel can show, of those that are asked for.
fn visible_octaves(at: TexCoord3d, octaves: u32) -> f32 {
    let squared = real_max(Vec3_length_squared(at.dpdx), Vec3_length_squared(at.dpdy));
    let visible = -1.0f - (0.5f * logarithm_log2(squared));
    return real_min(real_max(visible, 0.0f), f32(octaves));
}

// The share of an octave that is seen where so many are visible: 1 up to that many, a smooth step
// for the last.
fn share(visible: f32, octave: u32) -> f32 {
    let rest = visible - f32(octave);
    let t = real_min(real_max((rest - 0.3f) / 0.4f, 0.0f), 1.0f);
    return (t * t) * (3.0f - (2.0f * t));
}
