//! `cargo xtask rgb-table`: fits the tables that turn RGB into spectra and writes them to
//! `crates/spectrum/data`.
//!
//! For each node of a table the coefficients c of the sigmoid polynomial s are sought whose
//! reflectance s(c, λ) under the colour space's illuminant has the node's colour: least squares of
//! the CIELAB difference by Gauss–Newton steps with Levenberg's damping, in double precision. Each
//! column of nodes is fitted outwards from its middle, every fit starting from its neighbour's
//! result. Colours outside the gamut of reflectances get the nearest one.
//!
//! Source: [Jakob 2019].

use std::path::Path;
use std::{fs, io, thread};

use spectrum::uplift::{NODES, RATIOS, RgbToSpectrumTable, VALUES, node_index, node_ratio, node_value};
use spectrum::{CIE_Y_INTEGRAL, LAMBDA_MIN, Matrix3, RgbColorSpace, cie};

/// Coefficients of t², t and 1.
type Coefficients = [f64; 3];

/// Fits, writes and evaluates the tables of all colour spaces.
pub fn run() -> io::Result<()> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../spectrum/data");
    for space in RgbColorSpace::all() {
        let observer = Observer::new(space);
        let table = RgbToSpectrumTable::decode(&fit_table(&observer).encode());
        let file = data.join(format!("rgb_{}.bin", space.name().replace('-', "_")));
        fs::write(&file, table.encode())?;
        println!("{:12} {}", space.name(), observer.judge(&table));
    }
    Ok(())
}

/// The standard observer with a colour space's illuminant.
struct Observer {
    /// The parameter t of each wavelength, and the contribution of unit reflectance there to XYZ.
    weights: Vec<(f64, [f64; 3])>,
    white: [f64; 3],
    xyz_from_rgb: Matrix3,
    rgb_from_xyz: Matrix3,
}

impl Observer {
    fn new(space: &RgbColorSpace) -> Self {
        let functions = cie::matching_functions();
        let illuminant = space.illuminant();
        let weights = (0..functions.y.values().len()).map(|i| {
            let lambda = LAMBDA_MIN + i as f32;
            let light = f64::from(illuminant.at(lambda)) / f64::from(CIE_Y_INTEGRAL);
            let matching = [&functions.x, &functions.y, &functions.z].map(|f| f64::from(f.at(lambda)));
            ((f64::from(lambda) - 540.0) / 100.0, matching.map(|m| m * light))
        });
        let xyz_from_rgb = space.xyz_from_rgb();
        Self {
            weights: weights.collect(),
            white: xyz_from_rgb.apply([1.0; 3]),
            xyz_from_rgb,
            rgb_from_xyz: space.rgb_from_xyz(),
        }
    }

    /// XYZ of the reflectance with these coefficients, and its derivatives by them as columns.
    fn xyz(&self, [c0, c1, c2]: Coefficients) -> ([f64; 3], Matrix3) {
        let mut xyz = [0.0; 3];
        let mut derivatives = [[0.0; 3]; 3];
        for &(t, weight) in &self.weights {
            let u = (c0 * t + c1) * t + c2;
            let r = 1.0 / (1.0 + u * u).sqrt();
            let s = 0.5 + 0.5 * u * r;
            let ds = 0.5 * r * r * r;
            for i in 0..3 {
                xyz[i] += weight[i] * s;
                derivatives[0][i] += weight[i] * ds * t * t;
                derivatives[1][i] += weight[i] * ds * t;
                derivatives[2][i] += weight[i] * ds;
            }
        }
        (xyz, Matrix3::from_columns(derivatives))
    }

    /// CIELAB of XYZ under this illuminant, and its derivatives.
    fn lab(&self, xyz: [f64; 3]) -> ([f64; 3], Matrix3) {
        const DELTA: f64 = 6.0 / 29.0;
        let f = |i: usize| {
            let ratio = xyz[i] / self.white[i];
            if ratio > DELTA.powi(3) {
                (ratio.cbrt(), ratio.cbrt() / (3.0 * xyz[i]))
            } else {
                (ratio / (3.0 * DELTA * DELTA) + 4.0 / 29.0, 1.0 / (3.0 * DELTA * DELTA * self.white[i]))
            }
        };
        let [(x, dx), (y, dy), (z, dz)] = [f(0), f(1), f(2)];
        let derivatives =
            Matrix3([[0.0, 116.0 * dy, 0.0], [500.0 * dx, -500.0 * dy, 0.0], [0.0, 200.0 * dy, -200.0 * dz]]);
        ([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], derivatives)
    }

    /// Difference in CIELAB between a reflectance and the colour `target`, and its derivatives by
    /// the coefficients.
    fn difference(&self, coefficients: Coefficients, target: [f64; 3]) -> ([f64; 3], Matrix3) {
        let (xyz, xyz_derivatives) = self.xyz(coefficients);
        let (lab, lab_derivatives) = self.lab(xyz);
        (std::array::from_fn(|i| lab[i] - target[i]), lab_derivatives * xyz_derivatives)
    }

