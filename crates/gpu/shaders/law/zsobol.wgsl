// Translated from crates/sampling/src/sampler/zsobol.rs
// by `cargo xtask wgsl`, which translates it again.

const zsobol_SCRAMBLES: u32 = 0x9e3779b9;

// Two-dimensional Sobol' points distributed over the picture along a Morton curve, in rounds of
// the next power of two of samples, each with scrambles of its own.
struct ZSobol {
    samples_per_pixel: u32,
    log2_samples: u32,
    log2_side: u32,
    randomize: u32,
    key: u32,
    address: Address,
}

// The coordinate at an address.
fn ZSobol_at_1d(this_: ZSobol, address: Address) -> f32 {
    let parts = ZSobol_point(this_, address);
    let low = parts[0];
    return Randomize_digits(this_.randomize, low, mix_word(ZSobol_hash(this_, address, zsobol_SCRAMBLES)));
}

// The two coordinates at an address.
fn ZSobol_at_2d(this_: ZSobol, address: Address) -> vec2f {
    let parts = ZSobol_point(this_, address);
    let low = parts[0];
    let high = parts[1];
    let seed = mix_word(ZSobol_hash(this_, address, zsobol_SCRAMBLES));
    let other = mix_word(seed + u32(zsobol_SCRAMBLES));
    return vec2f(Randomize_digits(this_.randomize, low, seed), Randomize_digits(this_.randomize, pascal_digits(low, high), other));
}

// A hash of dimension, seed and round.
fn ZSobol_hash(this_: ZSobol, address: Address, purpose: u32) -> u32 {
    let round_1 = address.index >> this_.log2_samples;
    let key = mix_word(this_.key ^ mix_word(round_1 + purpose));
    return mix_word(address.dimension ^ u32(key));
}

// A hash of the bits of a code from `lowest` on.
fn hash_above(bits: u32, lowest: u32, key: u32) -> u32 {
    return mix_word(bits ^ (key + u32(lowest)));
}

// The base-4 digit in the low two bits under one of the 24 permutations. Permutations of four
// digits are the affine maps of two bits: a·low ⊕ b·high ⊕ c, where a and b differ and are not 0.
fn zsobol_permuted(digit: u32, hash_1: u32) -> u32 {
    let a = (((hash_1 >> 16) * 3u) >> 16) + 1u;
    let next = select(a + 1u, 1u, a == 3u);
    let b = next ^ (a & (0u - ((hash_1 >> 2) & 1u)));
    let c = hash_1 & 3u;
    let low = digit & 1u;
    let high = (digit >> 1) & 1u;
    return ((a & (0u - low)) ^ (b & (0u - high))) ^ c;
}
