// The images of lights with surfaces: the offsets of an image over (u, v) and of a colour space.

// The offset of the image of a light, or 0.
fn emission_image(at: u32) -> u32 {
    let more = word(at + 3) >> 2;
    if (!HAS_EMISSION_IMAGES || more == 0 || word(more) == 0) {
        return 0;
    }
    return more;
}

// What the image of a light multiplies its emission by at texture coordinates of its surface.
fn image_share(image: u32, uv: vec2f, lambda: SampledWavelengths) -> vec4f {
    let parts = words_at(image);
    let rgb = uv_color(parts.x, uv);
    return rgb_spectrum(parts.y, SpectrumTypeTag_Unbounded, max(rgb, vec3f()), lambda);
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
        p = times_point(inward, p);
    }
    switch (word(at)) {
        case LightTag_Triangle: {
            let corners = numbers_at(at + 20);
            let third = numbers_at(at + 24).xy;
            return corners.xy * (1 - uv.x - uv.y) + corners.zw * uv.x + third * uv.y;
        }
        case LightTag_Rectangle, LightTag_Patch: { return uv; }
        case LightTag_Sphere: {
            let ball = numbers_at(at + 4);
            let rotation = Rows(vector(at + 8), vector(at + 12), vector(at + 16));
            let local = transposed(rotation, p - ball.xyz);
            return revolved_point(ItemTag_Sphere, local, whole_sphere(ball.w)).uv;
        }
        default: {
            let out = kept_placement(at + 4);
            let local = times(inverse(out.linear), p - out.translation);
            var kind = ItemTag_Sphere;
            if (word(at) != LightTag_SpherePart) {
                kind = select(ItemTag_Cylinder, ItemTag_Disk, word(at) == LightTag_Disk);
            }
            return revolved_point(kind, local, numbers_at(at + 16)).uv;
        }
    }
}
