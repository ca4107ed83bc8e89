// Water: what is mirrored is looked up in a picture of the mirrored view, where the waves send it.

@group(1) @binding(0) var mirrored: texture_2d<f32>;

// Where the mirrored view shows a point, as a position in its picture.
fn place_in_mirror(p: vec3f) -> vec2f {
    let image = p - 2.0 * (dot(eye.pond.xyz, p) + eye.pond.w) * eye.pond.xyz;
    let clip = eye.clip_from_render * vec4f(image, 1.0);
    return clip.xy / max(clip.w, 1e-6) * vec2f(0.5, -0.5) + 0.5;
}

// What a surface at p of normal n mirrors along d, this far away.
fn looked_up(p: vec3f, d: vec3f, n: vec3f, beyond: f32) -> vec3f {
    var r = reflect(d, n);
    // Not into the water.
    r += eye.pond.xyz * (abs(dot(r, eye.pond.xyz)) - dot(r, eye.pond.xyz));
    let place = place_in_mirror(p + beyond * normalize(r));
    return textureSampleLevel(mirrored, smooth_sampler, clamp(place, vec2f(0.0), vec2f(1.0)), 0.0).rgb;
}

@fragment
fn water_fragment(surface: Surface) -> @location(0) vec4f {
    let way = surface.p - eye.position.xyz;
    let distance = length(way);
    let d = way / distance;
    var n = normalize(surface.n);
    n = select(n, -n, dot(n, eye.pond.xyz) < 0.0);
    let across = dpdx(n);
    let along = dpdy(n);
    // Waves are seen from above only.
    let cos_theta = max(-dot(d, n), 0.01);
    let share = fresnel(cos_theta, eye.water.w);
    // How far away what is mirrored is, as if there were no waves.
    let straight = textureSampleLevel(mirrored, smooth_sampler, surface.at.xy / eye.size.xy, 0.0);
    let whole = eye.position.w * (1.0 / max(straight.a, 1e-5) - 1.0);
    let beyond = max(whole - distance, 0.02 * eye.position.w);
    // Waves smaller than a pixel are blurred, if only by its neighbours.
    var reflected = vec3f(0.0);
    for (var i = -2; i <= 2; i++) {
        let turned = normalize(n + select(across, along, abs(i) == 1) * sign(f32(i)));
        reflected += 0.2 * looked_up(surface.p, d, turned, beyond);
    }
    // Down along the refracted ray and up from below, and out again: the light that is mirrored
    // back inside is that of a diffuse surface, 6.6 % from above and 47 % from below.
    let cos_inside = sqrt(1.0 - (1.0 - cos_theta * cos_theta) / (eye.water.w * eye.water.w));
    let passes = pow(max(surface.transmittance, vec3f(0.0)), vec3f(1.0 + 1.0 / cos_inside));
    let below = mix(eye.water.rgb, surface.reflectance.rgb, passes);
    let seen = below * 0.934 / (1.0 - 0.47 * below) / (eye.water.w * eye.water.w);
    let through = diffuse(seen, vec3f(0.0), eye.pond.xyz);
    return vec4f(fogged(mix(through, reflected, share), d, distance), 1.0);
}
