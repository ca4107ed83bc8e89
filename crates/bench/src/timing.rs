//! Timing in CPU seconds, which other programs' time slices do not inflate, and with alternating
//! runs, so that disturbances affect all candidates alike.

use cpu_time::{ProcessTime, ThreadTime};
use std::time::Instant;

/// Runs each of `ways` in alternation, `repeats` times, on this thread. Returns for each the median
/// of its CPU seconds, and its last result.
pub fn in_turn<T>(ways: &[impl Fn() -> T], repeats: usize) -> Vec<(f64, T)> {
    let mut rounds: Vec<Vec<(f64, T)>> = ways.iter().map(|_| Vec::new()).collect();
    for _ in 0..repeats {
        for (runs, way) in rounds.iter_mut().zip(ways) {
            let start = ThreadTime::now();
            let result = way();
            runs.push((start.elapsed().as_secs_f64(), result));
        }
    }
    rounds
        .into_iter()
        .filter_map(|mut runs| {
            let seconds = median(runs.iter().map(|run| run.0).collect());
            runs.pop().map(|(_, result)| (seconds, result))
        })
        .collect()
}

/// Time taken by work on all threads of the program.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seconds {
    /// Wall-clock time.
    pub wall: f64,
    /// CPU time.
    pub cpu: f64,
}

impl Seconds {
    /// Times `work`, and returns its result.
    pub fn of<T>(work: impl FnOnce() -> T) -> (Self, T) {
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        let result = work();
        (Self { wall: wall.elapsed().as_secs_f64(), cpu: cpu.elapsed().as_secs_f64() }, result)
    }

    /// The medians of several runs.
    pub fn median(runs: &[Self]) -> Self {
        Self {
            wall: median(runs.iter().map(|run| run.wall).collect()),
            cpu: median(runs.iter().map(|run| run.cpu).collect()),
        }
    }
}

/// The median, the upper one of two; NaN where there is no value.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
