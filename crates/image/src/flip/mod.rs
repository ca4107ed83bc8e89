//! FLIP: how different two pictures look when they are flipped on a screen in turn.
//!
//! Both pictures are blurred as the eye blurs them, by contrast sensitivity functions in the
//! opponent space YCxCz, each a Gaussian (blue-yellow: the sum of two) a √(π/b) exp(−π² x² / b), x
//! in degrees. Then per pixel, with HyAB distance D in Hunt-adjusted L*a*b* and D_max that of green
//! and blue,
//!
//! ΔE_c = D^0.7, mapped linearly so that [0, 0.4 D_max^0.7] becomes [0, 0.95] and the rest
//! [0.95, 1]; ΔE_f = (max(|‖e_r‖ − ‖e_t‖|, |‖p_r‖ − ‖p_t‖|) / √2)^0.5 of edges e and points p:
//! first and second derivatives of the unblurred lightness under a Gaussian of deviation 0.041
//! degrees; and ΔE = ΔE_c^(1 − ΔE_f) in [0, 1].
//!
//! [`hdr_flip`] takes pictures of any range: it is the largest ΔE over exposures 1 stop apart or
//! less, between the one that brings the brightest pixel of the reference to 0.85 after the ACES
//! tone curve and the one that brings the median there. Sources: [Andersson 2020],
//! [Andersson 2021].

mod color;
mod plane;

use math::Vec3;
use rayon::prelude::*;

use self::{
    color::{hunt_lab_from_rgb, hyab, luminance, rgb_from_ycxcz, ycxcz_from_rgb},
    plane::Plane,
};
use crate::{
    encoding::at_most,
    error::ImageError,
    image::{Image, Pixels},
    memory::require_memory,
    metrics::check_same_size,
};

/// Pixels per degree of a screen 0.7 m wide with 3840 pixels across, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 67.020_645;

/// Bytes per pixel that a comparison takes at most: the colours of both pictures, as read and tone
/// mapped, the perceived pixels of both, and the planes from which those of the second are
/// computed.
const BYTES_PER_PIXEL: usize = 160;

/// The most exposures that [`hdr_flip`] compares.
const MAX_EXPOSURES: f32 = 32.0;

/// How different two pictures look.
#[derive(Clone, Debug)]
pub struct Flip {
    /// The mean of the map.
    pub mean: f64,
    /// The difference at each pixel in [0, 1], as channel Y.
    pub map: Image,
}

/// FLIP of pictures for a screen: linear sRGB, of which only [0, 1] is seen. `pixels_per_degree` is
/// usually [`PIXELS_PER_DEGREE`].
pub fn ldr_flip(reference: &Image, test: &Image, pixels_per_degree: f32) -> Result<Flip, ImageError> {
    check_same_size(reference, test)?;
    require_memory(BYTES_PER_PIXEL * reference.width() as usize * reference.height() as usize)?;
    let shown = |c: f32| at_most(c, 1.0);
    let map =
        difference(&colors(reference, shown), &colors(test, shown), reference.width(), pixels_per_degree)?;
    finish(reference, map)
}

/// FLIP of linear sRGB pictures of any range; negative values and NaN count as black.
pub fn hdr_flip(reference: &Image, test: &Image, pixels_per_degree: f32) -> Result<Flip, ImageError> {
    check_same_size(reference, test)?;
    require_memory(BYTES_PER_PIXEL * reference.width() as usize * reference.height() as usize)?;
    // The bound keeps squares in the tone curve finite.
    let finite = |c: f32| at_most(c, 1e15);
    let (reference_colors, test_colors) = (colors(reference, finite), colors(test, finite));
    let mut worst = vec![0.0f32; reference_colors.len()];
    for exposure in exposures(&reference_colors) {
        let shown = |colors: &[Vec3]| -> Vec<Vec3> {
            let scale = libm::exp2f(exposure);
            colors.par_iter().map(|color| tone_map(*color * scale)).collect()
        };
        let map = difference(
            &shown(&reference_colors),
            &shown(&test_colors),
            reference.width(),
            pixels_per_degree,
        )?;
        worst.iter_mut().zip(map).for_each(|(worst, value)| *worst = worst.max(value));
    }
    finish(reference, worst)
}

