//! Images of the whole sphere of directions: their two projections, and conversion between them.
//!
//! Directions have +z up. A position st has (0, 0) at the upper left of the image.
//!
//! - Equal-area: a square image in the octahedral mapping of [Clarberg 2008], as the pbrt-v4 format
//!   has it ([Pharr 2023 §3.8.3]). Every pixel has the same solid angle.
//! - Latitude–longitude: an image twice as wide as high, s = φ/2π with φ from +x towards +y,
//!   t = θ/π with θ from +z, so that the top row is up: the convention of pbrt-v3 and of the
//!   conversion `imgtool makeequiarea` of pbrt-v4. A pixel's solid angle goes with sin θ.
//!
//! A pixel of a converted image is the mean over its footprint: of n × n positions spread over it,
//! weighted by solid angle, at each of which the source is interpolated bilinearly. n is such that
//! neighbouring positions are at most half a source pixel apart, so that every source pixel counts
//! by its solid angle, to within 2 % except in the rows at the poles. At last each channel is
//! scaled so that its mean over the sphere is exactly kept.

use crate::{
    error::ImageError,
    image::{Image, Pixels},
    memory::{collected, filled},
    wrap::WrapMode,
};
use lanes::{Real, atan2, hypot};
use math::{
    Point2, Vec2, Vector3, equal_area_sphere_to_square, equal_area_square_to_sphere, sin_cos,
    spherical_direction, spherical_phi,
};
use rayon::prelude::*;
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// How an image shows the sphere of directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// The equal-area octahedral mapping; square.
    EqualArea,
    /// Longitude along the rows, latitude along the columns; twice as wide as high.
    LatitudeLongitude,
}

impl Projection {
    /// The projection of an image of the sphere of this size, if it has the shape of either.
    pub fn of_size(width: u32, height: u32) -> Option<Self> {
        if width == height {
            Some(Self::EqualArea)
        } else if u64::from(width) == 2 * u64::from(height) {
            Some(Self::LatitudeLongitude)
        } else {
            None
        }
    }

    /// The unit direction that is shown at `st` ∈ [0, 1]².
    #[inline(always)]
    pub fn direction<R: Real>(self, st: Point2<R>) -> Vector3<R> {
        match self {
            Self::EqualArea => equal_area_square_to_sphere(st),
            Self::LatitudeLongitude => {
                let (sin_theta, cos_theta) = sin_cos(R::splat(PI) * st.y);
                spherical_direction(sin_theta, cos_theta, R::splat(TAU) * st.x)
            }
        }
    }

    /// The position in [0, 1]² at which a unit direction is shown.
    #[inline(always)]
    pub fn position<R: Real>(self, w: Vector3<R>) -> Point2<R> {
        match self {
            Self::EqualArea => equal_area_sphere_to_square(w),
            // Unlike the arc cosine, this is exact near the poles.
            Self::LatitudeLongitude => {
                let theta = atan2(hypot(w.x, w.y), w.z);
                Point2::new(spherical_phi(w) / R::splat(TAU), theta / R::splat(PI))
            }
        }
    }

    /// Solid angle per area of [0, 1]² at `st`, as a part of 4π: its mean over the square is 1.
    #[inline(always)]
    pub fn solid_angle_density<R: Real>(self, st: Point2<R>) -> R {
        match self {
            Self::EqualArea => R::one(),
            Self::LatitudeLongitude => R::splat(FRAC_PI_2) * sin_cos(R::splat(PI) * st.y).0.max(R::zero()),
        }
    }

    /// Solid angle of a pixel in row `y` of an image with `height` rows, as a multiple of the mean
    /// pixel's: between two parallels, ½·height·(cos θ₀ − cos θ₁).
    pub fn row_solid_angle(self, y: u32, height: u32) -> f32 {
        match self {
            Self::EqualArea => 1.0,
            Self::LatitudeLongitude => {
                let half = FRAC_PI_2 / height as f32;
                height as f32 * lanes::sin(half) * lanes::sin((2 * y + 1) as f32 * half)
            }
        }
    }

