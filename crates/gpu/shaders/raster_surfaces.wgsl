// Triangles of surfaces, under the light of the sky.

struct Surface {
    @builtin(position) at: vec4f,
    // Within the triangle also where the middle of the pixel is not.
    @location(0) @interpolate(perspective, centroid) p: vec3f,
    @location(1) @interpolate(perspective, centroid) n: vec3f,
    @location(2) @interpolate(perspective, centroid) reflectance: vec4f,
    @location(3) @interpolate(perspective, centroid) transmittance: vec3f,
    // Of single-sided surfaces, the sign of the area in the picture of triangles whose front is
    // seen; 0 of others.
    @location(4) @interpolate(flat, either) front: f32,
}

// The sign of the area in the picture of a triangle whose corners run counter-clockwise as the
// camera sees them; 0 of parallel views.
fn orientation_of_picture() -> f32 {
    let rows = transpose(eye.clip_from_render);
    return -sign(dot(cross(rows[0].xyz, rows[1].xyz), rows[3].xyz));
}

// Whether the camera sees the back of a single-sided surface, not a mirror.
fn turns_its_back(surface: Surface, is_positive: bool) -> bool {
    return surface.front * select(-1.0, 1.0, is_positive) < 0.0 && all(eye.cut == vec4f());
}

@vertex
fn surface_vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec4f,
    @location(2) reflectance: vec4f,
    @location(3) transmittance: vec4f,
    // The rows of the instance's matrix.
    @location(4) x: vec4f,
    @location(5) y: vec4f,
    @location(6) z: vec4f,
) -> Surface {
    let q = vec4f(position, 1.0);
    let p = vec3f(dot(x, q), dot(y, q), dot(z, q));
    // By the inverse transposed, but for a factor.
    let n = vec3f(
        dot(cross(y.xyz, z.xyz), normal.xyz),
        dot(cross(z.xyz, x.xyz), normal.xyz),
        dot(cross(x.xyz, y.xyz), normal.xyz),
    );
    // Square roots need fewer bits.
    let shares = vec4f(reflectance.rgb * reflectance.rgb, reflectance.a);
    let through = transmittance.rgb * transmittance.rgb;
    // Whether its instance and the picture turn it over.
    let turn = sign(dot(cross(x.xyz, y.xyz), z.xyz)) * orientation_of_picture();
    return Surface(eye.clip_from_render * vec4f(p, 1.0), p, normalize(n), shares, through, turn * normal.w);
}

@fragment
fn surface_fragment(surface: Surface, @builtin(front_facing) is_positive: bool) -> @location(0) vec4f {
    if dot(eye.cut.xyz, surface.p) + eye.cut.w < 0.0 || turns_its_back(surface, is_positive) {
        discard;
    }
    let way = surface.p - eye.position.xyz;
    let distance = length(way);
    let d = way / distance;
    var n = normalize(surface.n);
    let shading = u32(3.0 * surface.reflectance.a + 0.5);
    let is_inside = dot(n, d) > 0.0;
    n = select(n, -n, is_inside);
    var light: vec3f;
    if shading == 1u {
        light = surface.reflectance.rgb * textureSampleLevel(sky, smooth_sampler, reflect(d, n), 0.0).rgb;
    } else if shading == 2u {
        let index = 4.0 * surface.transmittance.r;
        let eta = select(index, 1.0 / index, is_inside);
        let share = fresnel(-dot(d, n), eta);
        let mirrored = textureSampleLevel(sky, smooth_sampler, reflect(d, n), 0.0).rgb;
        let through = textureSampleLevel(sky, smooth_sampler, refract(d, n, 1.0 / eta), 0.0).rgb;
        light = mix(through, mirrored, share);
    } else {
        light = diffuse(surface.reflectance.rgb, surface.transmittance, n);
    }
    return vec4f(fogged(light, d, distance), nearness(distance));
}
