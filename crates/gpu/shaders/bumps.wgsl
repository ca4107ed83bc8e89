// Normals by images and by textures of height: `normal_map.rs` and `bump_map.rs` of
// `scene/src/material/`.

// The normal of a map.
fn mapped_normal(image: u32, uv: vec2f) -> vec3f {
    let mapped = Vec3_normalize_masked(2 * uv_color(image, uv) - 1);
    return select(vec3f(0, 0, 1), mapped.v0, mapped.v1);
}

// Turns the shading frame to the normal of a map; its tangents keep their lengths.
fn map_normal(s: ptr<function, Surface>, image: u32) {
    let inner = mapped_normal(image, (*s).uv);
    let ns = Frame_from_local(Frame_from_z_and_x((*s).ns, (*s).ss), inner);
    let bent = Frame_from_z_and_x(ns, (*s).ss);
    (*s).ns = face_forward(ns, (*s).n);
    (*s).ss = bent.x * length((*s).ss);
    (*s).ts = bent.y * length((*s).ts);
}

// The differences of u and v over which heights are compared: half of the pixel's footprint.
fn bump_steps(context: TextureContext) -> vec2f {
    let f = context.footprint;
    let widths = vec2f(abs(f.dudx) + abs(f.dudy), abs(f.dvdx) + abs(f.dvdy));
    return select(vec2f(0.0005), 0.5 * widths, widths > vec2f());
}

// Where the height of a surface is asked for: here, along u and along v.
fn raised_context(s: Surface, context: TextureContext, height: u32) -> TextureContext {
    var moved = context;
    let step = bump_steps(context);
    if (height == 1) {
        moved.p += s.ss * step.x;
        moved.uv.x += step.x;
    } else if (height == 2) {
        moved.p += s.ts * step.y;
        moved.uv.y += step.y;
    }
    return moved;
}

// Gives the surface the shading geometry of the raised one; none where that is degenerate.
fn raise(s: ptr<function, Surface>, context: TextureContext, heights: array<f32, 3>) {
    let here = heights[0];
    let slope = (vec2f(heights[1], heights[2]) - here) / bump_steps(context);
    let ss = (*s).ss + (*s).ns * slope.x + (*s).dndu * here;
    let ts = (*s).ts + (*s).ns * slope.y + (*s).dndv * here;
    let n = Vec3_normalize_masked(cross(ss, ts));
    if (n.v1) {
        (*s).ns = face_forward(n.v0, (*s).n);
        (*s).ss = ss;
        (*s).ts = ts;
    }
}
