//! Mutations of a point in primary sample space, for Metropolis light transport.
//!
//! A path is a function of the random numbers that its algorithm draws: a point x of a unit cube,
//! the *primary sample space* [Kelemen 2002]. Metropolis methods propose a point x' near x or
//! anywhere, evaluate its path, and accept x' or stay at x:
//!
//! - a *small step* adds a normal deviate of standard deviation σ to each coordinate and wraps
//!   around the ends of [0, 1);
//! - a *large step* draws every coordinate anew.
//!
//! Both are symmetric: as likely from x' to x as from x to x'. The number of coordinates of a path
//! is not known beforehand, so that they are mutated lazily. Coordinates beyond those of the
//! current path are drawn anew, as nothing depends on them. Coordinates of the current path that
//! the proposed path does not use must make the step too, if it is accepted; after a large step
//! they are dropped, which is the same as drawing them anew.

use crate::warp::sample_two_normal;
use crate::{Rng, hash};
use math::{ONE_MINUS_EPSILON, Vec2};

/// A point of primary sample space.
///
/// [`Sampler::start_pixel_sample`](super::Sampler::start_pixel_sample) sets it to a uniform random
/// point, like that of [`Independent`](super::Independent), which counts as a proposal: it must be
/// accepted before the first step.
#[derive(Clone, Debug)]
pub struct PrimarySample {
    samples_per_pixel: u32,
    seed: u32,
    sigma: f32,
    rng: Rng,
    is_large: bool,
    /// The second of the last pair of normal deviates.
    spare: Option<f32>,
    current: Vec<f32>,
    proposed: Vec<f32>,
}

impl PrimarySample {
    /// Points whose small steps have the standard deviation `sigma`, above 0.
    pub fn new(samples_per_pixel: u32, sigma: f32, seed: u32) -> PrimarySample {
        PrimarySample {
            samples_per_pixel: samples_per_pixel.max(1),
            seed,
            sigma,
            rng: Rng::new(0, 0),
            is_large: true,
            spare: None,
            current: Vec::new(),
            proposed: Vec::new(),
        }
    }

    /// Draws everything from now on from a random sequence of its own.
    pub fn reseed(&mut self, sequence: u64) {
        self.rng = Rng::from_sequence(sequence);
        self.spare = None;
    }

    /// Proposes a step from the current point, and drops the last proposal. Coordinates are those
    /// of the proposed point from now on.
    pub fn propose(&mut self, large: bool) {
        self.is_large = large;
        self.proposed.clear();
    }

    /// Makes the proposed point the current one.
    pub fn accept(&mut self) {
        if !self.is_large {
            while self.proposed.len() < self.current.len() {
                self.get_1d();
            }
        }
        std::mem::swap(&mut self.current, &mut self.proposed);
        self.proposed.clear();
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        self.rng = pixel_rng(pixel, index, dimension, self.seed);
        self.spare = None;
        self.current.clear();
        self.propose(true);
    }

    #[inline]
    pub(super) fn dimension(&self) -> u32 {
        self.proposed.len() as u32
    }

    pub(super) fn get_1d(&mut self) -> f32 {
        let x = match self.origin() {
            None => self.rng.uniform_f32(),
            Some(x) => wrap(x + self.small_step()),
        };
        self.proposed.push(x);
        x
    }

    pub(super) fn get_2d(&mut self) -> Vec2 {
        let x = self.get_1d();
        Vec2::new(x, self.get_1d())
    }

    pub(super) fn get_pixel_2d(&mut self) -> Vec2 {
        self.get_2d()
    }

    fn small_step(&mut self) -> f32 {
        self.spare.take().unwrap_or_else(|| {
            let u = Vec2::new(self.rng.uniform_f32(), self.rng.uniform_f32());
            let steps = sample_two_normal(u, 0.0, self.sigma);
            self.spare = Some(steps.y);
            steps.x
        })
    }

    /// The value that the next coordinate steps from; `None` if it is drawn anew.
    fn origin(&self) -> Option<f32> {
        self.current.get(self.proposed.len()).copied().filter(|_| !self.is_large)
    }
}

/// A number wrapped to [0, 1).
fn wrap(x: f32) -> f32 {
    (x - x.floor()).min(ONE_MINUS_EPSILON)
}

/// A generator for one sample of a pixel: a sequence for the pixel, and 2¹⁶ numbers of it for
/// the sample.
fn pixel_rng(pixel: [i32; 2], index: u32, dimension: u32, seed: u32) -> Rng {
    let mut rng = Rng::from_sequence(hash(&[pixel[0] as u32, pixel[1] as u32, seed]));
    rng.advance(index as u64 * 65536 + dimension as u64);
    rng
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Chi2;

    fn started(sigma: f32, seed: u32) -> PrimarySample {
        let mut sample = PrimarySample::new(1, sigma, seed);
        sample.start_pixel_sample([0, 0], 0, 0);
        sample
    }

    fn draw(sample: &mut PrimarySample, count: usize) -> Vec<f32> {
        (0..count).map(|_| sample.get_1d()).collect()
    }

    #[test]
    fn small_steps_are_small_and_large_ones_are_not() {
        let mut sample = started(1e-3, 1);
        let from = draw(&mut sample, 6);
        sample.accept();
        sample.propose(false);
        let near = draw(&mut sample, 6);
        assert_ne!(near, from);
        for (a, b) in near.iter().zip(&from) {
            let distance = (a - b).abs();
            assert!(distance.min(1.0 - distance) < 6e-3, "{a} {b}");
        }
        sample.propose(true);
        let far = draw(&mut sample, 6);
        assert!(far.iter().zip(&from).any(|(a, b)| (a - b).abs() > 0.1));
    }

    #[test]
    fn rejected_proposals_change_nothing() {
        let mut sample = started(1e-4, 2);
        let from = draw(&mut sample, 3);
        sample.accept();
        for large in [true, false, true] {
            sample.propose(large);
            draw(&mut sample, 5);
        }
        sample.propose(false);
        for (a, b) in draw(&mut sample, 3).into_iter().zip(from) {
            assert!((a - b).abs() < 6e-4);
        }
    }

    #[test]
    fn unused_coordinates_take_small_steps_but_no_large_ones() {
        for large in [false, true] {
            let mut sample = started(1e-4, 3);
            let from = draw(&mut sample, 4);
            sample.accept();
            sample.propose(large);
            draw(&mut sample, 1);
            sample.accept();
            sample.propose(false);
            let last = draw(&mut sample, 4)[3];
            assert_ne!(last, from[3]);
            assert_eq!((last - from[3]).abs() < 1e-3, !large);
        }
    }

    #[test]
    fn uniform_points_stay_uniform_under_small_steps() {
        let mut sample = started(0.3, 4);
        let mut point = 0;
        let mut step = |_| {
            // From a new uniform point each time, so that the ends of the steps are independent.
            point += 1;
            sample.start_pixel_sample([point, 0], 0, 0);
            sample.get_2d();
            for _ in 0..3 {
                sample.accept();
                sample.propose(false);
                sample.get_2d();
            }
            Some(sample.proposed[..2].try_into().unwrap())
        };
        Chi2::default().rectangle([[0.0, 1.0]; 2], &mut step, |_| 1.0).unwrap();
    }

    #[test]
    fn small_steps_wrap_around() {
        assert_eq!(wrap(1.25), 0.25);
        assert_eq!(wrap(-0.25), 0.75);
        assert_eq!(wrap(1.0), 0.0);
        assert!(wrap(-1e-12) < 1.0);
    }
}
