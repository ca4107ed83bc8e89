// Translated from crates/sampling/src/hash.rs by `cargo xtask wgsl`, which translates it again.

// A bijection of 32-bit words under which each input bit changes about half of the output bits:
// `lowbias32` of [Wellons 2018].
fn mix_word(v: u32) -> u32 {
    let v_1 = (v ^ (v >> 16)) * 0x7feb352du;
    let v_2 = (v_1 ^ (v_1 >> 15)) * 0x846ca68bu;
    return v_2 ^ (v_2 >> 16);
}

// 32 bits as a binary fraction in [0, 1).
fn unit_interval(bits: u32) -> f32 {
    let high = f32(bitcast<i32>((bits >> 16)));
    let low = f32(bitcast<i32>((bits & 0xffffu)));
    let rounded = (high * 65536.0f) + low;
    return real_min(rounded * (1.0f / 4294967296.0f), float_ONE_MINUS_EPSILON);
}
