// Random words that follow from a seed: `sampling/src/rng.rs` and `hash.rs`, with 64-bit words as
// pairs of their low and high half.

fn wide_mixed(v: vec2u, bits: u32) -> vec2u {
    return v ^ shifted_right(v, bits);
}

// The hash of one word.
fn hash_of_word(word: u32) -> vec2u {
    return hash_end(wide_product(hash_begin(1) ^ vec2u(word, 0), MURMUR));
}

// The hash of two words.
fn hash_of_pair(words: vec2u) -> vec2u {
    return hash_end(hash_step(hash_begin(2), words));
}

struct Generator {
    state: vec2u,
    increment: vec2u,
}

// The generator of a sequence.
fn generator(sequence: vec2u) -> Generator {
    var v = wide_product(wide_mixed(sequence, 31), vec2u(0x728ea185u, 0x7fb5d329u));
    v = wide_product(wide_mixed(v, 27), vec2u(0xbc2dd44du, 0x81dadef4u));
    let offset = wide_mixed(v, 33);
    let increment = vec2u((sequence.x << 1) | 1, (sequence.y << 1) | (sequence.x >> 31));
    // The state 0 is followed by the increment.
    var made = Generator(wide_sum(increment, offset), increment);
    generated_word(&made);
    return made;
}

fn generated_word(it: ptr<function, Generator>) -> u32 {
    let old = (*it).state;
    (*it).state = wide_sum(wide_product(old, vec2u(0x4c957f2du, 0x5851f42du)), (*it).increment);
    let word = shifted_right(wide_mixed(old, 18), 27).x;
    let turn = old.y >> 27;
    return (word >> turn) | (word << ((32 - turn) & 31));
}
