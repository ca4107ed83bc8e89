//! Decomposition of the error into noise and bias.
//!
//! Let a and b be two independent pictures with the same budget, r the reference, and ⟨·⟩ the mean
//! over pixels and colour channels. Then
//!
//! error = ⟨(a − r)² + (b − r)²⟩ / 2 = ⟨(a − b)²⟩ / 2 + ⟨(a − r)(b − r)⟩,
//!
//! exactly. In expectation the first term is the variance of one picture: noise. As a and b are
//! independent, the second is (E[a] − r)²: the squared bias, plus the variance of the reference
//! itself, which is subtracted where it is known. This distinguishes a noisy unbiased algorithm
//! from a smooth biased one. The squared bias is an estimate, which may be below 0; its standard
//! deviation is estimated from the variance over pixels.
//!
//! Relative figures have each term divided by r² + 0.01, as relMSE has [Rousselle 2011]. The mean
//! error has a sign, which the squared bias lacks: it is positive where the picture is too bright.
//! Its standard deviation is the larger of two estimates, one from the variance of the pixels, the
//! other from the difference of the two pictures' means, which includes noise that all pixels
//! share.

use alhazen::image::Image;
use alhazen::image::metrics::RELATIVE_EPSILON;

/// A mean squared error, and its parts: noise and bias.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parts {
    /// Mean squared error of one picture.
    pub error: f64,
    /// Variance of one picture.
    pub variance: f64,
    /// Estimate of the squared bias; may be negative.
    pub bias_squared: f64,
    /// Standard deviation of that estimate; infinite for a single pixel.
    pub bias_squared_deviation: f64,
    /// Variance of the reference, the rest of the error; 0 if unknown.
    pub reference_variance: f64,
}

/// An estimate of an algorithm's bias, relative to the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bias {
    /// Significant, and this large.
    Significant(f64),
    /// Not significant, and at most this large.
    Below(f64),
    /// Noise would hide a bias as large as the picture.
    Hidden,
}

impl Parts {
    /// The bias, of the parts of a relative error.
    pub fn bias(&self) -> Bias {
        if self.is_biased() {
            return Bias::Significant(self.bias_squared.sqrt());
        }
        let most = (self.bias_squared.max(0.0) + 3.0 * self.bias_squared_deviation).sqrt();
        if most < 1.0 { Bias::Below(most) } else { Bias::Hidden }
    }

    /// Whether the bias is significant: more than three standard deviations, or more than all
    /// noise. The latter is for bias in a few pixels, such as those of a caustic, for which the
    /// variance over pixels is large.
    pub fn is_biased(&self) -> bool {
        let noise = self.variance + self.reference_variance;
        let is_more_than_noise = self.bias_squared_deviation.is_finite() && self.bias_squared > noise;
        self.bias_squared > 3.0 * self.bias_squared_deviation || is_more_than_noise
    }
}

/// The error of an algorithm against the reference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measure {
    /// In squared units of the picture.
    pub absolute: Parts,
    /// Relative to the squared reference.
    pub relative: Parts,
    /// The mean of the error over both pictures: positive where they are too bright.
    pub mean_error: f64,
    /// The standard deviation of the mean error, the reference's noise included.
    pub mean_error_deviation: f64,
}

/// The noise of a rendered reference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReferenceNoise {
    /// Variance of a value, the mean over all.
    pub absolute: f64,
    /// The same, relative to the squared reference.
    pub relative: f64,
    /// Variance of the mean of the whole picture.
    pub of_mean: f64,
}

/// Sums over the pixels of two pictures.
#[derive(Default)]
struct Sums {
    squares: f64,
    differences: f64,
    products: f64,
    products_squared: f64,
}

impl Sums {
    /// Adds a pixel: both pictures' errors per channel, and the weights of the channels.
    fn add(&mut self, errors: [[f64; 3]; 2], weights: [f64; 3]) {
        let [a, b] = errors;
        let sum = |term: &dyn Fn(usize) -> f64| (0..3).map(|c| weights[c] * term(c)).sum::<f64>();
        let product = sum(&|c| a[c] * b[c]);
        self.squares += sum(&|c| a[c] * a[c] + b[c] * b[c]);
        self.differences += sum(&|c| (a[c] - b[c]) * (a[c] - b[c]));
        self.products += product;
        self.products_squared += product * product;
    }

