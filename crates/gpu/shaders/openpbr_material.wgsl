// Principled surfaces at a point: the records of `src/flatten/openpbr.rs`.

// The most textures of a material.
const MOST_TEXTURES = 31u;

// In place of the number of a texture that is not seen.
const NO_TEXTURE = 0xffffffffu;

// The normal of the coat in the shading frame of the base; that of the base where it would be
// below.
fn coat_normal(at: u32, uv: vec2f) -> vec3f {
    var normals = array(vec3f(0, 0, 1), vec3f(0, 0, 1));
    let images = words_at(at + 8).zw;
    for (var i = 0u; i < 2; i++) {
        if (images[i] != 0) {
            normals[i] = mapped_normal(images[i], uv);
        }
    }
    let normal = Frame_to_local(Frame_from_z_and_x(normals[1], vec3f(1, 0, 0)), normals[0]);
    return select(vec3f(0, 0, 1), normal, normal.z > 0);
}

// The surface of a record at a point, given what its textures are there. Where it disperses, the
// secondary wavelengths are terminated.
fn openpbr_at(
    at: u32,
    textures: array<vec4f, MOST_TEXTURES>,
    uv: vec2f,
    lambda: ptr<function, SampledWavelengths>,
) -> OpenPbr {
    let head = words_at(at);
    var values = textures;
    var colors: array<vec4f, 6>;
    for (var i = 0u; i < 6; i++) {
        let texture = word(at + 4 + i);
        colors[i] = vec4f(1);
        if (texture != NO_TEXTURE) {
            colors[i] = clamp(values[texture], vec4f(), vec4f(1));
        }
    }
    var n: array<f32, 24>;
    for (var i = 0u; i < 6; i++) {
        let four = numbers_at(at + 12 + 4 * i);
        for (var j = 0u; j < 4; j++) {
            n[4 * i + j] = four[j];
        }
    }
    for (var i = 0u; i < head.z; i++) {
        let own = words_at(at + 36 + 4 * i);
        n[own.x] = clamp(values[i].x, bitcast<f32>(own.y), bitcast<f32>(own.z));
    }
    let is_thin = head.x == 1;
    var radius = vec4f();
    if (head.w != NO_TEXTURE && n[11] > 0 && n[12] > 0) {
        radius = clamp(values[head.w], vec4f(), vec4f(1)) * n[12];
    }
    if (!is_thin && n[8] > 0) {
        // The medium inside absorbs instead of the boundary.
        colors[2] = vec4f(1);
    }
    var coat_normal_here = vec3f(0, 0, 1);
    let images = words_at(at + 8).zw;
    if ((images.x | images.y) != 0 && n[14] > 0) {
        coat_normal_here = coat_normal(at, uv);
    }
    if (!is_thin && n[7] > 0 && n[9] > 0) {
        n[6] = real_max(cauchy(n[6], n[10] / n[9], (*lambda).lambda.x), 1);
        SampledWavelengths_terminate_secondary(lambda);
    }
    let p = OpenPbrParameters(
        n[0], colors[0], n[1], n[2], n[3], colors[1], n[4], n[5], n[6], n[7], colors[2],
        n[11], colors[3], radius, n[13], n[14], colors[4], n[15], n[16], n[17], n[18], coat_normal_here,
        n[19], colors[5], n[20], n[21], n[22], n[23], is_thin,
    );
    return OpenPbr_new(head.y, p, *lambda);
}

// The medium under a surface, if paths are followed there: extinction, albedo, and mean cosine.
fn openpbr_extinction(surface: OpenPbr) -> vec4f {
    return surface.interior.sigma_t;
}

fn openpbr_albedo(surface: OpenPbr) -> vec4f {
    return surface.interior.sigma_s / surface.interior.sigma_t;
}

fn openpbr_asymmetry(surface: OpenPbr) -> f32 {
    return surface.interior.phase.g;
}

// The surface without what is scattered under it, where paths enter.
fn boundary_part(surface: OpenPbr) -> OpenPbr {
    var part = surface;
    if (!is_black(surface.interior.sigma_t)) {
        part.part = Part_Boundary;
    }
    return part;
}

// The lobe by which light has entered that is scattered under the surface, from above.
fn entering_part(surface: OpenPbr) -> OpenPbr {
    var part = surface;
    part.part = Part_Entering;
    return part;
}
