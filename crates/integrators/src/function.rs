//! The integral of a function over the unit square, for the study of samplers: no scene is seen.
//!
//! A pixel is the mean of the function's values at the positions in the pixel that the sampler
//! gives for its samples, as a shade of the film's white: an estimate of the integral, which is 1
//! for every function. Beside the picture is written the mean over all pixels of (estimate − 1)²
//! after each number of samples, and on request a picture of the function. The functions are those
//! of pbrt-v4.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use description::{Diagnostic, FunctionDesc, FunctionKind, Origin};
use film::Film;
use geometry::RayStats;
use image::{Format, Image, WriteOptions, encode};
use math::{Bounds2i, Vec2};
use rayon::prelude::*;
use sampling::Sampler;
use scene::{Scene, ShutterSample, View};
use spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum};

use crate::{Cancelled, Control, Integrator, OutputFile, PassError};

/// Groups of four wavelengths over which the white of a sample is averaged, the same for all, so
/// that colour adds no noise.
const GROUPS: usize = 32;
/// Points along a side of a pixel of the function's picture.
const POINTS: u32 = 16;

/// The integral of a function.
#[derive(Clone, Debug)]
pub struct Function {
    settings: FunctionDesc,
    sampler: Sampler,
    white: Spectrum,
    white_scale: f32,
    /// The sums of all pixels over the passes whose [error](Self::errors) is known.
    sums: Vec<f64>,
    /// The mean square error after each number of samples from 1 on.
    errors: Vec<f64>,
    /// The file of the function's picture.
    picture: Vec<u8>,
}

impl Function {
    /// With the white of `color_space`.
    pub fn new(settings: FunctionDesc, sampler: Sampler, color_space: &RgbColorSpace) -> Self {
        let white = color_space.illuminant();
        let white_scale = 1.0 / white.to_photometric();
        let (sums, errors, picture) = Default::default();
        Self { settings, sampler, white, white_scale, sums, errors, picture }
    }

    /// An error if the file of the function's picture has no known format.
    pub(crate) fn unwritable(settings: &FunctionDesc, origin: &Origin) -> Option<Diagnostic> {
        let name = settings.image_filename.as_ref().filter(|name| Format::from_name(name).is_none())?;
        let message = format!("cannot tell the format of {name}");
        Some(Diagnostic::error("invalid-integrator", message, origin.parameter("imagefilename")))
    }

    /// The value of the function at a sample of a pixel.
    fn value(&self, sampler: &mut Sampler, pixel: [i32; 2], index: u32) -> f64 {
        sampler.start_pixel_sample(pixel, index, 0);
        value(self.settings.function, sampler.get_pixel_2d())
    }

    /// Finds the errors after all numbers of samples up to the one after this pass: those of
    /// earlier passes, too, which may have been done in another session.
    fn find_errors(&mut self, pass: u32, pixels: &Bounds2i, control: &Control) -> Result<(), Cancelled> {
        let (width, area) = (pixels.width() as usize, pixels.area());
        let mut sums = std::mem::take(&mut self.sums);
        sums.resize(area, 0.0);
        for index in self.errors.len() as u32..=pass {
            control.check()?;
            let samples = f64::from(index) + 1.0;
            let row = |(sums, y): (&mut [f64], i32)| {
                let mut sampler = self.sampler.clone();
                sums.iter_mut()
                    .zip(pixels.min[0]..)
                    .map(|(sum, x)| {
                        *sum += self.value(&mut sampler, [x, y], index);
                        (*sum / samples - 1.0).powi(2)
                    })
                    .sum::<f64>()
            };
            let rows = sums.par_chunks_mut(width).zip(pixels.min[1]..pixels.max[1]);
            let squares: Vec<f64> = rows.map(row).collect();
            self.errors.push(squares.iter().sum::<f64>() / area as f64);
        }
        self.sums = sums;
        Ok(())
    }

    /// Whether the error after this number of samples is listed.
    fn is_listed(&self, samples: u32) -> bool {
        let is_stratified = || match &self.sampler {
            Sampler::Independent(_) | Sampler::PrimarySample(_) => true,
            Sampler::Stratified(_) => samples.is_multiple_of(self.sampler.samples_per_pixel()),
            // The pixel's position has bases 2 and 3.
            Sampler::Halton(_) => (0..=12).any(|k| samples == 6_u32.pow(k)),
            Sampler::PaddedSobol(_) | Sampler::Sobol(_) | Sampler::ZSobol(_) | Sampler::Pmj02Bn(_) => {
                samples.is_power_of_two()
            }
        };
        !self.settings.skip_bad || is_stratified()
    }

    /// The encoded picture of the function over as many pixels.
    fn draw(&self, pixels: &Bounds2i, format: Format) -> Result<Vec<u8>, PassError> {
        let [width, height] = [pixels.width() as u32, pixels.height() as u32];
        let at = |pixel: u32, point: u32, size: u32| {
            (pixel as f32 + (point as f32 + 0.5) / POINTS as f32) / size as f32
        };
        let image = Image::try_from_fn(width, height, ["R", "G", "B"], |x, y| {
            let points = (0..POINTS * POINTS)
                .map(|i| Vec2::new(at(x, i % POINTS, width), at(y, i / POINTS, height)))
                .map(|p| value(self.settings.function, p));
            [(points.sum::<f64>() / f64::from(POINTS * POINTS)) as f32; 3]
        })?;
        Ok(encode(&image, format, &WriteOptions::default())?)
    }
}

