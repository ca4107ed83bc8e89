//! Pearson's χ² test of a sampling routine against its density.
//!
//! The domain is divided into cells. For each, the density's integral times the number of samples,
//! E, is compared with the observed count O: χ² = Σ (O − E)² / E. Cells with E below
//! [`Chi2::min_expected`] are pooled. Failed samples (`None`) are counted in a cell of their own,
//! which expects one minus the integral of the density. The idea is that of [Jakob 2010] (Nori) and
//! [Pharr 2023 §9.8].

use crate::quadrature::{integrate, search};
use crate::{Random, SIGNIFICANCE, chi2_cdf, sidak};
use std::f64::consts::PI;
use std::fmt::Write;

/// A χ² test: its grid and size. Every method returns `Err` with a table of the worst cells when
/// the samples do not have the given density.
///
/// ```
/// use alhazen_testkit::Chi2;
/// let cosine = |z: f32| (z.max(0.0) / std::f32::consts::PI) as f64;
/// let sample = |u: [f32; 2]| {
///     let (z, phi) = ((1.0 - u[0]).sqrt(), std::f32::consts::TAU * u[1]);
///     Some([u[0].sqrt() * phi.cos(), u[0].sqrt() * phi.sin(), z])
/// };
/// Chi2 { tests: 3, ..Chi2::default() }.sphere(sample, |w| cosine(w[2])).unwrap();
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Chi2 {
    /// Cells along the first and second coordinate (θ and φ on the sphere).
    pub bins: [usize; 2],
    /// Number of samples.
    pub samples: usize,
    /// The expectation below which cells are pooled.
    pub min_expected: f64,
    /// Number of tests that share [`SIGNIFICANCE`].
    pub tests: usize,
    /// Seed of the uniform numbers for the routine.
    pub seed: u64,
}

impl Default for Chi2 {
    fn default() -> Chi2 {
        Chi2 { bins: [16, 32], samples: 200_000, min_expected: 5.0, tests: 1, seed: 0 }
    }
}

/// A histogram cell: its name, expected and observed counts.
struct Cell {
    place: [[f64; 2]; 2],
    expected: f64,
    observed: u64,
}

impl Chi2 {
    /// Directions: `sample` maps a point of the unit square to a unit vector, or to none; `pdf` is
    /// per solid angle.
    pub fn sphere(
        &self,
        mut sample: impl FnMut([f32; 2]) -> Option<[f32; 3]>,
        pdf: impl Fn([f32; 3]) -> f64,
    ) -> Result<(), String> {
        let mut off_sphere = None;
        let to_angles = |u| {
            let w = sample(u)?;
            let [x, y, z] = w.map(f64::from);
            let length = (x * x + y * y + z * z).sqrt();
            if length.is_nan() || (length - 1.0).abs() > 1e-3 {
                off_sphere = Some(w);
            }
            let phi = y.atan2(x);
            Some([x.hypot(y).atan2(z), if phi < 0.0 { phi + 2.0 * PI } else { phi }])
        };
        let density = |theta: f64, phi: f64| {
            let (sin_theta, cos_theta) = theta.sin_cos();
            sin_theta * pdf([sin_theta * phi.cos(), sin_theta * phi.sin(), cos_theta].map(|x| x as f32))
        };
        let verdict = self.run([[0.0, PI], [0.0, 2.0 * PI]], to_angles, density);
        match off_sphere {
            Some(w) => Err(format!("{w:?} is not a unit vector")),
            None => verdict,
        }
    }

    /// Points in a rectangle `[[x0, x1], [y0, y1]]`; `pdf` is per area.
    pub fn rectangle(
        &self,
        bounds: [[f32; 2]; 2],
        mut sample: impl FnMut([f32; 2]) -> Option<[f32; 2]>,
        pdf: impl Fn([f32; 2]) -> f64,
    ) -> Result<(), String> {
        let bounds = bounds.map(|range| range.map(f64::from));
        self.run(bounds, |u| sample(u).map(|p| p.map(f64::from)), |x, y| pdf([x as f32, y as f32]))
    }

    /// Numbers in an interval `[x0, x1]`, in `bins[0] · bins[1]` cells; `pdf` is per length.
    pub fn interval(
        &self,
        range: [f32; 2],
        mut sample: impl FnMut(f32) -> Option<f32>,
        pdf: impl Fn(f32) -> f64,
    ) -> Result<(), String> {
        let line = Chi2 { bins: [self.bins[0] * self.bins[1], 1], ..*self };
        let bounds = [range.map(f64::from), [0.0, 1.0]];
        line.run(bounds, |u| sample(u[0]).map(|x| [x as f64, 0.5]), |x, _| pdf(x as f32))
    }

