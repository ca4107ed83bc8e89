// Translated from crates/sampling/src/sampler/randomize.rs
// by `cargo xtask wgsl`, which translates it again.

const Randomize_None = 0u;
const Randomize_PermuteDigits = 1u;
const Randomize_FastOwen = 2u;
const Randomize_Owen = 3u;

// The number with these 32 binary digits, the first of which is the lowest bit, randomised by
// `seed`.
fn Randomize_digits(this_: u32, digits: u32, seed: u32) -> f32 {
    var chosen: u32;
    if (this_ == Randomize_None) {
        chosen = digits;
    } else if (this_ == Randomize_PermuteDigits) {
        chosen = digits ^ reverse_bits(seed);
    } else if (this_ == Randomize_FastOwen) {
        chosen = fast_owen_scramble(digits, seed);
    } else {
        chosen = owen_scramble(digits, seed);
    }
    let digits_1 = chosen;
    return unit_interval(reverse_bits(digits_1));
}
