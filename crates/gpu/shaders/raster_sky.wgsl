// The sky behind everything.

struct Backdrop {
    @builtin(position) at: vec4f,
    @location(0) ndc: vec2f,
}

@vertex
fn sky_vertex(@builtin(vertex_index) corner: u32) -> Backdrop {
    let ndc = whole_picture(corner);
    return Backdrop(vec4f(ndc, 0.0, 1.0), ndc);
}

@fragment
fn sky_fragment(backdrop: Backdrop) -> @location(0) vec4f {
    let p = eye.render_from_clip * vec4f(backdrop.ndc, 1.0, 1.0);
    let d = normalize(p.xyz / p.w - eye.position.xyz);
    let light = textureSampleLevel(sky, smooth_sampler, d, 0.0).rgb;
    return vec4f(fogged(light, d, 1e6 * eye.position.w), 0.0);
}
