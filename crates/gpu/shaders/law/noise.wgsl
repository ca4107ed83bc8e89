// Translated from crates/scene/src/texture/noise.rs
// by `cargo xtask wgsl`, which translates it again.

// The noise at a point, in (−1, 1).
fn noise(p: vec3f) -> f32 {
    let cell = vec3f(floor(p.x), floor(p.y), floor(p.z));
    let from_low = p - cell;
    let from_high = from_low - vec3f(1.0f);
    let x = lattice_index(cell.x);
    let y = lattice_index(cell.y);
    let z = lattice_index(cell.z);
    let dx_0 = from_low.x;
    let dx_1 = from_high.x;
    let dy_0 = from_low.y;
    let dy_1 = from_high.y;
    let dz_0 = from_low.z;
    let dz_1 = from_high.z;
    let wx = fade(from_low.x);
    let wy = fade(from_low.y);
    let wz = fade(from_low.z);
    var planes = vec2f(0.0f, 0.0f);
    {
        var chosen: u32;
        if (0 == 0) {
            chosen = x;
        } else {
            chosen = x + 1u;
        }
        let hash_1 = noise_permuted(chosen);
        var lines = vec2f(0.0f, 0.0f);
        {
            var chosen_1: u32;
            if (0 == 0) {
                chosen_1 = y;
            } else {
                chosen_1 = y + 1u;
            }
            let hash_2 = noise_permuted(hash_1 + chosen_1);
            let low = ramp(noise_permuted(hash_2 + z), vec3f(dx_0, dy_0, dz_0));
            let z_1 = z + 1u;
            let high = ramp(noise_permuted(hash_2 + z_1), vec3f(dx_0, dy_0, dz_1));
            lines[0] = lerp(wz, low, high);
        }
        {
            var chosen_2: u32;
            if (1 == 0) {
                chosen_2 = y;
            } else {
                chosen_2 = y + 1u;
            }
            let hash_3 = noise_permuted(hash_1 + chosen_2);
            let low_1 = ramp(noise_permuted(hash_3 + z), vec3f(dx_0, dy_1, dz_0));
            let z_2 = z + 1u;
            let high_1 = ramp(noise_permuted(hash_3 + z_2), vec3f(dx_0, dy_1, dz_1));
            lines[1] = lerp(wz, low_1, high_1);
        }
        planes[0] = lerp(wy, lines.x, lines.y);
    }
    {
        var chosen_3: u32;
        if (1 == 0) {
            chosen_3 = x;
        } else {
            chosen_3 = x + 1u;
        }
        let hash_4 = noise_permuted(chosen_3);
        var lines_1 = vec2f(0.0f, 0.0f);
        {
            var chosen_4: u32;
            if (0 == 0) {
                chosen_4 = y;
            } else {
                chosen_4 = y + 1u;
            }
            let hash_5 = noise_permuted(hash_4 + chosen_4);
            let low_2 = ramp(noise_permuted(hash_5 + z), vec3f(dx_1, dy_0, dz_0));
            let z_3 = z + 1u;
            let high_2 = ramp(noise_permuted(hash_5 + z_3), vec3f(dx_1, dy_0, dz_1));
            lines_1[0] = lerp(wz, low_2, high_2);
        }
        {
            var chosen_5: u32;
            if (1 == 0) {
                chosen_5 = y;
            } else {
                chosen_5 = y + 1u;
            }
            let hash_6 = noise_permuted(hash_4 + chosen_5);
            let low_3 = ramp(noise_permuted(hash_6 + z), vec3f(dx_1, dy_1, dz_0));
            let z_4 = z + 1u;
            let high_3 = ramp(noise_permuted(hash_6 + z_4), vec3f(dx_1, dy_1, dz_1));
            lines_1[1] = lerp(wz, low_3, high_3);
        }
        planes[1] = lerp(wy, lines_1.x, lines_1.y);
    }
    return lerp(wx, planes.x, planes.y);
}

// A coordinate of a lattice point modulo 256. NaN gives 0.
fn lattice_index(coordinate: f32) -> u32 {
    let within = coordinate - (floor(coordinate / 256.0f) * 256.0f);
    return bitcast<u32>(i32(real_min(real_max(within, 0.0f), 255.0f)));
}

// 6t⁵ − 15t⁴ + 10t³.
fn fade(t: f32) -> f32 {
    return ((t * t) * t) * ((t * ((t * 6.0f) - 15.0f)) + 10.0f);
}

// The scalar product of `d` with the gradient that the low four bits of a hash choose:
fn ramp(hash_1: u32, d: vec3f) -> f32 {
    let choice = hash_1 & 15u;
    let is_12_or_13 = (choice & 14u) == 12u;
    let first = select(d.y, d.x, (choice < 8u) | is_12_or_13);
    let second = select(d.z, d.y, (choice < 4u) | is_12_or_13);
    let signs_0 = choice << 31;
    let signs_1 = (choice & 2u) << 30;
    return bitcast<f32>(bitcast<u32>(first) ^ signs_0) + bitcast<f32>(bitcast<u32>(second) ^ signs_1);
}