fn finish(reference: &Image, map: Vec<f32>) -> Result<Flip, ImageError> {
    let mean = map.iter().map(|&value| f64::from(value)).sum::<f64>() / map.len() as f64;
    Ok(Flip { mean, map: Image::new(reference.width(), reference.height(), ["Y"], Pixels::F32(map))? })
}

fn colors(image: &Image, limit: impl Fn(f32) -> f32) -> Vec<Vec3> {
    let rows = 0..image.height();
    rows.flat_map(|y| (0..image.width()).map(move |x| (x, y)))
        .map(|(x, y)| Vec3::from_array(image.rgb(x, y).map(&limit)))
        .collect()
}

/// The ACES tone curve of Narkowicz, n(x) / d(x), with 0.6 of exposure folded in: coefficients of
/// x², x, 1.
const TONE_NUMERATOR: [f32; 3] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0];
const TONE_DENOMINATOR: [f32; 3] = [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];

fn tone_map(color: Vec3) -> Vec3 {
    let [numerator, denominator] =
        [TONE_NUMERATOR, TONE_DENOMINATOR].map(|[a, b, c]| color * color * a + color * b + Vec3::splat(c));
    (numerator / denominator).clamp(Vec3::ZERO, Vec3::ONE)
}

/// The exposures in stops at which pictures are compared to this reference.
fn exposures(reference: &[Vec3]) -> Vec<f32> {
    let mut luminances: Vec<f32> = reference.iter().map(|color| luminance(*color)).collect();
    luminances.sort_by(f32::total_cmp);
    let brightest = luminances[luminances.len() - 1];
    if brightest == 0.0 {
        return vec![0.0];
    }
    let mut median = luminances[luminances.len() / 2];
    if median == 0.0 {
        // More than half of the picture is black: take the median of what is not.
        let lit = &luminances[luminances.partition_point(|&value| value == 0.0)..];
        median = lit[lit.len() / 2];
    }
    // The positive root of n(x) = 0.85 d(x).
    let [a, b, c] = std::array::from_fn(|i| TONE_NUMERATOR[i] - 0.85 * TONE_DENOMINATOR[i]);
    let bright = -0.5 * b / a + (0.25 * (b / a) * (b / a) - c / a).sqrt();
    let (start, stop) = (lanes::log2(bright / brightest), lanes::log2(bright / median));
    let count = (stop - start).ceil().clamp(2.0, MAX_EXPOSURES);
    (0..count as usize).map(|i| start + i as f32 * (stop - start) / (count - 1.0)).collect()
}

/// The FLIP map of linear sRGB colours in [0, 1].
fn difference(
    reference: &[Vec3],
    test: &[Vec3],
    width: u32,
    pixels_per_degree: f32,
) -> Result<Vec<f32>, ImageError> {
    if !(0.1..=1e4).contains(&pixels_per_degree) {
        return Err(ImageError::Invalid(format!("{pixels_per_degree} pixels per degree")));
    }
    let kernels = Kernels::new(pixels_per_degree);
    let (reference, test) =
        (kernels.perceived(reference, width as usize), kernels.perceived(test, width as usize));
    let largest = lanes::pow(hyab(hunt_lab_from_rgb(Vec3::Y), hunt_lab_from_rgb(Vec3::Z)), 0.7);
    let knee = 0.4 * largest;
    Ok(reference
        .par_iter()
        .zip(&test)
        .map(|(reference, test)| {
            let distance = lanes::pow(hyab(reference.lab, test.lab), 0.7);
            let color_difference = if distance < knee {
                0.95 / knee * distance
            } else {
                0.95 + 0.05 * (distance - knee) / (largest - knee)
            };
            let feature = (reference.edge - test.edge).abs().max((reference.point - test.point).abs());
            let feature_difference = (feature / std::f32::consts::SQRT_2).sqrt();
            lanes::pow(color_difference, 1.0 - feature_difference)
        })
        .collect())
}

/// A pixel as perceived.
struct PerceivedPixel {
    /// Hunt-adjusted L*a*b* of the blurred colour.
    lab: Vec3,
    /// Strengths of features in the lightness.
    edge: f32,
    point: f32,
}

