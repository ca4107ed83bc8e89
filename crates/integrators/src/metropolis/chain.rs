//! One Metropolis Markov chain, whose stationary distribution is proportional to a function c, and
//! the weights of its states.
//!
//! From x the chain proposes x', with the same density as x from x', and accepts it with the
//! probability a = min(1, c(x')/c(x)). This keeps the density c/b, where b = ∫ c: a chain that
//! starts in it has it at every step [Veach 1997 §11.2]. A contribution has the weight b/c.
//!
//! Rejected proposals count as well: x' has the share a of the step and x the share 1 − a, the
//! expected value of the choice between them. Large steps are also uniform samples of the cube,
//! which are good where c is small. Both techniques can produce a point y, and are combined by the
//! balance heuristic [Kelemen 2002]: with p the probability of a large step, the chain is at y with
//! the density c/b and large steps arrive there with the density p, so that the weight of y, with a
//! share q of a step, is
//!
//! ```text
//! (q·b + [large step]·b₀) / (c(y) + p·b₀)
//! ```
//!
//! b₀ is an estimate of b in the MIS weights. They sum to one for any value, so the result is
//! unbiased if b₀ is independent of the chain; the other b is the estimate from the candidates
//! among which the start was chosen.

use sampling::sampler::PrimarySample;
use sampling::{Rng, Sampler};

/// The parameters of steps and of the weights of states.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steps {
    /// Probability of a large step.
    pub large: f32,
    /// The integral of c, estimated from the candidates among which starts were chosen.
    pub b: f32,
    /// Another estimate, independent of the first.
    pub b0: f32,
}

impl Steps {
    /// The weight of a state of importance `c` that has the given share of a step.
    fn weight(&self, share: f32, is_large: bool, c: f32) -> f32 {
        let density = c + self.large * self.b0;
        let of_large = if is_large { self.b0 } else { 0.0 };
        if density > 0.0 { (share * self.b + of_large) / density } else { 0.0 }
    }
}

/// A point with its contribution, importance and weight.
#[derive(Clone, Copy, Debug)]
struct State<V> {
    value: V,
    c: f32,
    weight: f32,
}

/// Numbers of proposed and of accepted steps, small and large.
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

/// The samplers of a path, each a point of primary sample space; together they are the state of a
/// chain.
pub(super) type Streams = [Sampler; 3];