    /// Tests given counts against expected ones. `bins`, `samples` and `seed` are not used.
    pub fn counts(&self, observed: &[u64], expected: &[f64]) -> Result<(), String> {
        assert_eq!(observed.len(), expected.len(), "each cell has a count and an expectation");
        let cells = observed.iter().zip(expected).enumerate().map(|(i, (&observed, &expected))| Cell {
            place: [[i as f64; 2], [0.0; 2]],
            expected,
            observed,
        });
        self.judge(cells.collect())
    }

    fn run(
        &self,
        bounds: [[f64; 2]; 2],
        mut sample: impl FnMut([f32; 2]) -> Option<[f64; 2]>,
        density: impl Fn(f64, f64) -> f64,
    ) -> Result<(), String> {
        let [columns, rows] = self.bins;
        let mut observed = vec![0u64; columns * rows];
        let mut missing = 0;
        let mut random = Random::new(self.seed);
        for _ in 0..self.samples {
            let Some(point) = sample(random.get_2d()) else {
                missing += 1;
                continue;
            };
            let mut index = [0; 2];
            for axis in 0..2 {
                let [low, high] = bounds[axis];
                let slack = 1e-5 * (high - low);
                if !(low - slack..=high + slack).contains(&point[axis]) {
                    return Err(format!("sample {point:?} lies outside {bounds:?}"));
                }
                let t = (point[axis] - low) / (high - low) * self.bins[axis] as f64;
                index[axis] = (t.max(0.0) as usize).min(self.bins[axis] - 1);
            }
            observed[index[0] * rows + index[1]] += 1;
        }

        let edge = |axis: usize, i: usize| {
            let [low, high] = bounds[axis];
            low + (high - low) * i as f64 / self.bins[axis] as f64
        };
        let tolerance = 1e-2 / self.samples as f64;
        let mut total = 0.0;
        let mut cells = Vec::with_capacity(observed.len() + 1);
        for (i, observed) in observed.into_iter().enumerate() {
            let (column, row) = (i / rows, i % rows);
            let place = [[edge(0, column), edge(0, column + 1)], [edge(1, row), edge(1, row + 1)]];
            // Slightly inside, so that a discontinuity along the cell's boundary is not evaluated
            // on both sides.
            let inside = place.map(|[low, high]| {
                let hair = 1e-5 * (high - low);
                [low + hair, high - hair]
            });
            let mut probability = integrate(&density, inside, tolerance);
            if probability == 0.0 && observed > 0 {
                probability = search(&density, inside, tolerance);
            }
            if probability.is_nan() || probability < 0.0 {
                return Err(format!("the density's integral over {place:?} is {probability}"));
            }
            total += probability;
            cells.push(Cell { place, expected: probability * self.samples as f64, observed });
        }
        if total > 1.0 + 1e-3 {
            return Err(format!("the density integrates to {total:.5}, which is more than 1"));
        }
        // The quadrature is not exact, so a small deficit counts as none.
        let deficit = if 1.0 - total < 1e-4 { 0.0 } else { 1.0 - total };
        let expected = deficit * self.samples as f64;
        cells.push(Cell { place: [[f64::NAN; 2]; 2], expected, observed: missing });
        self.judge(cells).map_err(|table| format!("{table}the density integrates to {total:.6}\n"))
    }

    /// Pools cells with small expected counts, then compares χ² with its distribution.
    fn judge(&self, mut cells: Vec<Cell>) -> Result<(), String> {
        let count: u64 = cells.iter().map(|cell| cell.observed).sum();
        // Rounding may move a few samples across a cell's edge, not more.
        let strays = 2.max(count / 100_000);
        if let Some(cell) = cells.iter().find(|cell| cell.expected == 0.0 && cell.observed > strays) {
            return Err(format!(
                "{} samples of {count} in a cell without density: {}\n",
                cell.observed,
                name(cell)
            ));
        }
        cells.sort_by(|a, b| a.expected.total_cmp(&b.expected));
        let (mut statistic, mut groups) = (0.0, 0usize);
        let (mut pooled_expected, mut pooled_observed) = (0.0, 0u64);
        for (i, cell) in cells.iter().enumerate() {
            pooled_expected += cell.expected;
            pooled_observed += cell.observed;
            let last = i + 1 == cells.len();
            if pooled_expected >= self.min_expected || (last && pooled_expected > 0.0) {
                statistic += (pooled_observed as f64 - pooled_expected).powi(2) / pooled_expected;
                groups += 1;
                (pooled_expected, pooled_observed) = (0.0, 0);
            }
        }
        if groups == 0 {
            return Err("no cell has any density\n".into());
        }
        // A single group has no degree of freedom: its count must be as expected, up to the
        // quadrature error.
        let degrees = (groups - 1).max(1) as f64;
        let p = 1.0 - chi2_cdf(statistic, degrees);
        let alpha = sidak(SIGNIFICANCE, self.tests);
        if p >= alpha {
            return Ok(());
        }
        let mut table = format!(
            "χ² = {statistic:.2} with {degrees} degrees of freedom: p = {p:.3e} is below {alpha:.3e}. The worst cells:\n"
        );
        let error = |cell: &Cell| (cell.observed as f64 - cell.expected).powi(2) / cell.expected.max(1.0);
        cells.sort_by(|a, b| error(b).total_cmp(&error(a)));
        for cell in cells.iter().take(12) {
            let (observed, expected) = (cell.observed, cell.expected);
            // Writing to a string cannot fail.
            let _ = writeln!(
                table,
                "  {:<44} observed {observed:>8}  expected {expected:>11.2}  (O-E)²/E {:>9.2}",
                name(cell),
                error(cell)
            );
        }
        Err(table)
    }
}

