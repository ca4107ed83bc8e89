// Textures: the records of `src/flatten/textures.rs`.

// What textures depend on.
struct TextureContext {
    p: vec3f,
    n: vec3f,
    uv: vec2f,
    footprint: Footprint,
}

// A spectrum, or a number four times.
fn texture(at: u32, context: TextureContext, lambda: SampledWavelengths) -> vec4f {
    let head = words_at(at);
    if (head.x == TextureTag_Number) {
        return vec4f(bitcast<f32>(head.y));
    }
    if (head.x == TextureTag_Spectrum) {
        return spectrum(head.y, lambda);
    }
    if (HAS_PROGRAMS) {
        return program(at + 4, head.y, context, lambda);
    }
    return vec4f();
}

// The result of so many operations: a function of its own, which sets all slots to zero where it
// begins.
fn program(at: u32, count: u32, context: TextureContext, lambda: SampledWavelengths) -> vec4f {
    var slots: array<vec4f, 32>;
    for (var i = 0u; i < count; i++) {
        let operation = words_at(at + 4 * i);
        let code = operation.x;
        let operands = operation.z;
        let a = slots[operands & 255];
        let b = slots[(operands >> 8) & 255];
        let c = slots[(operands >> 16) & 255];
        let argument = operation.w;
        var value: vec4f;
        switch (code) {
            case CodeTag_Number: { value = vec4f(bitcast<f32>(argument)); }
            case CodeTag_Spectrum: { value = spectrum(argument, lambda); }
            case CodeTag_Cubes: { value = vec4f(cubes(in_texture(argument, context))); }
            case CodeTag_Facing: { value = vec4f(abs(dot(context.n, vector(argument)))); }
            case CodeTag_Step: { value = vec4f(select(0.0, 1.0, a.x >= bitcast<f32>(argument))); }
            case CodeTag_Scale: { value = a * b.x; }
            case CodeTag_Mix: {
                let mixed = a * (1 - c.x) + b * c.x;
                value = select(select(mixed, b, c.x == 1), a, c.x == 0);
            }
            case CodeTag_Squares, CodeTag_Bilerp, CodeTag_Image, CodeTag_Dots: {
                let is_image = code == CodeTag_Image;
                let place = on_texture(select(argument, word(argument + 1), is_image), context);
                if (HAS_IMAGES && is_image) {
                    value = image_texture(argument, place, lambda);
                } else if (code == CodeTag_Squares) {
                    value = vec4f(squares(place));
                } else if (HAS_NOISE && code == CodeTag_Dots) {
                    value = vec4f(coverage(place.st));
                } else {
                    let w = weights(place.st);
                    value = a * w.x + b * w.y + c * w.z + slots[operands >> 24] * w.w;
                }
            }
            default: {
                if (HAS_NOISE) {
                    value = pattern(code, argument, context, lambda);
                }
            }
        }
        slots[operation.y] = value;
    }
    return slots[0];
}

// A lookup in an image: a number or a spectrum.
fn image_texture(at: u32, place: TexCoord2d, lambda: SampledWavelengths) -> vec4f {
    // Rows of images go down.
    let st = vec2f(place.st.x, 1 - place.st.y);
    let how = words_at(at + 4);
    let found = filtered_color(words_at(at), st, place.dstdx, place.dstdy) * bitcast<f32>(how.x);
    let is_inverted = how.y == 1;
    let color = select(found, 1 - found, is_inverted);
    if (how.z == 0) {
        return vec4f(select(color.x, max(color.x, 0), is_inverted));
    }
    return rgb_spectrum(how.z, how.w, max(color, vec3f()), lambda);
}

