// Translated from crates/scattering/src/bxdf/openpbr/under.rs
// by `cargo xtask wgsl`, which translates it again.

const Part_Whole = 0u;
const Part_Boundary = 1u;
const Part_Entering = 2u;
const Part_Leaving = 3u;

// The albedo of single scattering of a half space that reflects `albedo` of uniform light.
fn single_scattering(albedo_1: f32, g: f32) -> f32 {
    let a = real_min(real_max(albedo_1, 0.0f), 1.0f);
    let s = (4.09712f + (4.20863f * a)) - sqrt((9.59217f + (41.6808f * a)) + ((17.7126f * a) * a));
    return real_min(real_max((1.0f - (s * s)) / (1.0f - ((g * s) * s)), 0.0f), 1.0f);
}

// The medium under a surface, which does nothing if nothing is scattered there, or at once.
fn interior(p: OpenPbrParameters) -> Interior {
    let zero = SampledSpectrum_zero();
    let phase = HenyeyGreenstein(0.0f);
    let nothing = Interior(zero, zero, phase, 1.0f);
    if (p.geometry_thin_walled) {
        return nothing;
    }
    let opaque = (1.0f - p.base_metalness) * (1.0f - p.transmission_weight);
    let is_body = ((opaque * p.subsurface_weight) > 0.0f) & !SampledSpectrum_is_black(p.subsurface_radius);
    if (!is_body) {
        return nothing;
    }
    let g = real_min(real_max(p.subsurface_scatter_anisotropy, -0.99f), 0.99f);
    var albedo_1 = p.subsurface_color;
    var sigma_t = p.subsurface_radius;
    {
        albedo_1[0] = single_scattering(albedo_1[0], g);
    }
    {
        albedo_1[1] = single_scattering(albedo_1[1], g);
    }
    {
        albedo_1[2] = single_scattering(albedo_1[2], g);
    }
    {
        albedo_1[3] = single_scattering(albedo_1[3], g);
    }
    {
        sigma_t[0] = 1.0f / real_max(sigma_t[0], 1e-6f);
    }
    {
        sigma_t[1] = 1.0f / real_max(sigma_t[1], 1e-6f);
    }
    {
        sigma_t[2] = 1.0f / real_max(sigma_t[2], 1e-6f);
    }
    {
        sigma_t[3] = 1.0f / real_max(sigma_t[3], 1e-6f);
    }
    return Interior(SampledSpectrum_select(is_body, albedo_1 * sigma_t, zero), SampledSpectrum_select(is_body, sigma_t, zero), HenyeyGreenstein(g), 1.0f);
}

// The share of the diffuse base that paths go under, from the side of `z`.
fn OpenPbr_share_under(this_: OpenPbr, z: f32) -> f32 {
    let choice = this_.part;
    if (choice == Part_Boundary) {
        return select(0.0f, this_.subsurface_weight, z > 0.0f);
    } else {
        return 0.0f;
    }
}

// What of the light to `wo`, above, comes from under the surface, over what does of all.
fn OpenPbr_goes_under(this_: OpenPbr, shares: Shares, wo: vec3f) -> vec4f {
    let weight_1 = (OpenPbr_weights(this_, 1.0f).diffuse * this_.subsurface_weight) * shares.seen;
    return ((shares.diffuse_rest * this_.darkening) * OpenPbr_absorbed(this_, OpenPbr_coat_length(this_, wo.z))) * weight_1;
}

// The value of one of the two lobes for light on the way between the surface and `w`, above.
fn OpenPbr_lobe(this_: OpenPbr, w: vec3f) -> vec4f {
    let shares = OpenPbr_shares(this_, w);
    let choice = this_.part;
    var chosen: vec4f;
    if (choice == Part_Entering) {
        let left = SampledSpectrum_safe_div(shares.diffuse_rest, OpenPbr_rests(this_).diffuse);
        chosen = left * OpenPbr_absorbed(this_, OpenPbr_coat_length(this_, w.z));
    } else {
        chosen = OpenPbr_goes_under(this_, shares, w);
    }
    let value_1 = chosen;
    return value_1 * 0.31830987f;
}

// Whether it is one of the two lobes.
fn OpenPbr_is_lobe(this_: OpenPbr) -> bool {
    return (this_.part == Part_Entering) || (this_.part == Part_Leaving);
}
