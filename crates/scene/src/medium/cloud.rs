//! A procedural cloud.
//!
//! Its density is fractal noise of five octaves, cut off below zero, that thins out with the height
//! y of the medium's space and has a floor below y = ½; noise moves the points at which it is
//! evaluated, so that edges fray. It lies within [0, 1]. Parameters: a factor on the noise (1), the
//! amount of fraying (1), the frequency of the noise (5). Source: [Pharr 2023 §11.4.5].

use super::{Coefficients, MajorantGrid, Majorants, MediumModel, MediumProperties, Placement};
use crate::texture::noise;
use lanes::{Each, InstructionSet, Kernel, MAX_LANES, Real};
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
    /// That which computes it; all give the same.
    pub instruction_set: InstructionSet,
}

impl CloudMedium {
    /// The instruction set for its noise. No more than five values are known at once, and gathers
    /// of sixteen take longer than those of eight.
    pub fn instruction_set() -> InstructionSet {
        match InstructionSet::detect() {
            InstructionSet::Avx512 => InstructionSet::Avx2,
            set => set,
        }
    }
}

/// Computes the density of a cloud at a point of the medium's space. Noise takes most of the time
/// of paths through clouds, so lanes have its values at the points that are known at once.
struct Density<'a> {
    cloud: &'a CloudMedium,
    p: Point3,
}

impl Kernel for Density<'_> {
    type Output = f32;

    #[inline(always)]
    fn run<R: Real>(self) -> f32 {
        let Self { cloud, p } = self;
        let mut place = p * cloud.frequency;
        if cloud.wispiness > 0.0 {
            let (mut amount, mut frequency) = (0.05 * cloud.wispiness, 10.0);
            for _ in 0..2 {
                place += gradient::<R>(place * frequency) * amount;
                amount *= 0.5;
                frequency *= LACUNARITY;
            }
        }
        let (mut octaves, mut frequency) = ([place; 5], 1.0);
        for octave in &mut octaves {
            *octave = place * frequency;
            frequency *= LACUNARITY;
        }
        let (mut sum, mut weight) = (0.0, 0.5);
        for octave in noises::<R, 5>(octaves) {
            sum += weight * octave;
            weight *= 0.5;
        }
        let shape = ((1.0 - p.y) * 4.5 * cloud.density * sum).clamp(0.0, 1.0);
        (shape + 2.0 * (0.5 - p.y).max(0.0)).clamp(0.0, 1.0)
    }
}

/// The gradient of the noise, by forward differences.
#[inline(always)]
fn gradient<R: Real>(p: Point3) -> Vector3 {
    const STEP: f32 = 0.01;
    let at = |axis: Vec3| p + axis * STEP;
    let [here, x, y, z] = noises::<R, 4>([p, at(Vec3::X), at(Vec3::Y), at(Vec3::Z)]);
    (Vec3::new(x, y, z) - Vec3::splat(here)) / STEP
}

/// The noise at `K` points.
#[inline(always)]
fn noises<R: Real, const K: usize>(points: [Point3; K]) -> [f32; K] {
    const { assert!(K <= MAX_LANES / 2) };
    let mut columns = [[0.0; MAX_LANES]; 3];
    for (i, p) in points.iter().enumerate() {
        columns.iter_mut().zip(p.to_array()).for_each(|(column, x)| column[i] = x);
    }
    let mut values = [0.0; MAX_LANES];
    for first in (0..K).step_by(R::LANES) {
        let [x, y, z] = columns.each(|column| R::load(&column[first..]));
        noise(Vec3::new(x, y, z)).store(&mut values[first..]);
    }
    *values.first_chunk().expect("invariant: K is smaller")
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
        let density = self.instruction_set.dispatch(Density { cloud: self, p: place });
        self.coefficients.at(density, lambda)
    }

    fn majorants<'a>(&'a self, ray: &Ray, t_max: f32, lambda: &SampledWavelengths) -> Majorants<'a> {
        self.majorants.along(&self.placement, ray, t_max, self.coefficients.at(1.0, lambda).sigma_t())
    }
}