    /// The coefficients c that make the squared difference from `rgb` plus R²·max(rgb)·|c|² least,
    /// sought from `start`.
    ///
    /// The second term is negligible where a reflectance has the colour; where none has, it keeps
    /// the coefficients bounded and so the table smooth. Dark colours need coefficients as
    /// 1/√max(rgb).
    fn fit(&self, rgb: [f64; 3], start: Coefficients) -> Coefficients {
        const R: f64 = 4e-3;
        const STEPS: usize = 100;
        const CONVERGED: f64 = 1e-9;
        let squared = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
        let (target, _) = self.lab(self.xyz_from_rgb.apply(rgb));
        let ridge = R * R * rgb.into_iter().fold(0.0, f64::max);
        let evaluate = |c: Coefficients| {
            let (residual, jacobian) = self.difference(c, target);
            (squared(residual) + ridge * squared(c), residual, jacobian)
        };
        let mut best = start;
        let (mut cost, mut residual, mut jacobian) = evaluate(best);
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let transposed = Matrix3::from_columns(jacobian.0);
            let mut normal = transposed * jacobian;
            for i in 0..3 {
                normal.0[i][i] = normal.0[i][i] * (1.0 + damping) + ridge;
            }
            let Some(inverse) = normal.inverse() else { break };
            let gradient = transposed.apply(residual);
            let step = inverse.apply(std::array::from_fn(|i| gradient[i] + ridge * best[i]));
            let next: Coefficients = std::array::from_fn(|i| best[i] - step[i]);
            let (next_cost, next_residual, next_jacobian) = evaluate(next);
            if next_cost < cost {
                let converged = cost - next_cost < CONVERGED * cost;
                (best, cost, residual, jacobian) = (next, next_cost, next_residual, next_jacobian);
                damping *= 0.1;
                if converged {
                    break;
                }
            } else if damping > 1e9 {
                break;
            } else {
                damping = damping.max(1e-9) * 10.0;
            }
        }
        best
    }

    /// The round-trip error of RGB values through the table, as text.
    fn judge(&self, table: &RgbToSpectrumTable) -> String {
        const STEPS: usize = 37;
        let mut errors = Vec::new();
        let mut worst = (0.0, [0.0; 3]);
        for i in 0..STEPS * STEPS * STEPS {
            let rgb =
                [i % STEPS, i / STEPS % STEPS, i / (STEPS * STEPS)].map(|v| (v as f64 + 0.37) / STEPS as f64);
            let polynomial = table.polynomial(rgb.map(|v| v as f32));
            let (xyz, _) = self.xyz(polynomial.coefficients.map(f64::from));
            let again = self.rgb_from_xyz.apply(xyz);
            let error = (0..3).map(|i| (again[i] - rgb[i]).abs()).fold(0.0, f64::max);
            errors.push(error);
            if error > worst.0 {
                worst = (error, rgb);
            }
        }
        errors.sort_by(f64::total_cmp);
        let quantile = |q: f64| errors[(q * (errors.len() - 1) as f64) as usize];
        format!(
            "round trip error: median {:.1e}, 90 % {:.1e}, 99 % {:.1e}, worst {:.1e} at {:.3?}",
            quantile(0.5),
            quantile(0.9),
            quantile(0.99),
            worst.0,
            worst.1
        )
    }
}

/// The coefficients at all nodes.
fn fit_table(observer: &Observer) -> RgbToSpectrumTable {
    let columns: Vec<(usize, [usize; 2])> = (0..3)
        .flat_map(|largest| (0..RATIOS * RATIOS).map(move |i| (largest, [i % RATIOS, i / RATIOS])))
        .collect();
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut coefficients = vec![[0.0; 3]; NODES];
    thread::scope(|scope| {
        let workers: Vec<_> = columns
            .chunks(columns.len().div_ceil(threads))
            .map(|chunk| {
                scope.spawn(|| chunk.iter().map(|&(l, r)| fit_column(observer, l, r)).collect::<Vec<_>>())
            })
            .collect();
        let fitted =
            workers.into_iter().flat_map(|worker| worker.join().expect("invariant: fits do not panic"));
        for (&(largest, ratios), column) in columns.iter().zip(fitted) {
            for (value, c) in column.into_iter().enumerate() {
                coefficients[node_index(largest, value, ratios)] = c.map(|v| v as f32);
            }
        }
    });
    RgbToSpectrumTable::new(coefficients)
}

/// The coefficients of a column of nodes: all values of the largest component, with fixed ratios of
/// the others.
fn fit_column(observer: &Observer, largest: usize, ratios: [usize; 2]) -> [Coefficients; VALUES] {
    let mut column = [[0.0; 3]; VALUES];
    let mut fit = |value: usize, start| {
        let z = node_value(value);
        let mut rgb = [z; 3];
        rgb[(largest + 1) % 3] = z * node_ratio(ratios[0]);
        rgb[(largest + 2) % 3] = z * node_ratio(ratios[1]);
        column[value] = observer.fit(rgb, start);
        column[value]
    };
    let middle = VALUES / 3;
    let first = fit(middle, [0.0; 3]);
    (middle + 1..VALUES).fold(first, |start, value| fit(value, start));
    (0..middle).rev().fold(first, |start, value| fit(value, start));
    column
}
