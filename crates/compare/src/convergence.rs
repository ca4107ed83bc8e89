//! Convergence of an error over time: the slope of its curve, and the time to a given error.

/// Checkpoints count for the slope from this fraction of the total time on: earlier, preparation
/// and whole passes distort the curve.
const SLOPE_FROM: f64 = 1.0 / 32.0;

/// The exponent k in error ∝ time^k: −1 for the mean squared error of independent samples. A least
/// squares fit in log–log space to `(seconds, error)` in order of time; `None` if fewer than three
/// points are usable.
pub(super) fn slope(curve: &[(f64, f64)]) -> Option<f64> {
    let end = curve.last()?.0;
    let logs =
        curve.iter().filter(|&&(seconds, error)| seconds >= SLOPE_FROM * end && seconds > 0.0 && error > 0.0);
    let logs: Vec<(f64, f64)> = logs.map(|&(seconds, error)| (seconds.ln(), error.ln())).collect();
    if logs.len() < 3 {
        return None;
    }
    let count = logs.len() as f64;
    let mean_x = logs.iter().map(|(x, _)| x).sum::<f64>() / count;
    let mean_y = logs.iter().map(|(_, y)| y).sum::<f64>() / count;
    let variance: f64 = logs.iter().map(|(x, _)| (x - mean_x) * (x - mean_x)).sum();
    let covariance: f64 = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    (variance > 0.0).then(|| covariance / variance)
}

/// The time at which the curve first reaches `error`, interpolated linearly in log–log space;
/// `None` if it does not. If the first point is below it already, the time of that point.
pub(super) fn seconds_to(error: f64, curve: &[(f64, f64)]) -> Option<f64> {
    let reached = curve.iter().position(|&(_, found)| found <= error)?;
    let (seconds, found) = curve[reached];
    let Some(&(seconds_before, found_before)) = reached.checked_sub(1).and_then(|before| curve.get(before))
    else {
        return Some(seconds);
    };
    if found <= 0.0 || seconds_before <= 0.0 {
        return Some(seconds);
    }
    let share = (found_before / error).ln() / (found_before / found).ln();
    Some(seconds_before * (seconds / seconds_before).powf(share))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn power_law(exponent: f64) -> Vec<(f64, f64)> {
        (0..12)
            .map(|step| f64::from(step).exp2())
            .map(|seconds| (seconds, 3.0 * seconds.powf(exponent)))
            .collect()
    }

    #[test]
    fn the_slope_of_a_power_law_is_its_exponent() {
        for exponent in [-2.0, -1.0, -2.0 / 3.0, 0.0] {
            assert!((slope(&power_law(exponent)).unwrap() - exponent).abs() < 1e-12);
        }
        assert_eq!(slope(&power_law(-1.0)[..2]), None);
        assert_eq!(slope(&[(1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (4.0, 1.0)]), None);
        assert_eq!(slope(&[]), None);
    }

    #[test]
    fn early_checkpoints_do_not_count() {
        let mut curve = power_law(-1.0);
        curve[0].1 *= 100.0;
        assert!((slope(&curve).unwrap() + 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_time_to_an_error_is_interpolated() {
        let curve = power_law(-0.5);
        for seconds in [1.0, 3.7, 100.0, 2048.0] {
            let found = seconds_to(3.0 * f64::powf(seconds, -0.5) * (1.0 + 1e-12), &curve).unwrap();
            assert!((found - seconds).abs() < 1e-6 * seconds, "{found} is not {seconds}");
        }
        assert_eq!(seconds_to(1e-9, &curve), None);
        assert_eq!(seconds_to(100.0, &curve), Some(1.0));
    }
}