fn name(cell: &Cell) -> String {
    let [x, y] = cell.place;
    if x[0].is_nan() {
        "no sample".into()
    } else {
        format!("[{:.4}, {:.4}] × [{:.4}, {:.4}]", x[0], x[1], y[0], y[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform_sphere(u: [f32; 2]) -> Option<[f32; 3]> {
        let z = 1.0 - 2.0 * u[0];
        let r = (1.0 - z * z).max(0.0).sqrt();
        let phi = 2.0 * PI as f32 * u[1];
        Some([r * phi.cos(), r * phi.sin(), z])
    }

    #[test]
    fn the_right_density_is_accepted() {
        for seed in 0..8 {
            let test = Chi2 { tests: 8, seed, ..Chi2::default() };
            test.sphere(uniform_sphere, |_| 1.0 / (4.0 * PI)).unwrap();
            test.interval([0.0, 1.0], |u| Some(u.sqrt()), |x| 2.0 * x as f64).unwrap();
            let product = |u: [f32; 2]| Some([2.0 * u[0].sqrt(), u[1]]);
            test.rectangle([[0.0, 2.0], [0.0, 1.0]], product, |p| 0.5 * p[0] as f64).unwrap();
        }
    }

    #[test]
    fn a_wrong_density_is_rejected() {
        let test = Chi2 { tests: 50, ..Chi2::default() };
        test.sphere(uniform_sphere, |w| (1.0 + 0.06 * w[0] as f64) / (4.0 * PI)).unwrap_err();
        test.sphere(uniform_sphere, |_| 1.05 / (4.0 * PI)).unwrap_err();
        test.sphere(uniform_sphere, |_| 0.95 / (4.0 * PI)).unwrap_err();
        test.sphere(uniform_sphere, |w| if w[2] > 0.0 { 0.5 / PI } else { 0.0 }).unwrap_err();
        test.sphere(uniform_sphere, |_| f64::NAN).unwrap_err();
        test.interval([0.0, 1.0], |u| Some(u.sqrt()), |_| 1.0).unwrap_err();
        test.rectangle([[0.0, 1.0]; 2], Some, |p| 2.0 * p[1] as f64).unwrap_err();
    }

    #[test]
    fn wrong_samples_are_rejected() {
        let test = Chi2 { tests: 50, ..Chi2::default() };
        test.sphere(|u| uniform_sphere(u).map(|w| w.map(|x| 2.0 * x)), |_| 1.0 / (4.0 * PI)).unwrap_err();
        test.sphere(|_| Some([f32::NAN; 3]), |_| 1.0 / (4.0 * PI)).unwrap_err();
        test.rectangle([[0.0, 1.0]; 2], |u| Some([u[0] + 0.5, u[1]]), |_| 1.0).unwrap_err();
    }

    #[test]
    fn missing_samples_match_the_missing_density() {
        let upper = |u: [f32; 2]| uniform_sphere(u).filter(|w| w[2] > 0.0);
        let density = |w: [f32; 3]| if w[2] > 0.0 { 0.25 / PI } else { 0.0 };
        Chi2::default().sphere(upper, density).unwrap();
        Chi2::default().sphere(upper, |w| 2.0 * density(w)).unwrap_err();
    }

    #[test]
    fn counts_of_a_die() {
        Chi2::default().counts(&[98, 105, 101, 97, 94, 105], &[100.0; 6]).unwrap();
        Chi2::default().counts(&[60, 105, 101, 97, 94, 143], &[100.0; 6]).unwrap_err();
        Chi2::default().counts(&[600, 5], &[600.0, 0.0]).unwrap_err();
    }

    #[test]
    fn rejections_name_the_worst_cell() {
        let message = Chi2::default().interval([0.0, 1.0], |_| Some(0.25), |_| 1.0).unwrap_err();
        assert!(message.contains("[0.2500, 0.2520]"), "{message}");
    }
}
