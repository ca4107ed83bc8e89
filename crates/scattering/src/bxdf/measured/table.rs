//! The tables of measured BRDFs.

use lanes::{Each, Int, Mask, Real};
use math::{Point2, Vec2, lerp};
use sampling::{LayerWeights, PiecewiseBilinear2d};
use spectrum::{RgbColorSpace, RgbUnboundedSpectrum, SampledSpectrum, SampledWavelengths};
use std::fmt;

/// Layers of numbers on grids over the unit square, row by row from y = 0 on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredGrid {
    /// Points along x and y.
    pub size: [usize; 2],
    /// The numbers of all layers.
    pub values: Vec<f32>,
}

/// What a file of measurements has, to be made a [`MeasuredTable`]. The layers of grids have one
/// grid for each azimuth, and in it for each elevation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredData {
    /// Azimuths of outgoing directions in radians, increasing; up to two for an isotropic material.
    pub phi: Vec<f32>,
    /// Their angles to the normal in radians, increasing.
    pub theta: Vec<f32>,
    /// The wavelengths of the values in nanometres, increasing; `None` for red, green and blue of
    /// sRGB.
    pub wavelengths: Option<Vec<f32>>,
    /// The density of microfacet normals.
    pub ndf: MeasuredGrid,
    /// The projected area of microfacets.
    pub sigma: MeasuredGrid,
    /// The densities of visible normals, by outgoing direction.
    pub vndf: MeasuredGrid,
    /// The densities of samples, by outgoing direction.
    pub luminance: MeasuredGrid,
    /// The reflectances, by outgoing direction, then wavelength.
    pub values: MeasuredGrid,
}

/// The tables of a material.
#[derive(Clone, PartialEq)]
pub struct MeasuredTable {
    data: MeasuredData,
    normals: PiecewiseBilinear2d,
    luminance: PiecewiseBilinear2d,
}

impl fmt::Debug for MeasuredTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let directions = [self.data.phi.len(), self.data.theta.len()];
        f.debug_struct("MeasuredTable").field("directions", &directions).finish_non_exhaustive()
    }
}

impl MeasuredTable {
    /// Makes tables of measurements; on failure, the reason.
    pub fn new(data: MeasuredData) -> Result<Self, String> {
        let MeasuredData { phi, theta, wavelengths, ndf, sigma, vndf, luminance, values } = &data;
        increasing(phi, "azimuths")?;
        increasing(theta, "elevations")?;
        if let Some(wavelengths) = wavelengths {
            increasing(wavelengths, "wavelengths")?;
        }
        let directions = phi.len() * theta.len();
        let channels = wavelengths.as_ref().map_or(3, Vec::len);
        ndf.check("normals", 1)?;
        sigma.check("projected areas", 1)?;
        vndf.check("visible normals", directions)?;
        luminance.check("luminances", directions)?;
        values.check("reflectances", directions * channels)?;
        if sigma.values.iter().any(|&area| area <= 0.0) {
            return Err("its projected areas are not all above 0".into());
        }
        Ok(Self {
            normals: PiecewiseBilinear2d::new(vndf.size, &vndf.values),
            luminance: PiecewiseBilinear2d::new(luminance.size, &luminance.values),
            data,
        })
    }

    /// The measurements that they are made of.
    pub fn data(&self) -> &MeasuredData {
        &self.data
    }

    /// The densities of visible normals and of samples, for an engine that looks them up elsewhere.
    pub fn densities(&self) -> [&PiecewiseBilinear2d; 2] {
        [&self.normals, &self.luminance]
    }

    /// Whether azimuths count from that of the outgoing direction.
    pub(super) fn is_isotropic(&self) -> bool {
        self.data.phi.len() <= 2
    }

