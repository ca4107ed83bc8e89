//! Numbers to compute with, and the instruction sets that do it.

use alhazen_lanes::InstructionSet;

/// Floats for which an operation may differ from what it gives for others.
pub const SPECIAL: [f32; 24] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    1.5,
    -2.5,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    f32::from_bits(0xff80_0001),
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    1e-42,
    -1e-45,
    1e-30,
    8_388_607.5,
    -8_388_607.5,
    8_388_609.0,
    2_147_483_600.0,
    -2_147_483_600.0,
    -4e9,
];

/// The instruction sets that this processor has.
pub fn available() -> impl Iterator<Item = InstructionSet> {
    InstructionSet::ALL.into_iter().filter(|set| set.is_available())
}

/// A small hash of a counter.
pub fn hash(counter: u32) -> u32 {
    let x = counter.wrapping_mul(0x9e37_79b9) ^ 0x5bd1_e995;
    let x = (x ^ x >> 16).wrapping_mul(0x85eb_ca6b);
    (x ^ x >> 13).wrapping_mul(0xc2b2_ae35)
}

/// Floats of all sizes, numbers near to each other, and special ones.
pub fn number(counter: u32) -> f32 {
    let bits = hash(counter);
    match bits % 4 {
        0 => SPECIAL[(bits >> 8) as usize % SPECIAL.len()],
        1 => f32::from_bits(bits),
        _ => 1.0 + (bits >> 16) as f32 * f32::EPSILON,
    }
}

/// Integers of all sizes, and those where a sign or a carry changes.
pub fn integer(counter: u32) -> u32 {
    const SPECIAL: [u32; 8] = [0, 1, 2, 0x7fff_ffff, 0x8000_0000, 0x8000_0001, 0xffff_fffe, 0xffff_ffff];
    let bits = hash(counter);
    match bits % 4 {
        0 => SPECIAL[(bits >> 8) as usize % SPECIAL.len()],
        _ => hash(bits) >> (bits >> 27),
    }
}
