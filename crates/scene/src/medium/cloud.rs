//! A procedural cloud.
//!
//! Its density is fractal noise of five octaves, cut off below zero, that thins out with the height
//! y of the medium's space and has a floor below y = ½; noise moves the points at which it is
//! evaluated, so that edges fray. It lies within [0, 1]. Parameters: a factor on the noise (1), the
//! amount of fraying (1), the frequency of the noise (5). Source: [Pharr 2023 §11.4.5].

use super::{Coefficients, MajorantGrid, Majorants, MediumModel, MediumProperties, Placement};
use crate::texture::noise;
use math::{Bounds3, Point3, Ray, Vec3, Vector3};
use spectrum::SampledWavelengths;

/// The ratio of frequencies of successive octaves: not quite 2, so that their lattices differ.
const LACUNARITY: f32 = 1.99;

/// A procedural cloud.
#[derive(Clone, Debug)]
pub struct CloudMedium {
    /// Position of its box.
    pub placement: Placement,
    /// The box in the medium's space.
    pub bounds: Bounds3,
    /// Absorption and scattering at density 1.
    pub coefficients: Coefficients,
    /// Bounds of the density.
    pub majorants: MajorantGrid,
    /// Factor on the noise.
    pub density: f32,
    /// The amount of fraying.
    pub wispiness: f32,
    /// Frequency of the noise.
    pub frequency: f32,
}

impl CloudMedium {
    /// The density at a point of the medium's space.
    fn density(&self, p: Point3) -> f32 {
        let mut place = p * self.frequency;
        if self.wispiness > 0.0 {
            let (mut amount, mut frequency) = (0.05 * self.wispiness, 10.0);
            for _ in 0..2 {
                place += gradient(place * frequency) * amount;
                amount *= 0.5;
                frequency *= LACUNARITY;
            }
        }
        let (mut sum, mut weight, mut frequency) = (0.0, 0.5, 1.0);
        for _ in 0..5 {
            sum += weight * noise(place * frequency);
            weight *= 0.5;
            frequency *= LACUNARITY;
        }
        let shape = ((1.0 - p.y) * 4.5 * self.density * sum).clamp(0.0, 1.0);
        (shape + 2.0 * (0.5 - p.y).max(0.0)).clamp(0.0, 1.0)
    }
}

/// The gradient of the noise, by forward differences.
fn gradient(p: Point3) -> Vector3 {
    const STEP: f32 = 0.01;
    let here = noise(p);
    let there = |axis: Vec3| noise(p + axis * STEP);
    (Vec3::new(there(Vec3::X), there(Vec3::Y), there(Vec3::Z)) - Vec3::splat(here)) / STEP
}

impl MediumModel for CloudMedium {
    fn is_emissive(&self) -> bool {
        false
    }

    fn bounds(&self) -> Option<Bounds3> {
        Some(self.placement.bounds())
    }

    fn at(&self, p: Point3, lambda: &SampledWavelengths) -> MediumProperties {
        let Some(p) = self.placement.point(p) else { return MediumProperties::default() };
        let place = self.bounds.min + p * self.bounds.diagonal();
        self.coefficients.at(self.density(place), lambda)
    }

    fn majorants<'a>(&'a self, ray: &Ray, t_max: f32, lambda: &SampledWavelengths) -> Majorants<'a> {
        self.majorants.along(&self.placement, ray, t_max, self.coefficients.at(1.0, lambda).sigma_t())
    }
}