    /// The place of an outgoing direction.
    #[inline(always)]
    pub(super) fn between<R: Real>(&self, phi: R, theta: R) -> LayerWeights<R> {
        let (i, s) = place(&self.data.phi, phi);
        let (j, t) = place(&self.data.theta, theta);
        let is_between = s.gt(R::zero());
        let step = R::Int::splat(self.data.theta.len() as u32);
        let low = i.wrapping_mul(step);
        let high = R::Int::select(is_between, low.wrapping_add(step), low);
        let next = R::Int::select(t.gt(R::zero()), j.wrapping_add(R::Int::splat(1)), j);
        let (before, early) = (R::one() - s, R::one() - t);
        LayerWeights {
            layers: [
                low.wrapping_add(j),
                low.wrapping_add(next),
                high.wrapping_add(j),
                high.wrapping_add(next),
            ],
            weights: [before * early, before * t, s * early, s * t],
            count: if is_between.any() { 4 } else { 2 },
        }
    }

    /// What [`PiecewiseBilinear2d::sample`] makes of `u` by the luminances of samples.
    #[inline(always)]
    pub(super) fn sample_luminance<R: Real>(&self, u: Vec2<R>, between: &LayerWeights<R>) -> Point2<R> {
        self.luminance.sample(u, between).0
    }

    /// The density of these samples.
    #[inline(always)]
    pub(super) fn luminance_pdf<R: Real>(&self, u: Point2<R>, between: &LayerWeights<R>) -> R {
        self.luminance.pdf(u, between)
    }

    /// The point of the square that visible normals have for `u`.
    #[inline(always)]
    pub(super) fn sample_normal<R: Real>(&self, u: Vec2<R>, between: &LayerWeights<R>) -> Point2<R> {
        self.normals.sample(u, between).0
    }

    /// The `u` of a point, and the density of visible normals there.
    #[inline(always)]
    pub(super) fn invert_normal<R: Real>(&self, at: Point2<R>, between: &LayerWeights<R>) -> (Vec2<R>, R) {
        self.normals.invert(at, between)
    }

    /// The density of microfacet normals at a point of the square.
    #[inline(always)]
    pub(super) fn ndf<R: Real>(&self, p: Point2<R>) -> R {
        let cell = self.data.ndf.cell(p);
        self.data.ndf.at(R::Int::splat(0), &cell).max(R::zero())
    }

    /// The projected area of microfacets towards a point of the square.
    #[inline(always)]
    pub(super) fn sigma<R: Real>(&self, p: Point2<R>) -> R {
        let cell = self.data.sigma.cell(p);
        self.data.sigma.at(R::Int::splat(0), &cell)
    }

    /// The reflectances at a point of the square; beyond the wavelengths measured, those at their
    /// ends.
    #[inline(always)]
    pub(super) fn values<R: Real>(
        &self,
        u: Point2<R>,
        between: &LayerWeights<R>,
        lambda: &SampledWavelengths<R>,
    ) -> SampledSpectrum<R> {
        let cell = self.data.values.cell(u);
        let mut sampled = SampledSpectrum::zero();
        let Some(wavelengths) = &self.data.wavelengths else {
            let mut channels = [R::zero(); 3];
            for (i, channel) in channels.iter_mut().enumerate() {
                *channel = self.channel(R::Int::splat(i as u32), 3, &cell, between);
            }
            let rgb = RgbUnboundedSpectrum::new(RgbColorSpace::srgb(), channels);
            for (value, &lambda) in sampled.0.iter_mut().zip(lambda.lambda()) {
                *value = rgb.at(lambda);
            }
            return sampled;
        };
        let count = wavelengths.len() as u32;
        for (value, &lambda) in sampled.0.iter_mut().zip(lambda.lambda()) {
            let (i, t) = place(wavelengths, lambda);
            let next = R::Int::select(t.gt(R::zero()), i.wrapping_add(R::Int::splat(1)), i);
            let below = self.channel(i, count, &cell, between);
            let above = self.channel(next, count, &cell, between);
            *value = lerp(t, below, above).max(R::zero());
        }
        sampled
    }

