//! The tables of measured BRDFs.

use math::{Point2, lerp};
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
    pub(super) normals: PiecewiseBilinear2d,
    pub(super) luminance: PiecewiseBilinear2d,
}

impl fmt::Debug for MeasuredTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let directions = [self.data.phi.len(), self.data.theta.len()];
        f.debug_struct("MeasuredTable").field("directions", &directions).finish_non_exhaustive()
    }
}

/// The place of an outgoing direction between those of a table.
pub(super) struct Between {
    layers: [(usize, f32); 4],
    count: usize,
}

impl Between {
    /// The directions around it, with their weights.
    pub fn layers(&self) -> LayerWeights<'_> {
        &self.layers[..self.count]
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

    /// Whether azimuths count from that of the outgoing direction.
    pub(super) fn is_isotropic(&self) -> bool {
        self.data.phi.len() <= 2
    }

    /// The place of an outgoing direction.
    pub(super) fn between(&self, phi: f32, theta: f32) -> Between {
        let ((i, s), (j, t)) = (place(&self.data.phi, phi), place(&self.data.theta, theta));
        let next = (j + 1).min(self.data.theta.len() - 1);
        let layer = |i: usize, j: usize| i * self.data.theta.len() + j;
        let after = if s > 0.0 { i + 1 } else { i };
        let layers = [
            (layer(i, j), (1.0 - s) * (1.0 - t)),
            (layer(i, next), (1.0 - s) * t),
            (layer(after, j), s * (1.0 - t)),
            (layer(after, next), s * t),
        ];
        Between { layers, count: if s > 0.0 { 4 } else { 2 } }
    }

    /// The density of microfacet normals at a point of the square.
    pub(super) fn ndf(&self, p: Point2) -> f32 {
        self.data.ndf.at(0, p).max(0.0)
    }

    /// The projected area of microfacets towards a point of the square.
    pub(super) fn sigma(&self, p: Point2) -> f32 {
        self.data.sigma.at(0, p)
    }

    /// The reflectances at a point of the square; beyond the wavelengths measured, those at their
    /// ends.
    pub(super) fn values(
        &self,
        u: Point2,
        between: &Between,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let channels = self.data.wavelengths.as_ref().map_or(3, Vec::len);
        let channel = |channel: usize| -> f32 {
            let value =
                |&(layer, weight): &(usize, f32)| weight * self.data.values.at(layer * channels + channel, u);
            between.layers().iter().map(value).sum()
        };
        let Some(wavelengths) = &self.data.wavelengths else {
            let rgb = RgbUnboundedSpectrum::new(RgbColorSpace::srgb(), [0, 1, 2].map(channel));
            return SampledSpectrum::new(lambda.lambda().map(|lambda| rgb.at(lambda)));
        };
        SampledSpectrum::new(lambda.lambda().map(|lambda| {
            let (i, t) = place(wavelengths, lambda);
            let value = if t > 0.0 { lerp(t, channel(i), channel(i + 1)) } else { channel(i) };
            value.max(0.0)
        }))
    }
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
        if !self.values.iter().all(|value| value.is_finite()) {
            return Err(format!("its {what} are not all finite"));
        }
        Ok(())
    }

    /// The interpolated value of a layer at a point of the unit square.
    fn at(&self, layer: usize, p: Point2) -> f32 {
        let [width, height] = self.size;
        let (x, y) = (p.x * (width - 1) as f32, p.y * (height - 1) as f32);
        let (column, row) = ((x as usize).min(width - 2), (y as usize).min(height - 2));
        let first = (layer * height + row) * width + column;
        let (x, y) = (x - column as f32, y - row as f32);
        let row = |first: usize| lerp(x, self.values[first], self.values[first + 1]);
        lerp(y, row(first), row(first + width))
    }
}

fn increasing(numbers: &[f32], what: &str) -> Result<(), String> {
    let is_increasing = numbers.windows(2).all(|pair| pair[0] < pair[1]);
    if numbers.is_empty() || !is_increasing || !numbers.iter().all(|number| number.is_finite()) {
        return Err(format!("its {what} are not increasing numbers"));
    }
    Ok(())
}

/// The number before `x` in increasing ones, and how far `x` is towards the next, in [0, 1): beyond
/// them, the first or the last.
fn place(numbers: &[f32], x: f32) -> (usize, f32) {
    let after = numbers.partition_point(|&number| number <= x);
    match (after.checked_sub(1), numbers.get(after)) {
        (None, _) => (0, 0.0),
        (Some(i), None) => (i, 0.0),
        (Some(i), Some(next)) => (i, (x - numbers[i]) / (next - numbers[i])),
    }
}
