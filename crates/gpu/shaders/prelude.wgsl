// What translated laws use and WGSL has not.

// The bits of infinity. As a variable, because no constant may be infinite.
var<private> infinity_bits: u32 = 0x7f800000u;

fn infinity() -> f32 {
    return bitcast<f32>(infinity_bits);
}

fn not_a_number() -> f32 {
    return bitcast<f32>(infinity_bits | 0x400000u);
}

// The smaller of the two; `b` where either is NaN or both are zeros.
fn real_min(a: f32, b: f32) -> f32 {
    return select(b, a, a < b);
}

// The larger of the two; `b` where either is NaN or both are zeros.
fn real_max(a: f32, b: f32) -> f32 {
    return select(b, a, a > b);
}

// The magnitude of `x` with the sign of `sign`.
fn copysign(x: f32, sign: f32) -> f32 {
    return bitcast<f32>((bitcast<u32>(x) & 0x7fffffffu) | (bitcast<u32>(sign) & 0x80000000u));
}

// The nearest integer, as a float and as an integer in two's complement.
fn function_round(x: f32) -> Tuple_f32_u32 {
    let n = round(x);
    return Tuple_f32_u32(n, bitcast<u32>(i32(n)));
}

// An angle of 0 to 800 as a multiple of π/2 and a rest of at most π/4; larger angles lose digits.
fn circular_reduce(x: f32) -> Tuple_f32_u32 {
    let parts = function_round(x * 0.63661975f);
    let n = parts.v0;
    // π/2 in three parts, of which two have 15 bits, so that products with n are exact.
    let rest = (x - n * 1.5708008f) - n * -4.454516e-6f;
    return Tuple_f32_u32(rest - n * 6.0771006e-11f, parts.v1);
}

// The permutation of noise, four numbers a word.
var<private> permutation: array<u32, 64> = array(
    0x5b89a097u, 0x0d830f5au, 0x35605fc9u, 0xe107e9c2u, 0x1e67248cu, 0x63088e45u, 0x0a15f025u, 0x9406be17u,
    0x4bea78f7u, 0x3ec51a00u, 0xcbdbfc5eu, 0x200b2375u, 0x5821b139u, 0x573895edu, 0x887d14aeu, 0xaf44a8abu,
    0x8647a54au, 0xa61b308bu, 0xe79e924du, 0x7ae56f53u, 0xe685d33cu, 0x295c69dcu, 0x28f52e37u, 0x368f66f4u,
    0xa13f1941u, 0x4950d801u, 0xbb844cd1u, 0xa91259d0u, 0x8287c4c8u, 0x569fbc74u, 0xc66d64a4u, 0x4003baadu,
    0xfae2d934u, 0xca057b7cu, 0x7e769326u, 0xd45552ffu, 0xe33bcecfu, 0x113a102fu, 0x2a1cbdb6u, 0xd5aab7dfu,
    0x0298f877u, 0x46a39a2cu, 0x9b6599ddu, 0x09ac2ba7u, 0xfd271681u, 0x6e6c6213u, 0xe8e0714fu, 0x6870b9b2u,
    0xe461f6dau, 0xc1f222fbu, 0x0c90d2eeu, 0xf1a2b3bfu, 0xeb913351u, 0x6bef0ef9u, 0x1fd6c031u, 0x9d6ac7b5u,
    0xb0cc54b8u, 0x2d327973u, 0xfe96047fu, 0x5dcdec8au, 0x1d4372deu, 0x8df34818u, 0x424ec380u, 0xb49c3dd7u,
);

// The permutation at an index below 512, of which the second half repeats the first.
fn noise_permuted(index: u32) -> u32 {
    return (permutation[(index >> 2) & 63] >> (8 * (index & 3))) & 255;
}

// Two words shifted right together.
fn shifted_right(words: vec2u, bits: u32) -> vec2u {
    if (bits == 0) {
        return words;
    }
    if (bits < 32) {
        return vec2u((words.x >> bits) | (words.y << (32 - bits)), words.y >> bits);
    }
    return vec2u(select(0, words.y >> (bits - 32), bits < 64), 0);
}

// A hash of the bits of a code from `lowest` on.
fn hash_of_digits(code: vec2u, lowest: u32, is_wide: bool, key: u32) -> u32 {
    let bits = shifted_right(code, lowest);
    return hash_above(select(bits.x, bits.x ^ mix_word(bits.y), is_wide), lowest, key);
}

// The point of the sequence that a sample takes, as low and high word.
fn ZSobol_point(this_: ZSobol, address: Address) -> array<u32, 2> {
    let side = min(this_.log2_side, 32);
    let log2 = this_.log2_samples;
    let kept = select(0xffffffffu, (1u << side) - 1, side < 32);
    let x = address.pixel[0] & kept;
    let y = address.pixel[1] & kept;
    var code = vec2u(interleaved(x, y), interleaved(x >> 16, y >> 16));
    if (log2 > 0) {
        let index = address.index & ((1u << log2) - 1);
        code = vec2u((code.x << log2) | index, (code.y << log2) | (code.x >> (32 - log2)));
    }
    let key = ZSobol_hash(this_, address, 0);
    let is_wide = 2 * side + log2 > 32;
    let odd = log2 & 1;
    var point = vec2u();
    for (var place = side + log2 / 2; place > 0; place--) {
        let shift = 2 * (place - 1) + odd;
        let hash = hash_of_digits(code, shift + 2, is_wide, key);
        let digit = zsobol_permuted(shifted_right(code, shift).x, hash);
        point = vec2u((point.x << 2) | digit, (point.y << 2) | (point.x >> 30));
    }
    if (odd == 1) {
        let digit = (code.x ^ hash_of_digits(code, 1, is_wide, key)) & 1;
        point = vec2u((point.x << 1) | digit, (point.y << 1) | (point.x >> 31));
    }
    return array(point.x, point.y);
}