fn each_sample(streams: &mut Streams, mut change: impl FnMut(&mut PrimarySample)) {
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
    /// Starts at the point of the streams, and continues with random numbers of the given sequence.
    /// `evaluate` returns the contribution of a point and its c.
    pub fn new(mut streams: Streams, sequence: u64, evaluate: impl FnOnce(&mut Streams) -> (V, f32)) -> Self {
        let (value, c) = evaluate(&mut streams);
        let mut rng = Rng::from_sequence(sequence);
        each_sample(&mut streams, |sample| {
            sample.accept();
            sample.reseed(u64::from(rng.uniform_u32()) << 32 | u64::from(rng.uniform_u32()));
        });
        Self { streams, rng, current: State { value, c, weight: 0.0 }, acceptance: Acceptance::default() }
    }

    /// Takes a step. Returns the contribution and the weight of the one of the two points that the
    /// chain leaves.
    pub fn step(&mut self, steps: &Steps, evaluate: impl FnOnce(&mut Streams) -> (V, f32)) -> (V, f32) {
        let is_large = self.rng.uniform_f32() < steps.large;
        each_sample(&mut self.streams, |sample| sample.propose(is_large));
        let (value, c) = evaluate(&mut self.streams);
        let a = if c < self.current.c { c / self.current.c } else { 1.0 };
        self.current.weight += steps.weight(1.0 - a, false, self.current.c);
        let mut left = State { value, c, weight: steps.weight(a, is_large, c) };
        self.acceptance.proposed[usize::from(is_large)] += 1;
        if self.rng.uniform_f32() < a {
            self.acceptance.accepted[usize::from(is_large)] += 1;
            each_sample(&mut self.streams, |sample| sample.accept());
            std::mem::swap(&mut self.current, &mut left);
        }
        (left.value, left.weight)
    }

    /// Ends the chain. Returns the contribution and the weight of its last point.
    pub fn end(self) -> ((V, f32), Acceptance) {
        ((self.current.value, self.current.weight), self.acceptance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Vec2;
    use testkit::{Chi2, Moments, integrate, t_test};

    /// A narrow hill on a plain.
    fn hill(x: f64, y: f64) -> f64 {
        let (dx, dy) = (x - 0.3, y - 0.85);
        (-(dx * dx + dy * dy) / (2.0 * 0.1 * 0.1)).exp() + 0.1
    }

    fn evaluate([first, second, _]: &mut Streams) -> (Vec2, f32) {
        let p = Vec2::new(first.get_1d(), second.get_1d());
        (p, hill(f64::from(p.x), f64::from(p.y)) as f32)
    }

    fn streams(sigma: f32, index: i32) -> Streams {
        [0, 1, 2].map(|seed| {
            let mut sampler = Sampler::PrimarySample(PrimarySample::new(1, sigma, seed));
            sampler.start_pixel_sample([index, 0], 0, 0);
            sampler
        })
    }

    fn volume(range: [[f64; 2]; 2]) -> f64 {
        integrate(&hill, range, 1e-9)
    }

    #[test]
    fn a_chain_keeps_the_distribution_of_the_target() {
        let b = volume([[0.0, 1.0]; 2]);
        for (test, (large, sigma)) in [(0.0, 0.1), (0.3, 0.02), (1.0, 0.1)].into_iter().enumerate() {
            let steps = Steps { large, b: 1.0, b0: 1.0 };
            let mut candidate = 0;
            let chi2 = Chi2 { tests: 3, samples: 60_000, seed: test as u64, ..Chi2::default() };
            let end = |u: [f32; 2]| {
                // The start is chosen by rejection sampling.
                let mut chain = loop {
                    candidate += 1;
                    let chain = Chain::new(streams(sigma, candidate), candidate as u64, evaluate);
                    let height = 1.1 * sampling::hash_float(&[candidate as u32, 9]);
                    if height < chain.current.c {
                        break chain;
                    }
                };
                for _ in 0..(1.0 + u[0] * 8.0) as u32 {
                    chain.step(&steps, evaluate);
                }
                Some(chain.end().0.0.to_array())
            };
            chi2.rectangle([[0.0, 1.0]; 2], end, |[x, y]| hill(f64::from(x), f64::from(y)) / b).unwrap();
        }
    }

    /// The integral over a region of the plane, estimated by chains that start at one of a few
    /// candidates, with any b₀.
    #[test]
    fn weighted_states_estimate_the_integral() {
        const STEPS: u32 = 6;
        let regions = [[[0.0, 1.0], [0.0, 1.0]], [[0.2, 0.4], [0.8, 1.0]], [[0.6, 1.0], [0.0, 0.5]]];
        let cases = [(0.3, 0.05, 0.2), (0.3, 0.05, 1.0), (0.0, 0.05, 0.2), (1.0, 0.05, 0.2), (0.5, 0.3, 0.0)];
        for (large, sigma, b0) in cases {
            let mut found = [Moments::default(); 3];
            for run in 0..20_000 {
                let candidates = [0, 1, 2].map(|i| 3 * run + i);
                let weights = candidates.map(|i| evaluate(&mut streams(sigma, i)).1);
                let sum: f32 = weights.iter().sum();
                let mut place = sum * sampling::hash_float(&[run as u32, 5]);
                let chosen = weights.iter().position(|weight| {
                    place -= weight;
                    place < 0.0
                });
                let start = candidates[chosen.unwrap_or(2)];
                let steps = Steps { large, b: sum / 3.0, b0 };
                let mut chain = Chain::new(streams(sigma, start), run as u64, evaluate);
                let mut weight = [0.0; 3];
                let mut add = |(p, more): (Vec2, f32)| {
                    let c = hill(f64::from(p.x), f64::from(p.y));
                    for (weight, [x, y]) in weight.iter_mut().zip(regions) {
                        let inside =
                            |range: [f64; 2], at: f32| range[0] <= at.into() && f64::from(at) < range[1];
                        if inside(x, p.x) && inside(y, p.y) {
                            *weight += c * f64::from(more) / f64::from(STEPS);
                        }
                    }
                };
                (0..STEPS).for_each(|_| add(chain.step(&steps, evaluate)));
                add(chain.end().0);
                found.iter_mut().zip(weight).for_each(|(found, weight)| found.push(weight));
            }
            for (found, region) in found.iter().zip(regions) {
                t_test(found, volume(region), 15)
                    .unwrap_or_else(|e| panic!("{large} {sigma} {b0} {region:?}: {e}"));
            }
        }
    }
}
