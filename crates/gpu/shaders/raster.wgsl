// What all shaders of the raster pipeline share: the camera, the sky and the fog.

@group(0) @binding(0) var<uniform> eye: Eye;
@group(0) @binding(1) var sky: texture_cube<f32>;
@group(0) @binding(2) var smooth_sampler: sampler;

// A sum of spherical harmonics, of which those of degree l are polynomials of degree l in d: d may
// be a mean of directions, and shorter than 1.
fn harmonics(c: array<vec4f, 9>, d: vec3f) -> vec3f {
    let constant = 0.2820948 * c[0];
    let linear = 0.4886025 * (d.y * c[1] + d.z * c[2] + d.x * c[3]);
    let mixed = 1.0925484 * (d.x * d.y * c[4] + d.y * d.z * c[5] + d.x * d.z * c[7]);
    let pure = 0.31539157 * (2.0 * d.z * d.z - d.x * d.x - d.y * d.y) * c[6]
        + 0.5462742 * (d.x * d.x - d.y * d.y) * c[8];
    return max((constant + linear + mixed + pure).rgb, vec3f(0.0));
}

// What a surface of normal n sends out for the shares that it reflects and transmits.
fn diffuse(reflectance: vec3f, transmittance: vec3f, n: vec3f) -> vec3f {
    let light = reflectance * harmonics(eye.irradiance, n) + transmittance * harmonics(eye.irradiance, -n);
    return 0.31830987 * light;
}

// The length of the fog along a unit direction, up to a distance.
fn fog_length(origin: vec3f, d: vec3f, distance: f32) -> f32 {
    if eye.ball.w == 0.0 {
        return distance;
    }
    let to_center = eye.ball.xyz - origin;
    let middle = dot(to_center, d);
    let root = eye.ball.w * eye.ball.w - dot(to_center, to_center) + middle * middle;
    if root < 0.0 {
        return 0.0;
    }
    return clamp(min(distance, middle + sqrt(root)) - max(middle - sqrt(root), 0.0), 0.0, distance);
}

// Light that has come along d from this far away, as it arrives. In a mirror the way begins there.
fn fogged(light: vec3f, d: vec3f, distance: f32) -> vec3f {
    if all(eye.extinction.rgb == vec3f(0.0)) {
        return light;
    }
    var start = 0.0;
    let rise = dot(eye.cut.xyz, d);
    if rise > 0.0 {
        start = min(-(dot(eye.cut.xyz, eye.position.xyz) + eye.cut.w) / rise, distance);
    }
    let length = fog_length(eye.position.xyz + start * d, d, distance - start);
    let passes = exp(-eye.extinction.rgb * length);
    return light * passes + harmonics(eye.glow, d) * (1.0 - passes);
}

// Nearness of a distance, for the mirror: 1 at the camera and 0 at infinity.
fn nearness(distance: f32) -> f32 {
    return 1.0 / (1.0 + distance / eye.position.w);
}

// The share of light that a dielectric of relative index eta reflects.
fn fresnel(cos_theta: f32, eta: f32) -> f32 {
    let c = clamp(cos_theta, 0.0, 1.0);
    let g2 = eta * eta - 1.0 + c * c;
    if g2 < 0.0 {
        return 1.0;
    }
    let g = sqrt(g2);
    let a = (g - c) / (g + c);
    let b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

// A triangle that covers the picture: the position in clip space of its corners.
fn whole_picture(corner: u32) -> vec2f {
    return vec2f(f32(corner & 1u), f32(corner >> 1u)) * 4.0 - 1.0;
}
