// Sprites: pictures of groups from one direction each, drawn instead of their triangles.
//
// A texel has the share of light that is scattered, reflected and transmitted together, times the
// share that is covered, and the latter; and a normal, from 0 to 1, and how near the surface is, both
// times it. The normal is shorter the more directions meet there, and where light is transmitted.

@group(1) @binding(0) var colors: texture_2d_array<f32>;
@group(1) @binding(1) var normals: texture_2d_array<f32>;

struct Texel {
    @location(0) color: vec4f,
    @location(1) normal: vec4f,
}

// A texel of a sprite; the camera looks along −z of the frame of normals.
@fragment
fn bake_fragment(surface: Surface) -> Texel {
    // Clip space is the frame, but for the unit of depth.
    var n = normalize((eye.clip_from_render * vec4f(surface.n, 0.0)).xyz * vec3f(1.0, 1.0, 2.0));
    n = select(n, -n, n.z < 0.0);
    let sum = surface.reflectance.rgb + surface.transmittance;
    let difference = surface.reflectance.rgb - surface.transmittance;
    let one_sided = dot(difference, vec3f(1.0)) / max(dot(sum, vec3f(1.0)), 1e-6);
    return Texel(vec4f(min(sum, vec3f(1.0)), 1.0), vec4f(0.5 + 0.5 * one_sided * n, surface.at.z));
}

struct Reduced {
    @builtin(position) at: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn reduce_vertex(@builtin(vertex_index) corner: u32) -> Reduced {
    let ndc = whole_picture(corner);
    return Reduced(vec4f(ndc, 0.0, 1.0), ndc * vec2f(0.5, -0.5) + 0.5);
}

// The mean of four texels.
@fragment
fn reduce_fragment(reduced: Reduced) -> Texel {
    return Texel(
        textureSampleLevel(colors, smooth_sampler, reduced.uv, 0, 0.0),
        textureSampleLevel(normals, smooth_sampler, reduced.uv, 0, 0.0),
    );
}

struct Sprite {
    @builtin(position) at: vec4f,
    @location(0) p: vec3f,
    @location(1) uv: vec2f,
    @location(2) @interpolate(flat) layer: u32,
    @location(3) @interpolate(flat) x: vec3f,
    @location(4) @interpolate(flat) y: vec3f,
    @location(5) @interpolate(flat) z: vec3f,
}

@vertex
fn sprite_vertex(
    @builtin(vertex_index) corner: u32,
    // The frame of the sprite, times its radius, with its layer.
    @location(0) x: vec4f,
    @location(1) y: vec4f,
    @location(2) z: vec4f,
    @location(3) center: vec4f,
) -> Sprite {
    let place = vec2f(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
    let p = center.xyz + place.x * x.xyz + place.y * y.xyz;
    let uv = place * vec2f(0.5, -0.5) + 0.5;
    return Sprite(eye.clip_from_render * vec4f(p, 1.0), p, uv, u32(center.w), x.xyz, y.xyz, z.xyz);
}

struct Shown {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn sprite_fragment(sprite: Sprite) -> Shown {
    let color = textureSample(colors, smooth_sampler, sprite.uv, sprite.layer);
    let normal = textureSample(normals, smooth_sampler, sprite.uv, sprite.layer);
    let covered = max(color.a, 1e-4);
    // Where the surface is, before or behind the middle of the sprite.
    let p = sprite.p + sprite.z * clamp(2.0 * normal.a / covered - 1.0, -1.0, 1.0);
    if color.a < 0.004 || dot(eye.cut.xyz, p) + eye.cut.w < 0.0 {
        discard;
    }
    let local = clamp(2.0 * normal.rgb / covered - 1.0, vec3f(-1.0), vec3f(1.0));
    let turned = local.x * cross(sprite.y, sprite.z) + local.y * cross(sprite.z, sprite.x)
        + local.z * cross(sprite.x, sprite.y);
    let n = turned * (min(length(local), 1.0) / max(length(turned), 1e-20));
    let light = 0.31830987 * color.rgb / covered * harmonics(eye.irradiance, n);
    let way = p - eye.position.xyz;
    let distance = length(way);
    let clip = eye.clip_from_render * vec4f(p, 1.0);
    return Shown(vec4f(fogged(light, way / distance, distance) * color.a, color.a), clip.z / clip.w);
}
