// Translated from crates/sampling/src/hash_sequence.rs
// by `cargo xtask wgsl`, which translates it again.

// A sequence of random numbers for each lane, which depends on some words alone: the images
// under a hash function of multiples of 2³²/φ, from a hash of the words on.
struct HashSequence {
    state: u32,
}

// 32 uniform bits.
fn HashSequence_word(this_: ptr<function, HashSequence>) -> u32 {
    (*this_).state = (*this_).state + 0x9e3779b9u;
    return mix_word((*this_).state);
}

// A uniform number in [0, 1).
fn HashSequence_get_1d(this_: ptr<function, HashSequence>) -> f32 {
    let result = HashSequence_word(this_);
    return unit_interval(result);
}

// A uniform point of the unit square.
fn HashSequence_get_2d(this_: ptr<function, HashSequence>) -> vec2f {
    let result = HashSequence_get_1d(this_);
    let result_1 = HashSequence_get_1d(this_);
    return vec2f(result, result_1);
}