    fn parts(&self, pixels: f64, reference_noise: f64) -> Parts {
        let values = 3.0 * pixels;
        // The channels of a pixel have the same samples, so they count as one observation.
        let spread = self.products_squared / pixels - (self.products / pixels).powi(2);
        let deviation = if pixels < 2.0 { f64::INFINITY } else { (spread.max(0.0) / pixels).sqrt() / 3.0 };
        Parts {
            error: self.squares / (2.0 * values),
            variance: self.differences / (2.0 * values),
            bias_squared: self.products / values - reference_noise,
            bias_squared_deviation: deviation,
            reference_variance: reference_noise,
        }
    }
}

/// The error of two independent pictures of one algorithm against a reference of the same size.
/// Pixels that are not finite in any of the three are left out.
pub(super) fn measure([a, b]: &[Image; 2], reference: &Image, noise: Option<ReferenceNoise>) -> Measure {
    let noise = noise.unwrap_or_default();
    let (mut absolute, mut relative) = (Sums::default(), Sums::default());
    let (mut pixels, mut means, mut pixel_noise) = (0.0, [0.0; 2], 0.0);
    for y in 0..reference.height() {
        for x in 0..reference.width() {
            let r = reference.rgb(x, y).map(f64::from);
            let errors = [a, b].map(|image| {
                let value = image.rgb(x, y);
                std::array::from_fn(|c| f64::from(value[c]) - r[c])
            });
            if !errors.as_flattened().iter().all(|error: &f64| error.is_finite()) {
                continue;
            }
            absolute.add(errors, [1.0; 3]);
            relative.add(errors, r.map(|r| 1.0 / (r * r + RELATIVE_EPSILON)));
            let pixel_means = errors.map(|errors| errors.iter().sum::<f64>() / 3.0);
            (0..2).for_each(|picture| means[picture] += pixel_means[picture]);
            pixel_noise += (pixel_means[0] - pixel_means[1]).powi(2) / 4.0;
            pixels += 1.0;
        }
    }
    let pixels = f64::max(pixels, 1.0);
    let means = means.map(|sum| sum / pixels);
    let own_variance = (pixel_noise / (pixels * pixels)).max((means[0] - means[1]).powi(2) / 4.0);
    Measure {
        absolute: absolute.parts(pixels, noise.absolute),
        relative: relative.parts(pixels, noise.relative),
        mean_error: (means[0] + means[1]) / 2.0,
        mean_error_deviation: (own_variance + noise.of_mean).sqrt(),
    }
}

