// The sampler `paddedsobol`. Words of 64 bits are pairs of a low and a high one.

const MURMUR = vec2u(0x5bd1e995u, 0xc6a4a793u);

// The lower 64 bits of a product.
fn wide_product(a: vec2u, b: vec2u) -> vec2u {
    let al = a.x & 0xffff;
    let ah = a.x >> 16;
    let bl = b.x & 0xffff;
    let bh = b.x >> 16;
    let low = al * bl;
    let middle = (low >> 16) + ((al * bh) & 0xffff) + ((ah * bl) & 0xffff);
    let high = ah * bh + (al * bh >> 16) + (ah * bl >> 16) + (middle >> 16);
    return vec2u(middle << 16 | low & 0xffff, high + a.x * b.y + a.y * b.x);
}

// A word and what its bits from 47 on are.
fn folded(a: vec2u) -> vec2u {
    return vec2u(a.x ^ a.y >> 15, a.y);
}

// The steps of `hash` of `sampling/src/hash.rs`: the first of so many words, one of two words, and
// the last.
fn hash_begin(words: u32) -> vec2u {
    return wide_product(vec2u(4 * words, 0), MURMUR);
}

fn hash_step(h: vec2u, words: vec2u) -> vec2u {
    let k = folded(wide_product(words, MURMUR));
    return wide_product(h ^ wide_product(k, MURMUR), MURMUR);
}

fn hash_end(h: vec2u) -> vec2u {
    return folded(wide_product(folded(h), MURMUR));
}

// `permutation_element` of the same file.
fn permuted_index(index: u32, length: u32, seed: u32) -> u32 {
    var mask = 0u;
    if (length > 1) {
        mask = 0xffffffffu >> (31 - firstLeadingBit(length - 1));
    }
    var i = index;
    loop {
        i = (i ^ seed) * 0xe170893du;
        i ^= seed >> 16;
        i ^= (i & mask) >> 4;
        i = (i ^ seed >> 8) * 0x0929eb3fu;
        i ^= seed >> 23;
        i ^= (i & mask) >> 1;
        i = i * (1 | seed >> 27) * 0x6935fa69u;
        i ^= (i & mask) >> 11;
        i *= 0x74dcb303u;
        i ^= (i & mask) >> 2;
        i *= 0x9e501cc3u;
        i ^= (i & mask) >> 2;
        i = (i * 0xc860a3dfu) & mask;
        i ^= i >> 5;
        if (i < length) {
            break;
        }
    }
    return (i + seed % length) % length;
}

// One or two coordinates at an address.
fn padded_sobol(address: Address, seed: u32, samples: u32, randomize: u32, is_pair: bool) -> vec2f {
    let pixel = hash_step(hash_begin(4), vec2u(address.pixel[0], address.pixel[1]));
    let hash = hash_end(hash_step(pixel, vec2u(address.dimension, seed)));
    let round = address.index / samples;
    var shuffle = hash.x;
    if (round > 0) {
        shuffle = hash_end(hash_step(hash_begin(2), vec2u(hash.x, round))).x;
    }
    let index = round * samples + permuted_index(address.index % samples, samples, shuffle);
    if (!is_pair) {
        return vec2f(Randomize_digits(randomize, index, hash.y), 0);
    }
    return vec2f(
        Randomize_digits(randomize, index, hash.x),
        Randomize_digits(randomize, pascal_digits(index, 0), hash.y),
    );
}