/// One-dimensional kernels at some distance from the screen.
struct Kernels {
    lightness: Vec<f32>,
    red_green: Vec<f32>,
    /// Two, whose squares are summed.
    blue_yellow: [Vec<f32>; 2],
    gauss: Vec<f32>,
    first_derivative: Vec<f32>,
    second_derivative: Vec<f32>,
}

impl Kernels {
    fn new(pixels_per_degree: f32) -> Self {
        use std::f32::consts::PI;
        // The radius is three deviations of the widest Gaussian, b = 0.04.
        let radius = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
        let gaussian = |radius: i32, b: f32| -> Vec<f32> {
            (-radius..=radius).map(|x| lanes::exp(-(PI * x as f32 / pixels_per_degree).powi(2) / b)).collect()
        };
        // A sum of two separable kernels, normalised as one: the square root of each amplitude goes
        // to each axis.
        let amplitudes = [(34.1f32, 0.04f32), (13.5, 0.025)].map(|(a, b)| ((a * (PI / b).sqrt()).sqrt(), b));
        let wide =
            amplitudes.map(|(a, b)| gaussian(radius, b).into_iter().map(|g| a * g).collect::<Vec<_>>());
        let total = wide.iter().map(|kernel| kernel.iter().sum::<f32>().powi(2)).sum::<f32>().sqrt();

        let deviation = 0.5 * 0.082 * pixels_per_degree;
        let radius_of_features = (3.0 * deviation).ceil() as i32;
        let features = |shape: &dyn Fn(f32) -> f32| -> Vec<f32> {
            let positions = (-radius_of_features..=radius_of_features).map(|x| x as f32 / deviation);
            positions.map(|x| shape(x) * lanes::exp(-0.5 * x * x)).collect()
        };
        Self {
            lightness: balanced(gaussian(radius, 0.0047)),
            red_green: balanced(gaussian(radius, 0.0053)),
            blue_yellow: wide.map(|kernel| kernel.into_iter().map(|weight| weight / total).collect()),
            gauss: balanced(features(&|_| 1.0)),
            first_derivative: balanced(features(&|x| -x)),
            second_derivative: balanced(features(&|x| x * x - 1.0)),
        }
    }

    fn perceived(&self, colors: &[Vec3], width: usize) -> Vec<PerceivedPixel> {
        let opponent: Vec<Vec3> = colors.par_iter().map(|color| ycxcz_from_rgb(*color)).collect();
        let channel = |c: usize| Plane::new(width, opponent.iter().map(|color| color[c]).collect());
        let (y, cx, cz) = (channel(0), channel(1), channel(2));
        let blurred_y = y.convolved(&self.lightness, &self.lightness).values;
        let blurred_cx = cx.convolved(&self.red_green, &self.red_green).values;
        let blurred_cz = self.blue_yellow.each_ref().map(|kernel| cz.convolved(kernel, kernel).values);

        // Lightness in [0, 1].
        let grey = Plane::new(width, y.values.iter().map(|value| (value + 16.0) / 116.0).collect());
        let strength = |derivative: &[f32]| -> Vec<f32> {
            let dx = grey.convolved(derivative, &self.gauss).values;
            let dy = grey.convolved(&self.gauss, derivative).values;
            dx.into_iter().zip(dy).map(|(dx, dy)| lanes::hypot(dx, dy)).collect()
        };
        let (edges, points) = (strength(&self.first_derivative), strength(&self.second_derivative));
        (0..colors.len())
            .into_par_iter()
            .map(|i| {
                let blurred = Vec3::new(blurred_y[i], blurred_cx[i], blurred_cz[0][i] + blurred_cz[1][i]);
                let rgb = rgb_from_ycxcz(blurred).clamp(Vec3::ZERO, Vec3::ONE);
                PerceivedPixel { lab: hunt_lab_from_rgb(rgb), edge: edges[i], point: points[i] }
            })
            .collect()
    }
}

/// The kernel scaled so that its positive weights sum to 1 and its negative ones, if any, to −1.
fn balanced(kernel: Vec<f32>) -> Vec<f32> {
    let positive: f32 = kernel.iter().filter(|weight| **weight > 0.0).sum();
    let negative: f32 = -kernel.iter().filter(|weight| **weight < 0.0).sum::<f32>();
    kernel
        .into_iter()
        .map(|weight| if weight > 0.0 { weight / positive } else { weight / negative.max(f32::MIN_POSITIVE) })
        .collect()
}