    /// What lies beyond the edges of an image: its neighbours on the sphere.
    pub fn wrap(self) -> WrapMode {
        match self {
            Self::EqualArea => WrapMode::OctahedralSphere,
            Self::LatitudeLongitude => WrapMode::LatitudeLongitude,
        }
    }

    /// The least and greatest angles between neighbouring pixels about `w`, in an image `width`
    /// pixels wide. No less than `floor` counts for the distance of meridians near a pole.
    fn pixel_angles(self, width: f32, w: Vector3, floor: f32) -> [f32; 2] {
        match self {
            // Bounds on the singular values of the mapping, which are those of r = 0 and r = 1.
            Self::EqualArea => [2.2 / width, 5.7 / width],
            Self::LatitudeLongitude => {
                let step = TAU / width;
                [step * lanes::hypot(w.x, w.y).max(floor), step]
            }
        }
    }
}

impl Image {
    /// This image of the sphere in another projection, as wide as it is now (to an even number of
    /// pixels). Refused if it has the shape of neither projection, and where there is no memory
    /// for it.
    pub fn reproject(&self, to: Projection) -> Result<Self, ImageError> {
        let Some(from) = Projection::of_size(self.width(), self.height()) else {
            return Err(ImageError::Invalid(format!(
                "{} × {} pixels are neither square (equal-area) nor 2:1 (latitude–longitude)",
                self.width(),
                self.height()
            )));
        };
        if from == to {
            return Ok(self.clone());
        }
        let width = self.width().next_multiple_of(2);
        let height = if to == Projection::EqualArea { width } else { width / 2 };
        let source =
            collected(self.width() as usize * self.height() as usize * self.channel_count(), self.values())?;
        let source = Source { values: &source, size: [self.width(), self.height()], projection: from };
        let count = self.channel_count();
        let mut values = filled(width as usize * height as usize * count, 0.0)?;
        values.par_chunks_mut(width as usize * count).zip(0..height).for_each(|(row, y)| {
            let mut sum = vec![0.0; count];
            for (pixel, x) in row.chunks_exact_mut(count).zip(0..width) {
                source.average(to, [x, y], [width, height], &mut sum);
                pixel.iter_mut().zip(&sum).for_each(|(value, sum)| *value = *sum as f32);
            }
        });
        let before = means(source.values, from, source.size);
        let after = means(&values, to, [width, height]);
        for (c, (before, after)) in before.into_iter().zip(after).enumerate() {
            let factor = (before / after) as f32;
            if factor.is_normal() {
                values[c..].iter_mut().step_by(count).for_each(|value| *value *= factor);
            }
        }
        let mut image = Self::new(width, height, self.channels(), Pixels::F32(values))?;
        image.metadata = self.metadata.clone();
        (image.metadata.data_window, image.metadata.display_window) = (None, None);
        image.stored_as(self.pixels())
    }
}

/// The means of the channels over the sphere.
fn means(values: &[f32], projection: Projection, [width, height]: [u32; 2]) -> Vec<f64> {
    let row_length = values.len() / height as usize;
    let mut sums = vec![0.0; row_length / width as usize];
    for (row, y) in values.chunks_exact(row_length).zip(0..height) {
        let weight = f64::from(projection.row_solid_angle(y, height));
        for pixel in row.chunks_exact(sums.len()) {
            sums.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += weight * f64::from(*value));
        }
    }
    sums.iter().map(|sum| sum / (f64::from(width) * f64::from(height))).collect()
}

/// The image that is converted.
struct Source<'a> {
    values: &'a [f32],
    size: [u32; 2],
    projection: Projection,
}

