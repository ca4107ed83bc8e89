//! Choosing many of some candidates.

/// Systematic resampling: `count` candidates in proportion to their weights, chosen by equidistant
/// points in the cumulative weights, the first at the fraction `u` of the distance. If all weights
/// are 0, the choice is arbitrary.
pub fn resample(weights: &[f32], count: usize, u: f32) -> Vec<u32> {
    let distance = weights.iter().map(|&weight| f64::from(weight)).sum::<f64>() / count as f64;
    let (mut end, mut place) = (0.0, f64::from(u) * distance);
    let mut chosen = Vec::with_capacity(count);
    for (i, &weight) in weights.iter().enumerate() {
        end += f64::from(weight);
        while chosen.len() < count && place < end {
            chosen.push(i as u32);
            place += distance;
        }
    }
    chosen.resize(count, chosen.last().copied().unwrap_or(0));
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn candidates_are_chosen_in_proportion_to_their_weights() {
        let weights = [0.0, 3.0, 0.5, 0.0, 1.5, 0.0];
        for u in [0.0, 0.3, 0.999] {
            let chosen = resample(&weights, 100, u);
            for (i, weight) in weights.iter().enumerate() {
                let count = chosen.iter().filter(|&&chosen| chosen == i as u32).count() as f32;
                assert!((count - 20.0 * weight).abs() <= 1.0, "{i}: {count}");
                assert!(*weight > 0.0 || count == 0.0);
            }
        }
        assert_eq!(resample(&[0.0; 4], 3, 0.5).len(), 3);
    }
}
