//! The chains of Metropolis light transport.

use super::record;

record! {
    /// Some of the steps of all chains. Step 0 is the start, and the one after the last leaves the
    /// point where the chain ends. Splats are those of the first step of all chains, then those of
    /// the next.
    pub struct Batch {
        /// The chains, the first of these steps, and how many there are.
        count: u32,
        step: u32,
        steps: u32,
        /// The mutations of a chain, of which the first ones have one more.
        mutations: u32,
        longer: u32,
        /// Of the random numbers of candidates, and of mutations.
        candidate_key: u32,
        key: u32,
        /// The standard deviation of a small step, and the probability of a large one.
        sigma: f32,
        large: f32,
        /// The mean scalar contribution, and another estimate of it.
        b: f32,
        b0: f32,
        unused: u32,
    }
    "splats: array<Splat>"
}

record! {
    /// A contribution to the film. The wavelength is the number that chose it.
    pub struct Splat {
        film: [f32; 2],
        wavelength: f32,
        unused: u32,
        l: [f32; 4],
    }
}
