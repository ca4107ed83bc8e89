// The digit that keys are sorted by: eight bits of them.

const DIGITS = 256u;

// Keys of a block, and of each of its threads.
const BLOCK = 2048u;
const ROUNDS = 8u;

fn digit_of(key: u32) -> u32 {
    return (key >> (8 * plan.step)) & 255;
}
