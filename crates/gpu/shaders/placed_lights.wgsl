// Lights with surfaces in instances. Their record has the offset of that of the surface, in the
// space of the instance, and the item of the instance.
//
// Points are chosen in that space. Their densities follow by the Jacobian of the matrix W that leads
// there: an area with the normal n in it grows by |Wᵀn|/|det W| to the space of the scene, and a
// solid angle around ω there grows by |det W|/|Wω|³ on the way in.

fn is_placed(at: u32) -> bool {
    return HAS_PLACED_LIGHTS && word(at) == LightTag_Placed;
}

// The record of the surface of a light, in its own space.
fn surface_record(at: u32) -> u32 {
    if (is_placed(at)) {
        return word(at + 4);
    }
    return at;
}

// The way into the space of the surface of a light.
fn way_to_surface(at: u32) -> Placement {
    let row = instance_rows(word(at + 5));
    return Placement(Rows(row[0].xyz, row[1].xyz, row[2].xyz), vec3f(row[0].w, row[1].w, row[2].w));
}

// A reference point as the surface sees it; in media it has no normals.
fn context_inside(inward: Placement, context: ShapeSampleContext) -> ShapeSampleContext {
    let p = times_point(inward, context.p.p);
    let size = times(absolute(inward.linear), abs(context.p.p)) + abs(inward.translation);
    let error = times(absolute(inward.linear), context.p.error) + POINT_ERROR * size;
    let outward = inverse(inward.linear);
    let n = unit_or(transposed(outward, context.n), vec3f());
    let ns = unit_or(transposed(outward, context.ns), vec3f());
    return ShapeSampleContext(Point3Error(p, error), n, ns, context.time);
}

// Takes a point of a surface out of its space, but not its density.
fn leave_instance(inward: Placement, point: ptr<function, ShapeSample>) {
    (*point).p = placed_point(inverse(inward.linear), inward.translation, (*point).p);
    (*point).n = Vec3_normalize(transposed(inward.linear, (*point).n));
}

// A point of the surface of a light by area, with its density.
fn point_on_light(at: u32, u: vec2f) -> ShapeSample {
    var point = point_by_area(surface_record(at), u);
    if (is_placed(at)) {
        let inward = way_to_surface(at);
        point.pdf *= abs(determinant(inward.linear)) / length(transposed(inward.linear, point.n));
        leave_instance(inward, &point);
    }
    return point;
}

// The density per area of such a point, given its normal.
fn density_on_light(at: u32, n: vec3f, uv: vec2f) -> f32 {
    if (!is_placed(at)) {
        return surface_density(at, n, uv);
    }
    let inward = way_to_surface(at).linear;
    let outward = inverse(inward);
    let density = surface_density(surface_record(at), Vec3_normalize(transposed(outward, n)), uv);
    return density * abs(determinant(inward)) * length(transposed(outward, n));
}

// The texture of the alpha of a light, or 0.
fn alpha_of_light(at: u32) -> u32 {
    let more = word(at + 3) >> 2;
    if (!HAS_LIGHT_HOLES || more == 0) {
        return 0;
    }
    return word(more + 2);
}

// Whether rays may meet light of a sphere behind its holes: where its inside emits.
fn shines_through_holes(at: u32, record: u32) -> bool {
    let has_holes = alpha_of_light(at) != 0 || (word(at + 3) & 2) != 0;
    return has_holes && (is_two_sided(at) || number(record + 11) < 0);
}

// Whether a light does not emit at a point of its surface, by a hash of the point.
fn is_cut_out_of_light(at: u32, p: vec3f, n: vec3f, uv: vec2f) -> bool {
    let alpha = alpha_of_light(at);
    if (!HAS_LIGHT_HOLES || alpha == 0) {
        return false;
    }
    let context = TextureContext(p, n, coordinates_on_light(at, p, uv), Footprint());
    let share = texture(alpha, context, SampledWavelengths()).x;
    return !(share >= 1 || hashed(p, vec3f(), 0) < share);
}
