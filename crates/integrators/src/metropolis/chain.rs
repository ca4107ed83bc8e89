//! One Markov chain of Metropolis, which visits each point in proportion to a function c, and the
//! weights of its states.
//!
//! From x the walk proposes x', as likely as x from x', and accepts it with the probability a =
//! min(1, c(x')/c(x)). Whatever the walk had to do with c before, it keeps; so a walk that starts
//! in the distribution c/b, where b = ∫ c, is in it at every step [Veach 1997 §11.2]. What it finds
//! is to be multiplied by b and divided by c.
//!
//! Nothing that was computed is wasted: x' counts for a of the step and x for 1 − a, which is what
//! the choice between them would have given on average. And large steps are uniform samples of the
//! cube, good ones where c is small and the walk seldom goes. A point y can come by both ways, and
//! is weighed by the balance heuristic [Kelemen 2002]: with p the probability of a large step, the
//! walk is at y with the density c/b and large steps arrive there with the density p, so that y is
//! worth, as a state that counts for a share q of a step,
//!
//! ```text
//! (q·b + [large step]·b₀) / (c(y) + p·b₀)
//! ```
//!
//! The b₀ stands for b in the weights. They sum to one whatever it is, so the result is right if b₀
//! knows nothing of the walk; the b outside them is that of the points among which the start was
//! chosen.

use sampling::sampler::PrimarySample;
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

/// The samplers of a path, each a point of primary sample space; all together are the point that a
/// chain moves.
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
    /// Starts where the streams have been set to, and goes on with random numbers of a sequence of
    /// its own. `evaluate` tells what is found at a point and c there.
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
    fn a_chain_that_starts_in_the_distribution_of_the_target_stays_in_it() {
        let b = volume([[0.0, 1.0]; 2]);
        for (test, (large, sigma)) in [(0.0, 0.1), (0.3, 0.02), (1.0, 0.1)].into_iter().enumerate() {
            let steps = Steps { large, b: 1.0, b0: 1.0 };
            let mut candidate = 0;
            let chi2 = Chi2 { tests: 3, samples: 60_000, seed: test as u64, ..Chi2::default() };
            let end = |u: [f32; 2]| {
                // Start by rejection.
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

    /// What a region of the plane is worth by chains that start at one of a few candidates,
    /// whatever else is taken for b.
    #[test]
    fn what_is_found_on_the_way_is_worth_its_part_of_the_integral() {
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
                let mut worth = [0.0; 3];
                let mut add = |(p, more): (Vec2, f32)| {
                    let c = hill(f64::from(p.x), f64::from(p.y));
                    for (worth, [x, y]) in worth.iter_mut().zip(regions) {
                        let inside =
                            |range: [f64; 2], at: f32| range[0] <= at.into() && f64::from(at) < range[1];
                        if inside(x, p.x) && inside(y, p.y) {
                            *worth += c * f64::from(more) / f64::from(STEPS);
                        }
                    }
                };
                (0..STEPS).for_each(|_| add(chain.step(&steps, evaluate)));
                add(chain.end().0);
                found.iter_mut().zip(worth).for_each(|(found, worth)| found.push(worth));
            }
            for (found, region) in found.iter().zip(regions) {
                t_test(found, volume(region), 15)
                    .unwrap_or_else(|e| panic!("{large} {sigma} {b0} {region:?}: {e}"));
            }
        }
    }
}