// What is made of noise.
fn pattern(code: u32, at: u32, context: TextureContext, lambda: SampledWavelengths) -> vec4f {
    if (code == CodeTag_Windy) {
        return vec4f(windy(in_texture(at, context)));
    }
    let head = words_at(at);
    let place = in_texture(head.x, context);
    let octaves = head.y;
    let roughness = bitcast<f32>(head.z);
    switch (code) {
        case CodeTag_Fbm: { return vec4f(fbm(place, octaves, roughness)); }
        case CodeTag_Wrinkled: { return vec4f(turbulence(place, octaves, roughness)); }
        default: {
            let more = words_at(at + 4);
            let fractal = Fractal(0, octaves, roughness);
            let marble = Marble(fractal, bitcast<f32>(head.w), bitcast<f32>(more.x));
            return rgb_spectrum(more.y, SpectrumTypeTag_Albedo, marble_color(Marble_place(marble, place)), lambda);
        }
    }
}

// The colour at a place of the ramp of marble: `color` of `scene/src/texture/marble.rs`. Of its
// nine colours only the fourth, the fifth and the eighth differ from the others.
fn marble_color(place: f32) -> vec3f {
    let first = clamp(floor(place * 6), 0, 5);
    let t = place * 6 - first;
    let s = 1 - t;
    let weights = vec4f(s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t);
    var color: vec3f;
    for (var i = 0u; i < 4; i++) {
        var part = vec3f(0.58, 0.58, 0.6);
        switch (u32(first) + i) {
            case 3: { part = vec3f(0.5); }
            case 4: { part = vec3f(0.6, 0.59, 0.58); }
            case 7: { part = vec3f(0.2, 0.2, 0.33); }
            default: {}
        }
        color += weights[i] * part;
    }
    return color * 1.5;
}

// The point on the plane of a texture.
fn on_texture(at: u32, context: TextureContext) -> TexCoord2d {
    let footprint = context.footprint;
    let kind = word(at);
    if (kind == MappingTag_Linear) {
        let columns = numbers_at(at + 4);
        let u = columns.xy;
        let v = columns.zw;
        let delta = numbers_at(at + 8).xy;
        return TexCoord2d(
            u * context.uv.x + v * context.uv.y + delta,
            u * footprint.dudx + v * footprint.dvdx,
            u * footprint.dudy + v * footprint.dvdy,
        );
    }
    let place = in_texture(at + 4, context);
    let p = place.p;
    let outward = dot(p.xy, p.xy);
    let around = vec3f(-p.y, p.x, 0) / (6.2831855 * outward);
    var st: vec2f;
    // The gradients of the coordinates.
    var s: vec3f;
    var t: vec3f;
    if (kind == MappingTag_Spherical) {
        let rho = sqrt(outward);
        s = vec3f(p.xy * (p.z / rho), -rho) / (3.1415927 * dot(p, p));
        t = around;
        let direction = Vec3_normalize_masked(p);
        let w = select(vec3f(), direction.v0, direction.v1);
        st = vec2f(arc_acos(clamp(w.z, -1, 1)) / 3.1415927, spherical_phi(w) / 6.2831855);
    } else if (kind == MappingTag_Cylindrical) {
        s = around;
        t = vec3f(0, 0, 1);
        st = vec2f((3.1415927 + arc_atan2(p.y, p.x)) / 6.2831855, p.z);
    } else {
        let axes = array(numbers_at(at + 16), numbers_at(at + 20));
        s = axes[0].xyz;
        t = axes[1].xyz;
        st = vec2f(dot(p, s), dot(p, t)) + vec2f(axes[0].w, axes[1].w);
    }
    let dx = vec2f(dot(s, place.dpdx), dot(t, place.dpdx));
    return TexCoord2d(st, dx, vec2f(dot(s, place.dpdy), dot(t, place.dpdy)));
}

// The point in the space of a texture.
fn in_texture(at: u32, context: TextureContext) -> TexCoord3d {
    let m = kept_placement(at);
    let d = context.footprint;
    return TexCoord3d(times_point(m, context.p), times(m.linear, d.dpdx), times(m.linear, d.dpdy));
}