impl Source<'_> {
    /// The mean over the footprint of a pixel of an image of this size in another projection, by
    /// channel.
    fn average(&self, to: Projection, pixel: [u32; 2], size: [u32; 2], mean: &mut [f64]) {
        let size = Vec2::new(size[0] as f32, size[1] as f32);
        let corner = Vec2::new(pixel[0] as f32, pixel[1] as f32);
        let center = to.direction((corner + 0.5) / size);
        let [_, extent] = to.pixel_angles(size.x, center, 0.0);
        let [step, _] = self.projection.pixel_angles(self.size[0] as f32, center, 0.5 * extent);
        let n = (2.0 * extent / step).ceil() as u32;
        mean.fill(0.0);
        let mut weight = 0.0;
        for i in 0..n * n {
            let offset = (Vec2::new((i % n) as f32, (i / n) as f32) + 0.5) / n as f32;
            let st = (corner + offset) / size;
            let part = f64::from(to.solid_angle_density(st));
            weight += part;
            self.add(self.projection.position(to.direction(st)), part, mean);
        }
        mean.iter_mut().for_each(|value| *value /= weight);
    }

    /// Adds the bilinearly interpolated values at `st`, times `weight`.
    fn add(&self, st: Point2, weight: f64, sum: &mut [f64]) {
        let [width, height] = self.size;
        let position = st * Vec2::new(width as f32, height as f32) - 0.5;
        let first = position.map(f32::floor);
        let d = (position - first).as_dvec2();
        for (x, y, part) in [
            (0, 0, (1.0 - d.x) * (1.0 - d.y)),
            (1, 0, d.x * (1.0 - d.y)),
            (0, 1, (1.0 - d.x) * d.y),
            (1, 1, d.x * d.y),
        ] {
            let (x, y) = (first.x as i32 + x, first.y as i32 + y);
            let Some((x, y)) = self.projection.wrap().apply(x, y, width, height) else { continue };
            let texel = (y as usize * width as usize + x as usize) * sum.len();
            for (sum, value) in sum.iter_mut().zip(&self.values[texel..]) {
                *sum += weight * part * f64::from(*value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Projection::{EqualArea, LatitudeLongitude};
    use math::Vec3;

    const BOTH: [(Projection, Projection); 2] =
        [(EqualArea, LatitudeLongitude), (LatitudeLongitude, EqualArea)];

    fn image(projection: Projection, width: u32, pixel: impl Fn(Vector3) -> [f32; 3]) -> Image {
        let height = if projection == EqualArea { width } else { width / 2 };
        let size = Vec2::new(width as f32, height as f32);
        Image::from_fn(width, height, ["R", "G", "B"], |x, y| {
            pixel(projection.direction((Vec2::new(x as f32, y as f32) + 0.5) / size))
        })
    }

    /// The mean over the sphere of one channel.
    fn mean(image: &Image, c: usize) -> f64 {
        let projection = Projection::of_size(image.width(), image.height()).expect("a sphere");
        let mut sum = 0.0;
        for y in 0..image.height() {
            let weight = f64::from(projection.row_solid_angle(y, image.height()));
            sum += (0..image.width()).map(|x| weight * f64::from(image.channel(x, y, c))).sum::<f64>();
        }
        sum / f64::from(image.width() * image.height())
    }

    #[test]
    fn directions_and_positions_are_inverse() {
        for projection in [EqualArea, LatitudeLongitude] {
            for i in 0..1000 {
                let st = Vec2::new((i as f32 * 0.618_034).fract(), (i as f32 + 0.5) / 1000.0);
                let back = projection.position(projection.direction(st));
                // At the edges of the square, and at the poles, positions share directions.
                let again = projection.direction(back);
                assert!((again - projection.direction(st)).length() < 2e-6, "{projection:?} {st}");
            }
        }
    }

    #[test]
    fn rows_make_up_the_sphere() {
        for (y, height, part) in [(0, 1, 1.0), (0, 3, 0.75), (1, 3, 1.5), (0, 4, 2.0 - 2_f32.sqrt())] {
            let found = LatitudeLongitude.row_solid_angle(y, height);
            assert!((found - part).abs() < 1e-6, "{found} {part}");
        }
        let t = 0.3;
        let row = LatitudeLongitude.row_solid_angle(300, 1000);
        assert!((row - LatitudeLongitude.solid_angle_density(Vec2::new(0.1, t + 0.0005))).abs() < 1e-5);
    }

    #[test]
    fn the_axes_are_where_the_convention_puts_them() {
        for (w, s, t) in [
            (Vec3::X, 0.0, 0.5),
            (Vec3::Y, 0.25, 0.5),
            (-Vec3::X, 0.5, 0.5),
            (-Vec3::Y, 0.75, 0.5),
            (Vec3::new(1e-6, 1e-6, 1.0), 0.125, 0.0),
            (Vec3::new(-1e-6, 1e-6, -1.0), 0.375, 1.0),
        ] {
            assert!((LatitudeLongitude.position(w) - Vec2::new(s, t)).length() < 1e-6, "{w}");
        }
    }

    #[test]
    fn a_constant_stays_constant() {
        for (from, to) in BOTH {
            for width in [2, 7, 16, 33] {
                let width = if from == EqualArea { width } else { 2 * width };
                let converted = image(from, width, |_| [0.25, 1.0, 40.0]).reproject(to).unwrap();
                assert_eq!(Projection::of_size(converted.width(), converted.height()), Some(to));
                for (i, value) in converted.values().enumerate() {
                    let expected = [0.25, 1.0, 40.0][i % 3];
                    assert!((value - expected).abs() < 1e-5 * expected, "{value}");
                }
            }
        }
    }

    #[test]
    fn the_mean_over_the_sphere_is_kept() {
        // Noise; one bright pixel; and one in each of several places.
        for (from, to) in BOTH {
            for width in [32, 100] {
                let noise = |w: Vector3| {
                    let x = (w.dot(Vec3::new(127.1, 311.7, 74.7)).sin() * 43_758.547).fract().abs();
                    [x * x * x * x * 100.0, w.z + 1.0, w.x + 1.0]
                };
                let original = image(from, width, noise);
                let converted = original.reproject(to).unwrap();
                for c in 0..3 {
                    let (before, after) = (mean(&original, c), mean(&converted, c));
                    assert!((after / before - 1.0).abs() < 1e-5, "{from:?} {width}: {before} {after}");
                }
                for i in 1..20 {
                    let (x, y) = (original.width() * i / 20, original.height() * (i * 7 % 20) / 20);
                    let sun = Image::from_fn(original.width(), original.height(), ["Y"], |i, j| {
                        [if (i, j) == (x, y) { 1e4 } else { 0.0 }]
                    });
                    let (before, after) = (mean(&sun, 0), mean(&sun.reproject(to).unwrap(), 0));
                    assert!((after / before - 1.0).abs() < 1e-5, "({x}, {y}): {before} {after}");
                }
            }
        }
    }

    #[test]
    fn there_and_back_keeps_the_picture() {
        for (from, to) in BOTH {
            let smooth = |w: Vector3| [1.5 + w.x, 1.5 + w.y, 1.5 + w.z];
            let original = image(from, 64, smooth);
            let expected = image(to, 64, smooth);
            let there = original.reproject(to).unwrap();
            for (found, expected) in there.values().zip(expected.values()) {
                assert!((found - expected).abs() < 0.03, "{found} {expected}");
            }
            let back = there.reproject(from).unwrap();
            assert_eq!((back.width(), back.height()), (original.width(), original.height()));
            for (found, expected) in back.values().zip(original.values()) {
                assert!((found - expected).abs() < 0.05, "{found} {expected}");
            }
        }
    }

    #[test]
    fn other_shapes_are_refused() {
        let image = Image::from_fn(3, 2, ["Y"], |_, _| [1.0]);
        assert!(image.reproject(EqualArea).unwrap_err().to_string().contains("3 × 2"));
    }
}
