// Translated from crates/sampling/src/hash.rs
// by `cargo xtask wgsl`, which translates it again.

// A bijection of 32-bit words under which each input bit changes about half of the output bits:
// `lowbias32` of [Wellons 2018].
fn mix_word(v: u32) -> u32 {
    let v_1 = (v ^ (v >> 16)) * 0x7feb352du;
    let v_2 = (v_1 ^ (v_1 >> 15)) * 0x846ca68bu;
    return v_2 ^ (v_2 >> 16);
}

// A bijection of quadruples of words whose images look independent: `pcg4d` of [Jarzynski 2020].
fn mix_quadruple(words: array<u32, 4>) -> array<u32, 4> {
    var mixed = words;
    {
        mixed[0] = (mixed[0] * 1664525u) + 1013904223u;
    }
    {
        mixed[1] = (mixed[1] * 1664525u) + 1013904223u;
    }
    {
        mixed[2] = (mixed[2] * 1664525u) + 1013904223u;
    }
    {
        mixed[3] = (mixed[3] * 1664525u) + 1013904223u;
    }
    mixed = stir(mixed);
    {
        mixed[0] = mixed[0] ^ (mixed[0] >> 16);
    }
    {
        mixed[1] = mixed[1] ^ (mixed[1] >> 16);
    }
    {
        mixed[2] = mixed[2] ^ (mixed[2] >> 16);
    }
    {
        mixed[3] = mixed[3] ^ (mixed[3] >> 16);
    }
    return stir(mixed);
}

// Adds to each word the product of two others.
fn stir(argument_0: array<u32, 4>) -> array<u32, 4> {
    let x = argument_0[0];
    let y = argument_0[1];
    let z = argument_0[2];
    let w = argument_0[3];
    let x_1 = x + (y * w);
    let y_1 = y + (z * x_1);
    let z_1 = z + (x_1 * y_1);
    return array<u32, 4>(x_1, y_1, z_1, w + (y_1 * z_1));
}

// 32 bits as a binary fraction in [0, 1).
fn unit_interval(bits: u32) -> f32 {
    let high = f32(bitcast<i32>((bits >> 16)));
    let low = f32(bitcast<i32>((bits & 0xffffu)));
    let rounded = (high * 65536.0f) + low;
    return real_min(rounded * (1.0f / 4294967296.0f), float_ONE_MINUS_EPSILON);
}
