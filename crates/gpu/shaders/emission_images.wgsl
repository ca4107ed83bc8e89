// The images of lights with surfaces: the offsets of a pyramid of one level and of a colour space.

// The offset of the image of a light, or 0.
fn emission_image(at: u32) -> u32 {
    let more = tables[at + 3] >> 2;
    if (!HAS_EMISSION_IMAGES || more == 0 || tables[more] == 0) {
        return 0;
    }
    return more;
}

// What the image of a light multiplies its emission by at texture coordinates of its surface.
fn image_share(image: u32, uv: vec2f, lambda: SampledWavelengths) -> vec4f {
    let pyramid = tables[image];
    // Rows of images go down.
    let rgb = few_texels(pyramid, level_of(pyramid, 0), vec2f(uv.x, 1 - uv.y), false, false);
    return rgb_spectrum(tables[image + 1], UNBOUNDED, max(rgb, vec3f()), lambda);
}

// The same at a point of its surface, which has the parameters `uv`.
fn image_share_at(at: u32, p: vec3f, uv: vec2f, lambda: SampledWavelengths) -> vec4f {
    if (emission_image(at) == 0) {
        return vec4f(1);
    }
    return image_share(emission_image(at), coordinates_on_light(at, p, uv), lambda);
}

// The texture coordinates of a point of the surface of a light.
fn coordinates_on_light(light: u32, p_outside: vec3f, uv: vec2f) -> vec2f {
    let at = surface_record(light);
    var p = p_outside;
    if (is_placed(light)) {
        let inward = way_to_surface(light);
        p = times(inward.linear, p) + inward.translation;
    }
    switch (tables[at]) {
        case TRIANGLE_LIGHT: {
            let first = vec2f(number(at + 16), number(at + 17));
            let second = vec2f(number(at + 18), number(at + 19));
            let third = vec2f(number(at + 20), number(at + 21));
            return first * (1 - uv.x - uv.y) + second * uv.x + third * uv.y;
        }
        case RECTANGLE_LIGHT, PATCH_LIGHT: { return uv; }
        case SPHERE_LIGHT: {
            let radius = number(at + 7);
            let rotation = Rows(vector(at + 9), vector(at + 12), vector(at + 15));
            let local = transposed(rotation, p - vector(at + 4));
            return revolved_point(SPHERE, local, whole_sphere(radius)).uv;
        }
        default: {
            let m = Rows(vector(at + 4), vector(at + 8), vector(at + 12));
            let local = times(inverse(m), p - vec3f(number(at + 7), number(at + 11), number(at + 15)));
            let numbers = vec4f(number(at + 16), number(at + 17), number(at + 18), number(at + 19));
            var kind = SPHERE;
            if (tables[at] != SPHERE_PART_LIGHT) {
                kind = select(CYLINDER, DISK, tables[at] == DISK_LIGHT);
            }
            return revolved_point(kind, local, numbers).uv;
        }
    }
}
