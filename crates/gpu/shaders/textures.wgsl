// Textures: the records of `src/flatten/textures.rs`.

const TEXTURE_NUMBER = 0u;
const TEXTURE_SPECTRUM = 1u;

const CODE_NUMBER = 0u;
const CODE_SPECTRUM = 1u;
const CODE_SQUARES = 2u;
const CODE_CUBES = 3u;
const CODE_FACING = 4u;
const CODE_STEP = 5u;
const CODE_SCALE = 6u;
const CODE_MIX = 7u;

// What textures depend on.
struct TextureContext {
    p: vec3f,
    n: vec3f,
    uv: vec2f,
    footprint: Footprint,
}

// A spectrum, or a number four times.
fn texture(at: u32, context: TextureContext, lambda: SampledWavelengths) -> vec4f {
    if (tables[at] == TEXTURE_NUMBER) {
        return vec4f(number(at + 1));
    }
    if (tables[at] == TEXTURE_SPECTRUM) {
        return spectrum(tables[at + 1], lambda);
    }
    var slots: array<vec4f, 32>;
    for (var i = 0u; i < tables[at + 1]; i++) {
        let operation = at + 2 + 4 * i;
        let operands = tables[operation + 2];
        let a = slots[operands & 255];
        let b = slots[operands >> 8 & 255];
        let c = slots[operands >> 16 & 255];
        let argument = operation + 3;
        var value: vec4f;
        switch (tables[operation]) {
            case CODE_NUMBER: { value = vec4f(number(argument)); }
            case CODE_SPECTRUM: { value = spectrum(tables[argument], lambda); }
            case CODE_SQUARES: { value = vec4f(squares(on_texture(tables[argument], context))); }
            case CODE_CUBES: { value = vec4f(cubes(in_texture(tables[argument], context))); }
            case CODE_FACING: { value = vec4f(abs(dot(context.n, vector(tables[argument])))); }
            case CODE_STEP: { value = vec4f(select(0.0, 1.0, a.x >= number(argument))); }
            case CODE_SCALE: { value = a * b.x; }
            case CODE_MIX: {
                let mixed = a * (1 - c.x) + b * c.x;
                value = select(select(mixed, b, c.x == 1), a, c.x == 0);
            }
            default: {
                let w = weights(on_texture(tables[argument], context).st);
                value = a * w.x + b * w.y + c * w.z + slots[operands >> 24] * w.w;
            }
        }
        slots[tables[operation + 1]] = value;
    }
    return slots[0];
}

// The point on the plane of a texture.
fn on_texture(at: u32, context: TextureContext) -> TexCoord2d {
    let u = vec2f(number(at), number(at + 1));
    let v = vec2f(number(at + 2), number(at + 3));
    let delta = vec2f(number(at + 4), number(at + 5));
    let footprint = context.footprint;
    return TexCoord2d(
        u * context.uv.x + v * context.uv.y + delta,
        u * footprint.dudx + v * footprint.dvdx,
        u * footprint.dudy + v * footprint.dvdy,
    );
}

// The point in the space of a texture.
fn in_texture(at: u32, context: TextureContext) -> TexCoord3d {
    let m = Rows(vector(at), vector(at + 4), vector(at + 8));
    let translation = vec3f(number(at + 3), number(at + 7), number(at + 11));
    return TexCoord3d(
        times(m, context.p) + translation, times(m, context.footprint.dpdx), times(m, context.footprint.dpdy),
    );
}