impl Integrator for Function {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn prepare(&mut self, _scene: &Scene, _view: &View, _control: &Control) -> Result<(), Cancelled> {
        Ok(())
    }

    fn pass(
        &mut self,
        pass: u32,
        _scene: &Scene,
        view: &View,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, PassError> {
        let pixels = film.pixel_bounds();
        let format = self.settings.image_filename.as_deref().and_then(Format::from_name);
        if let Some(format) = format.filter(|_| self.picture.is_empty()) {
            self.picture = self.draw(&pixels, format)?;
        }
        self.find_errors(pass, &pixels, control)?;
        let lambda: [SampledWavelengths; GROUPS] = std::array::from_fn(|group| {
            // Those of a group are a quarter of the range apart.
            ShutterSample::wavelengths(view, (group as f32 + 0.5) / (4 * GROUPS) as f32)
        });
        let white = lambda.each_ref().map(|lambda| self.white.sample(lambda) * self.white_scale);
        film.tiles_mut()?.into_par_iter().try_for_each(|mut tile| {
            let mut sampler = self.sampler.clone();
            let bounds = tile.bounds();
            for y in bounds.min[1]..bounds.max[1] {
                control.check()?;
                for x in bounds.min[0]..bounds.max[0] {
                    let value = self.value(&mut sampler, [x, y], pass) as f32;
                    let l: [SampledSpectrum; GROUPS] = white.map(|white| white * value);
                    let (first_hit, parts) = (None, None);
                    let sample =
                        film::Sample { l: &l, lambda: &lambda, weight: 1.0, alpha: 1.0, first_hit, parts };
                    tile.add([x, y], &sample);
                }
            }
            Ok::<(), Cancelled>(())
        })?;
        Ok(RayStats::default())
    }

    fn files(&self) -> Vec<OutputFile> {
        let lines = (1..).zip(&self.errors).filter(|(samples, _)| self.is_listed(*samples));
        let errors: String = lines.map(|(samples, error)| format!("{samples} {error:e}\n")).collect();
        let path = self.settings.error_file();
        let picture = self
            .settings
            .image_filename
            .iter()
            .zip([&self.picture])
            .filter(|(_, picture)| !picture.is_empty());
        let errors = [(path, errors.into_bytes())].into_iter().filter(|(_, errors)| !errors.is_empty());
        let files = errors.chain(picture.map(|(path, picture)| (path.clone(), picture.clone())));
        files.map(|(path, contents)| OutputFile { path: path.into(), contents }).collect()
    }
}

/// The value of a function at a point of the unit square.
fn value(function: FunctionKind, p: Vec2) -> f64 {
    /// Squares of a checkerboard along a unit of length.
    const SQUARES: f64 = 10.0;
    /// erf √2: the share of a Gaussian within two standard deviations.
    const WITHIN: f64 = 0.954_499_736_103_641_6;
    let [x, y] = [p.x, p.y].map(f64::from);
    let two_if = |is_inside: bool| if is_inside { 2.0 } else { 0.0 };
    let odd_square = |x: f64, y: f64| ((SQUARES * x).floor() + (SQUARES * y).floor()).rem_euclid(2.0) == 1.0;
    match function {
        FunctionKind::Step => two_if(x < 0.5),
        FunctionKind::Diagonal => two_if(x + y < 1.0),
        FunctionKind::Disk => {
            let is_inside = (x - 0.5).powi(2) + (y - 0.5).powi(2) < 0.25;
            if is_inside { 4.0 / PI } else { 0.0 }
        }
        FunctionKind::Checkerboard => two_if(odd_square(x, y)),
        FunctionKind::RotatedCheckerboard => {
            two_if(odd_square((x - y) * FRAC_1_SQRT_2, (x + y) * FRAC_1_SQRT_2))
        }
        FunctionKind::Gaussian => {
            let variance = 0.25 * 0.25;
            let distance2 = (x - 0.5).powi(2) + (y - 0.5).powi(2);
            libm::exp(-distance2 / (2.0 * variance)) / (2.0 * PI * variance * WITHIN * WITHIN)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use description::schema::{Kind, SettingType, Value};

    fn functions() -> Vec<FunctionKind> {
        let Kind::Choice(names) = FunctionKind::KIND else { panic!("a choice") };
        let named = |name: &&str| FunctionKind::from_value(&Value::Text((*name).to_owned()));
        names.iter().filter_map(named).collect()
    }

    /// Means over a grid, whose error is below a cell's width times the length of all edges.
    #[test]
    fn integrals_are_one() {
        const N: u32 = 1000;
        let functions = functions();
        assert_eq!(functions.len(), 6);
        for function in functions {
            let center = |i: u32| (i as f32 + 0.5) / N as f32;
            let points = (0..N * N).map(|i| Vec2::new(center(i % N), center(i / N)));
            let mean = points.map(|p| value(function, p)).sum::<f64>() / f64::from(N * N);
            assert!((mean - 1.0).abs() < 1.1e-3, "{function:?}: {mean}");
        }
    }

    /// The parity of x − y changes its sign across the diagonal, that of x + y does not.
    #[test]
    fn the_rotated_checkerboard_is_odd_across_the_diagonal() {
        for i in 1..1000_u32 {
            let [x, y] = [0.618_034, 0.754_878].map(|step| (step * i as f32).fract());
            let [p, q] = [[x, y], [y, x]].map(|p| value(FunctionKind::RotatedCheckerboard, p.into()));
            assert_eq!(p + q, 2.0, "{x}, {y}");
        }
    }
}
