// In place of principled surfaces in kernels of scenes that have none.

const MOST_TEXTURES = 9u;

struct OpenPbr {
    unused: u32,
}

fn openpbr_at(
    at: u32,
    textures: array<vec4f, MOST_TEXTURES>,
    uv: vec2f,
    lambda: ptr<function, SampledWavelengths>,
) -> OpenPbr {
    return OpenPbr();
}

fn openpbr_extinction(surface: OpenPbr) -> vec4f {
    return vec4f();
}

fn openpbr_albedo(surface: OpenPbr) -> vec4f {
    return vec4f();
}

fn openpbr_asymmetry(surface: OpenPbr) -> f32 {
    return 0;
}

fn boundary_part(surface: OpenPbr) -> OpenPbr {
    return surface;
}

fn entering_part(surface: OpenPbr) -> OpenPbr {
    return surface;
}

fn OpenPbr_regularize(surface: ptr<function, OpenPbr>, mask: bool) {
}
