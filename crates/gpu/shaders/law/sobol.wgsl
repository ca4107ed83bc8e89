// Translated from crates/sampling/src/low_discrepancy/sobol.rs
// by `cargo xtask wgsl`, which translates it again.

// The digits of the coordinate in dimension 1 of the point whose index has these two words. Its
// matrix is Pascal's triangle modulo 2: digit r is the sum over k of C(k, r)·bit k of the index.
// That is the Kronecker power of ((1, 1), (0, 1)), applied level by level without branches: the
// last level adds the digits of the high word to those of the low one.
fn pascal_digits(low: u32, high: u32) -> u32 {
    var digits = low ^ high;
    {
        digits = digits ^ ((digits >> (1 << 0)) & 0x55555555u);
    }
    {
        digits = digits ^ ((digits >> (1 << 1)) & 0x33333333u);
    }
    {
        digits = digits ^ ((digits >> (1 << 2)) & 0x0f0f0f0fu);
    }
    {
        digits = digits ^ ((digits >> (1 << 3)) & 0x00ff00ffu);
    }
    {
        digits = digits ^ ((digits >> (1 << 4)) & 0x0000ffffu);
    }
    return digits;
}

// Owen scrambling of binary digits, the first of which is the lowest bit: each is flipped or not
// by a hash of the digits before it and `seed`.
fn owen_scramble(digits: u32, seed: u32) -> u32 {
    var v = digits;
    var before = 0u;
    for (var b = 0u; b < 32; b++) {
        v = v ^ (mix_word((v & before) ^ seed) & u32(1 << b));
        before = (before << 1) | 1u;
    }
    return v;
}

// A scrambling of the same form as [`owen_scramble`], by a hash in which bits act only on higher
// ones.
fn fast_owen_scramble(digits: u32, seed: u32) -> u32 {
    let v = (digits ^ (digits * 0x3d20adeau)) + seed;
    let v_1 = v * ((seed >> 16) | 1u);
    let v_2 = v_1 ^ (v_1 * 0x05526c56u);
    return v_2 ^ (v_2 * 0x53a22864u);
}

// The word whose bits are in reverse order.
fn reverse_bits(v: u32) -> u32 {
    let v_1 = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
    let v_2 = ((v_1 >> 2) & 0x33333333u) | ((v_1 & 0x33333333u) << 2);
    let v_3 = ((v_2 >> 4) & 0x0f0f0f0fu) | ((v_2 & 0x0f0f0f0fu) << 4);
    let v_4 = ((v_3 >> 8) & 0x00ff00ffu) | ((v_3 & 0x00ff00ffu) << 8);
    return (v_4 >> 16) | (v_4 << 16);
}