/// The noise of a reference that is the mean of two independent pictures.
pub(super) fn reference_noise(halves: &[Image; 2], reference: &Image) -> ReferenceNoise {
    let measure = measure(halves, reference, None);
    ReferenceNoise {
        absolute: measure.absolute.variance / 2.0,
        relative: measure.relative.variance / 2.0,
        of_mean: measure.mean_error_deviation.powi(2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alhazen::image::metrics::compare;
    use testkit::Random;

    const SIDE: u32 = 64;

    /// A picture of value 1 + `bias` with uniform noise of this variance, the same in all channels
    /// of a pixel.
    fn picture(random: &mut Random, bias: f32, variance: f32) -> Image {
        let width = (12.0 * variance).sqrt();
        Image::from_fn(SIDE, SIDE, ["R", "G", "B"], |_, _| [1.0 + bias + width * (random.get_1d() - 0.5); 3])
    }

    #[test]
    fn parts_sum_to_the_error() {
        let mut random = Random::new(1);
        let reference = picture(&mut random, 0.0, 0.2);
        let pair = [0.1, 0.3].map(|variance| picture(&mut random, 0.2, variance));
        let measured = measure(&pair, &reference, None);
        let direct = pair.each_ref().map(|picture| compare(&reference, picture).unwrap());
        let close = |a: f64, b: f64| (a - b).abs() < 1e-6 * b.abs();
        assert!(close(measured.absolute.error, (direct[0].mse + direct[1].mse) / 2.0));
        assert!(close(measured.relative.error, (direct[0].rel_mse + direct[1].rel_mse) / 2.0));
        for parts in [measured.absolute, measured.relative] {
            assert!(close(parts.variance + parts.bias_squared, parts.error));
        }
        let mean = |index: usize| direct[index].test_mean[0] - direct[index].reference_mean[0];
        assert!(close(measured.mean_error, (mean(0) + mean(1)) / 2.0));
    }

    #[test]
    fn noise_and_bias_are_separated() {
        let mut random = Random::new(2);
        let halves = [0; 2].map(|_| picture(&mut random, 0.0, 0.02));
        let reference = Image::from_fn(SIDE, SIDE, ["R", "G", "B"], |x, y| {
            std::array::from_fn(|c| (halves[0].rgb(x, y)[c] + halves[1].rgb(x, y)[c]) / 2.0)
        });
        let noise = reference_noise(&halves, &reference);
        assert!((noise.absolute - 0.01).abs() < 0.001, "{noise:?}");
        for (bias, variance) in [(0.0, 0.1), (0.1, 0.1), (-0.2, 0.01)] {
            let pair = [0; 2].map(|_| picture(&mut random, bias, variance));
            let measured = measure(&pair, &reference, Some(noise));
            let (bias, variance) = (f64::from(bias), f64::from(variance));
            let Parts { variance: found, bias_squared, bias_squared_deviation, .. } = measured.absolute;
            assert!((found - variance).abs() < 0.05 * variance, "{measured:?}");
            assert!((bias_squared - bias * bias).abs() < 4.0 * bias_squared_deviation, "{measured:?}");
            assert!(bias_squared_deviation < 0.003, "{measured:?}");
            assert!((measured.mean_error - bias).abs() < 4.0 * measured.mean_error_deviation, "{measured:?}");
            assert!(measured.mean_error_deviation < 0.01, "{measured:?}");
            assert_eq!(measured.absolute.is_biased(), bias != 0.0, "{measured:?}");
            match measured.absolute.bias() {
                Bias::Significant(found) => assert!((found - bias.abs()).abs() < 0.02, "{found}"),
                Bias::Below(most) => assert!(bias == 0.0 && most < 0.1, "{most}"),
                Bias::Hidden => panic!("{measured:?}"),
            }
        }
    }

    #[test]
    fn the_mean_deviation_includes_correlated_noise() {
        let flat = |value: f32| Image::from_fn(8, 8, ["Y"], |_, _| [value]);
        let measured = measure(&[flat(1.3), flat(0.9)], &flat(1.0), None);
        assert!(
            (measured.mean_error - 0.1).abs() < 1e-6 && (measured.mean_error_deviation - 0.2).abs() < 1e-6
        );
    }

    #[test]
    fn bias_in_a_few_pixels_is_significant() {
        let mut random = Random::new(3);
        let reference = Image::from_fn(SIDE, SIDE, ["R", "G", "B"], |_, _| [1.0; 3]);
        for (spot, significant) in [(0.0, false), (5.0, true)] {
            let pair = [0; 2].map(|_| {
                let noise = picture(&mut random, 0.0, 0.001);
                Image::from_fn(SIDE, SIDE, ["R", "G", "B"], |x, y| {
                    noise.rgb(x, y).map(|value| if x == 0 && y < 8 { value + spot } else { value })
                })
            });
            let parts = measure(&pair, &reference, None).absolute;
            assert!(
                parts.bias_squared < 3.0 * parts.bias_squared_deviation && parts.is_biased() == significant,
                "{parts:?}"
            );
        }
    }

    #[test]
    fn large_noise_hides_bias() {
        let parts =
            Parts { variance: 3.0, bias_squared: 2.0, bias_squared_deviation: 1.0, ..Parts::default() };
        assert_eq!(parts.bias(), Bias::Hidden);
        let parts = Parts { bias_squared: -1.0, bias_squared_deviation: 0.03, ..Parts::default() };
        assert_eq!(parts.bias(), Bias::Below(0.3));
    }

    #[test]
    fn pixels_that_are_not_finite_are_left_out() {
        let picture =
            |value: f32| Image::from_fn(2, 1, ["Y"], |x, _| [if x == 0 { f32::NAN } else { value }]);
        let measured = measure(&[picture(2.0), picture(3.0)], &picture(1.0), None);
        assert_eq!(measured.absolute.error, 2.5);
    }
}
