//! Computations in lanes, whose results must not depend on the number of lanes.

use crate::Random;
use lanes::{InstructionSet, Kernel, MAX_LANES, Real};
use std::array::from_fn;

/// A computation that is the same in each lane.
pub trait LaneFunction {
    /// Its results for uniform numbers `u` in [0, 1). Implementations are `#[inline(always)]`.
    fn results<R: Real>(&self, u: &[R]) -> Vec<R>;
}

/// Asserts that each lane of the instruction sets that processors choose gives the bits of single
/// floats, for `rounds` times `count` numbers per lane. A quarter of the numbers are multiples of
/// ¼, so that special cases occur. All NaNs count as the same.
///
/// Sets that no processor of this build chooses are those of other builds; the operations of all
/// sets are compared in the tests of `lanes`.
///
/// # Panics
/// If any bit differs.
pub fn lanes_agree(function: &impl LaneFunction, count: usize, rounds: usize) {
    let mut random = Random::new(1);
    for _ in 0..rounds {
        let numbers: Vec<[f32; MAX_LANES]> = (0..count)
            .map(|_| {
                from_fn(|_| match random.get_2d() {
                    [choice, u] if choice < 0.25 => (4.0 * u).floor() / 4.0,
                    [_, u] => u,
                })
            })
            .collect();
        let run = Run { function, numbers: &numbers };
        let expected = run.run::<f32>();
        for set in InstructionSet::CHOSEN.iter().filter(|set| set.is_available()) {
            let found = set.dispatch_large(run);
            assert_eq!(found.len(), expected.len());
            for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
                assert_eq!(found.map(bits), expected.map(bits), "result {i} of {set:?}");
            }
        }
    }
}

/// The bits of a number; the same for all NaNs.
fn bits(x: f32) -> u32 {
    if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() }
}

/// A function and the numbers of all lanes.
struct Run<'a, F> {
    function: &'a F,
    numbers: &'a [[f32; MAX_LANES]],
}

impl<F> Clone for Run<'_, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Run<'_, F> {}

impl<F: LaneFunction> Kernel for Run<'_, F> {
    type Output = Vec<[f32; MAX_LANES]>;

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let mut all = Vec::new();
        for first in (0..MAX_LANES).step_by(R::LANES) {
            let u: Vec<R> = self.numbers.iter().map(|lanes| R::load(&lanes[first..])).collect();
            let results = self.function.results(&u);
            all.resize(results.len(), [0.0; MAX_LANES]);
            for (lanes, result) in all.iter_mut().zip(results) {
                result.store(&mut lanes[first..]);
            }
        }
        all
    }
}