    /// The reflectance of one of so many channels in a cell of the square.
    #[inline(always)]
    fn channel<R: Real>(
        &self,
        channel: R::Int,
        channels: u32,
        cell: &Cell<R>,
        between: &LayerWeights<R>,
    ) -> R {
        let mut sum = R::zero();
        for i in 0..between.count {
            let layer = between.layers[i].wrapping_mul(R::Int::splat(channels)).wrapping_add(channel);
            sum += between.weights[i] * self.data.values.at(layer, cell);
        }
        sum
    }
}

/// A cell of a grid, by the index of its first point in a layer, and the position in it.
struct Cell<R: Real> {
    first: R::Int,
    x: R,
    y: R,
}

impl MeasuredGrid {
    /// Says what is wrong with `layers` layers of `what`.
    fn check(&self, what: &str, layers: usize) -> Result<(), String> {
        let [width, height] = self.size;
        if width < 2 || height < 2 {
            return Err(format!("its {what} are on a grid of {width} × {height} points, less than 2 × 2"));
        }
        let points = width.checked_mul(height).and_then(|points| points.checked_mul(layers));
        if points != Some(self.values.len()) {
            return Err(format!("its {what} do not have {layers} layers of {width} × {height} numbers"));
        }
        if u32::try_from(self.values.len()).is_err() {
            return Err(format!("its {what} are more than 2³² numbers"));
        }
        if !self.values.iter().all(|value| value.is_finite()) {
            return Err(format!("its {what} are not all finite"));
        }
        Ok(())
    }

    /// The cell of a point of the unit square.
    #[inline(always)]
    fn cell<R: Real>(&self, p: Point2<R>) -> Cell<R> {
        let [columns, rows] = self.size.each(|size| R::splat((size - 1) as f32));
        let (x, y) = (p.x * columns, p.y * rows);
        let column = x.floor().clamp(R::zero(), columns - R::one());
        let row = y.floor().clamp(R::zero(), rows - R::one());
        let first = row.to_int().wrapping_mul(R::Int::splat(self.size[0] as u32));
        Cell { first: first.wrapping_add(column.to_int()), x: x - column, y: y - row }
    }

    /// The interpolated value of a layer in a cell.
    #[inline(always)]
    fn at<R: Real>(&self, layer: R::Int, cell: &Cell<R>) -> R {
        let [width, height] = self.size.each(|size| size as u32);
        let first = layer.wrapping_mul(R::Int::splat(width * height)).wrapping_add(cell.first);
        let [a, b] = R::gather_rows(&self.values, first);
        let [c, d] = R::gather_rows(&self.values, first.wrapping_add(R::Int::splat(width)));
        lerp(cell.y, lerp(cell.x, a, b), lerp(cell.x, c, d))
    }
}

fn increasing(numbers: &[f32], what: &str) -> Result<(), String> {
    let is_increasing = numbers.windows(2).all(|pair| pair[0] < pair[1]);
    if numbers.is_empty() || !is_increasing || !numbers.iter().all(|number| number.is_finite()) {
        return Err(format!("its {what} are not increasing numbers"));
    }
    Ok(())
}

/// The number before `x` in increasing ones, and how far `x` is towards the next, in [0, 1]: beyond
/// them, the first or the last, and 0.
#[inline(always)]
fn place<R: Real>(numbers: &[f32], x: R) -> (R::Int, R) {
    let last = R::Int::splat(numbers.len() as u32 - 1);
    let (mut before, mut step) = (R::Int::splat(0), (numbers.len() as u32).next_power_of_two() / 2);
    while step > 0 {
        let next = before.wrapping_add(R::Int::splat(step));
        let next = R::Int::select(last.lt(next), before, next);
        before = R::Int::select(R::gather(numbers, next).le(x), next, before);
        step /= 2;
    }
    let after = R::Int::select(before.lt(last), before.wrapping_add(R::Int::splat(1)), before);
    let (low, high) = (R::gather(numbers, before), R::gather(numbers, after));
    let t = (x - low) / (high - low);
    (before, R::select(x.gt(low) & low.lt(high), t, R::zero()))
}
