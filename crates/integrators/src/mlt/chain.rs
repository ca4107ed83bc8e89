//! One chain of Metropolis: a walk that stays at each point in proportion to a function c, and what its steps are worth.
//!
//! From x the walk proposes x', as likely as x from x', and accepts it with the probability a = min(1, c(x')/c(x)). Whatever the
//! walk had to do with c before, it keeps; so a walk that starts in the distribution c/b, where b = ∫ c, is in it at every step
//! [Veach 1997 §11.2]. What it finds is to be multiplied by b and divided by c.
//!
//! Nothing that was computed is wasted: x' counts for a of the step and x for 1 − a, which is what the choice between them would have
//! given on average. And large steps are uniform samples of the cube, good ones where c is small and the walk seldom goes. A point y
//! can come by both ways, and is weighed by the balance heuristic [Kelemen 2002 §5.2]: with p the probability of a large step, the walk is at y with the
//! density c/b and large steps arrive there with the density p, so that y is worth, as a state that counts for a share q of a step,
//!
//! ```text
//! (q·b + [large step]·b₀) / (c(y) + p·b₀)
//! ```
//!
//! The b₀ stands for b in the weights. The weights sum to one whatever it is, so the result is right if it is not chance that it shares with the
//! walk; b is that of the starting points themselves.

use sampling::{Rng, Sampler};

/// How chains move and what their states are worth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps {
    /// Probability of a large step.
    pub large: f32,
    /// The integral of c as estimated by the points among which starts were chosen.
    pub b: f32,
    /// Another estimate, independent of that.
    pub b0: f32,
}

impl Steps {
    /// What a state of importance `c` is worth that counts for a share of a step.
    fn worth(&self, share: f32, is_large: bool, c: f32) -> f32 {
        let density = c + self.large * self.b0;
        let of_large = if is_large { self.b0 } else { 0.0 };
        if density > 0.0 { (share * self.b + of_large) / density } else { 0.0 }
    }
}

/// A point, with what was found there.
#[derive(Clone, Copy, Debug)]
struct State<V> {
    value: V,
    c: f32,
    worth: f32,
}

/// How many steps were proposed and how many accepted, small ones and large ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Acceptance {
    pub proposed: [u64; 2],
    pub accepted: [u64; 2],
}

impl std::ops::AddAssign for Acceptance {
    fn add_assign(&mut self, other: Self) {
        for kind in 0..2 {
            self.proposed[kind] += other.proposed[kind];
            self.accepted[kind] += other.accepted[kind];
        }
    }
}

/// The samplers of a path, each a point of primary sample space; all together are the point that a chain moves.
pub(super) type Streams = [Sampler; 3];

fn each_sample(streams: &mut Streams, mut change: impl FnMut(&mut sampling::sampler::PrimarySample)) {
    for stream in streams {
        if let Sampler::PrimarySample(sample) = stream {
            change(sample);
        }
    }
}

/// A chain whose values are of the type `V`.
pub(super) struct Chain<V> {
    streams: Streams,
    rng: Rng,
    current: State<V>,
    acceptance: Acceptance,
}

impl<V> Chain<V> {
    /// Starts where the streams have been set to, and goes on with random numbers of a sequence of its own. `evaluate` tells what is found at a
    /// point and c there.
    pub fn new(mut streams: Streams, sequence: u64, evaluate: impl FnOnce(&mut Streams) -> (V, f32)) -> Self {
        let (value, c) = evaluate(&mut streams);
        let mut rng = Rng::from_sequence(sequence);
        each_sample(&mut streams, |sample| {
            sample.accept();
            sample.reseed(u64::from(rng.uniform_u32()) << 32 | u64::from(rng.uniform_u32()));
        });
        Self { streams, rng, current: State { value, c, worth: 0.0 }, acceptance: Acceptance::default() }
    }

    /// Takes a step, and leaves one of two points: gives what was found there and what it is worth.
    pub fn step(&mut self, steps: &Steps, evaluate: impl FnOnce(&mut Streams) -> (V, f32)) -> (V, f32) {
        let is_large = self.rng.uniform_f32() < steps.large;
        each_sample(&mut self.streams, |sample| sample.propose(is_large));
        let (value, c) = evaluate(&mut self.streams);
        let a = if c < self.current.c { c / self.current.c } else { 1.0 };
        self.current.worth += steps.worth(1.0 - a, false, self.current.c);
        let mut left = State { value, c, worth: steps.worth(a, is_large, c) };
        self.acceptance.proposed[usize::from(is_large)] += 1;
        if self.rng.uniform_f32() < a {
            self.acceptance.accepted[usize::from(is_large)] += 1;
            each_sample(&mut self.streams, |sample| sample.accept());
            std::mem::swap(&mut self.current, &mut left);
        }
        (left.value, left.worth)
    }

    /// Leaves the last point.
    pub fn end(self) -> ((V, f32), Acceptance) {
        ((self.current.value, self.current.worth), self.acceptance)
    }
}
