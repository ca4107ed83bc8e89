//! How far a picture is from a reference, in numbers.
//!
//! Over all pixels and colour channels (one channel where neither picture has colour), with values
//! t of the test and r of the reference: MSE = mean of (t − r)²; relMSE = mean of (t − r)² / (r² +
//! 0.01), which weighs dark and bright parts alike [Rousselle 2011]; PSNR = 10 log₁₀(1 / MSE) dB.
//! Where a value is not finite in either picture, the pair is left out and counted.

use crate::{
    error::ImageError,
    image::{Image, Pixels},
    memory::reserved,
};

/// The constant in relMSE's denominator.
pub const RELATIVE_EPSILON: f64 = 0.01;

/// How far a picture is from a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Mean squared error.
    pub mse: f64,
    /// Mean relative squared error.
    pub rel_mse: f64,
    /// The largest absolute error.
    pub max_error: f64,
    /// Values that are not finite in either picture.
    pub non_finite: usize,
    /// The mean of each of the reference's colour channels, of finite values.
    pub reference_mean: [f64; 3],
    /// The mean of each of the test's colour channels, of finite values.
    pub test_mean: [f64; 3],
}

impl Difference {
    /// Peak signal-to-noise ratio in decibels, for a peak of 1; infinite where pictures are the
    /// same.
    pub fn psnr(&self) -> f64 {
        -10.0 * libm::log10(self.mse)
    }
}

/// The differences of two pictures of one size.
pub fn compare(reference: &Image, test: &Image) -> Result<Difference, ImageError> {
    check_same_size(reference, test)?;
    let channels = if reference.is_color() || test.is_color() { 3 } else { 1 };
    let (mut squares, mut relative, mut max_error, mut count, mut non_finite) = (0.0, 0.0, 0.0f64, 0usize, 0);
    let (mut reference_mean, mut test_mean) = (Mean::default(), Mean::default());
    for y in 0..reference.height() {
        for x in 0..reference.width() {
            let (r, t) = (reference.rgb(x, y).map(f64::from), test.rgb(x, y).map(f64::from));
            reference_mean.add(r);
            test_mean.add(t);
            for (r, t) in r.into_iter().zip(t).take(channels) {
                if !(r.is_finite() && t.is_finite()) {
                    non_finite += 1;
                    continue;
                }
                let square = (t - r) * (t - r);
                squares += square;
                relative += square / (r * r + RELATIVE_EPSILON);
                max_error = max_error.max((t - r).abs());
                count += 1;
            }
        }
    }
    let count = count.max(1) as f64;
    Ok(Difference {
        mse: squares / count,
        rel_mse: relative / count,
        max_error,
        non_finite,
        reference_mean: reference_mean.value(),
        test_mean: test_mean.value(),
    })
}

/// The squared error at each pixel, averaged over colour channels, as channel Y; relative as in
/// [`Difference::rel_mse`] on demand. Where a value is not finite, the error is not either.
pub fn squared_error_map(reference: &Image, test: &Image, relative: bool) -> Result<Image, ImageError> {
    check_same_size(reference, test)?;
    let mut values = reserved(reference.width() as usize * reference.height() as usize)?;
    for y in 0..reference.height() {
        for x in 0..reference.width() {
            let pairs = reference.rgb(x, y).into_iter().zip(test.rgb(x, y));
            let error = |(r, t): (f32, f32)| {
                let denominator = if relative { r * r + RELATIVE_EPSILON as f32 } else { 1.0 };
                (t - r) * (t - r) / denominator
            };
            values.push(pairs.map(error).sum::<f32>() / 3.0);
        }
    }
    Image::new(reference.width(), reference.height(), ["Y"], Pixels::F32(values))
}

pub(crate) fn check_same_size(reference: &Image, test: &Image) -> Result<(), ImageError> {
    let [a, b] = [reference, test].map(|image| (image.width(), image.height()));
    if a == b {
        return Ok(());
    }
    Err(ImageError::Invalid(format!(
        "the pictures differ in size: {} × {} and {} × {} pixels",
        a.0, a.1, b.0, b.1
    )))
}

#[derive(Default)]
struct Mean {
    sums: [f64; 3],
    counts: [usize; 3],
}

impl Mean {
    fn add(&mut self, color: [f64; 3]) {
        for (c, value) in color.into_iter().enumerate().filter(|(_, value)| value.is_finite()) {
            self.sums[c] += value;
            self.counts[c] += 1;
        }
    }

    fn value(&self) -> [f64; 3] {
        std::array::from_fn(|c| self.sums[c] / self.counts[c].max(1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_formulas_hold_on_two_pixels() {
        let reference =
            Image::from_fn(2, 1, ["R", "G", "B"], |x, _| if x == 0 { [0.0, 1.0, 2.0] } else { [1.0; 3] });
        let test =
            Image::from_fn(
                2,
                1,
                ["R", "G", "B"],
                |x, _| if x == 0 { [0.5, 1.0, 2.0] } else { [1.0, 1.0, 3.0] },
            );
        let difference = compare(&reference, &test).unwrap();
        assert!((difference.mse - 4.25 / 6.0).abs() < 1e-12);
        assert!((difference.rel_mse - (0.25 / 0.01 + 4.0 / 1.01) / 6.0).abs() < 1e-9);
        assert_eq!(difference.max_error, 2.0);
        assert_eq!(difference.test_mean, [0.75, 1.0, 2.5]);
        let map = squared_error_map(&reference, &test, false).unwrap();
        assert!((map.channel(1, 0, 0) - 4.0 / 3.0).abs() < 1e-6);
    }

    #[test]
    fn non_finite_values_are_counted_and_left_out() {
        let reference = Image::from_fn(2, 1, ["Y"], |x, _| [x as f32]);
        let test = Image::from_fn(2, 1, ["Y"], |x, _| [if x == 0 { f32::NAN } else { 1.5 }]);
        let difference = compare(&reference, &test).unwrap();
        assert_eq!((difference.mse, difference.non_finite), (0.25, 1));
    }

    #[test]
    fn sizes_must_agree() {
        let [a, b] = [2, 3].map(|width| Image::from_fn(width, 1, ["Y"], |_, _| [0.0]));
        assert!(compare(&a, &b).is_err());
    }
}
