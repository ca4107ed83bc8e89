//! The lights that are sampled, and shine, in lanes: triangles and rectangles of one colour.

use geometry::{FlatShape, HitColumns};
use lanes::{Int, Mask, Real};
use math::{Normal3, Vec3, Vector3};
use scene::Scene;
use scene::light::{Light, LightId};
use spectrum::{SampledSpectrum, SampledWavelengths};

/// Scenes with more lights sample all of them one by one, so that the table stays small.
const MAX_LIGHTS: usize = 1 << 16;

/// Numbers of a row: corner, sides, normal, scale of the emission, 1 for triangles, and two zeros.
const NUMBERS: usize = 16;

/// The triangles and rectangles among the lights of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct AreaLights {
    /// The row of each light; [`NONE`](Self::NONE) for those not in the table.
    row: Vec<u32>,
    numbers: Vec<f32>,
    /// The emission of each row.
    emission: Vec<u32>,
}

/// Lights of the table, one for each lane.
pub(super) struct Emitters<R: Real> {
    pub shape: FlatShape<R>,
    emission: R::Int,
    /// The scale of the emission.
    scale: R,
}

impl AreaLights {
    /// The row of lights that are not in the table.
    const NONE: u32 = u32::MAX;

    /// Those of a scene.
    pub fn new(scene: &Scene) -> Self {
        let mut table = Self::default();
        if scene.lights().len() > MAX_LIGHTS {
            return table;
        }
        for light in scene.lights().iter() {
            let row = table.emission.len() as u32;
            let added = table.add(scene, light.row(), light.primitive());
            table.row.push(if added.is_some() { row } else { Self::NONE });
        }
        table
    }

    fn add(&mut self, scene: &Scene, light: &Light, primitive: u32) -> Option<()> {
        let Light::Area(area) = light else { return None };
        let emission = &scene.emissions()[area.emission.0 as usize];
        let is_plain = emission.image.is_none() && !area.invisible && area.alpha.is_none();
        if !is_plain || !area.instance.is_top() {
            return None;
        }
        let shape = scene.world().geometry(area.geometry).shape(primitive)?.flat_shape()?;
        let scale = area.scales.as_ref().map_or(emission.radiance.scale, |scales| scales[primitive as usize]);
        for v in [shape.corner, shape.sides[0], shape.sides[1], shape.n] {
            self.numbers.extend(v.to_array());
        }
        self.numbers.extend([scale, if shape.is_triangle { 1.0 } else { 0.0 }, 0.0, 0.0]);
        self.emission.push(area.emission.0);
        Some(())
    }

    /// Whether a light is in the table.
    #[inline]
    pub fn contains(&self, LightId(light): LightId) -> bool {
        self.row.get(light as usize).is_some_and(|&row| row != Self::NONE)
    }

    /// The light of a hit on a geometry whose first light is given, if it is in the table.
    #[inline]
    pub fn light_of(&self, first: u32, hits: &HitColumns, hit_index: u32) -> Option<LightId> {
        let light = LightId(first + hits.primitive[hit_index as usize]);
        (self.contains(light) && hits.is_in_top_group(hit_index as usize)).then_some(light)
    }

    /// The rows of these lights, and the lanes of `mask` whose lights are in the table; the rows
    /// of others are 0.
    #[inline(always)]
    pub fn rows<R: Real>(&self, lights: R::Int, mask: R::Mask) -> (R::Int, R::Mask) {
        if self.emission.is_empty() {
            return (R::Int::splat(0), R::Mask::splat(false));
        }
        let rows = R::Int::gather(&self.row, R::Int::select(mask, lights, R::Int::splat(0)));
        let is_row = mask & !rows.eq(R::Int::splat(Self::NONE));
        (R::Int::select(is_row, rows, R::Int::splat(0)), is_row)
    }

    /// The lights of these rows.
    #[inline(always)]
    pub fn emitters<R: Real>(&self, rows: R::Int) -> Emitters<R> {
        let mut numbers = [R::zero(); NUMBERS];
        let row = rows.to_array()[0];
        if rows.eq(R::Int::splat(row)).all() {
            let one = &self.numbers[row as usize * NUMBERS..];
            for (lanes, &number) in numbers.iter_mut().zip(one) {
                *lanes = R::splat(number);
            }
        } else {
            let first = rows.wrapping_mul(R::Int::splat(NUMBERS as u32));
            for (four, lanes) in numbers.as_chunks_mut::<4>().0.iter_mut().enumerate() {
                *lanes = R::gather_rows(&self.numbers, first.wrapping_add(R::Int::splat(4 * four as u32)));
            }
        }
        let vector = |first: usize| Vec3::new(numbers[first], numbers[first + 1], numbers[first + 2]);
        let shape = FlatShape {
            corner: vector(0),
            sides: [vector(3), vector(6)],
            n: vector(9),
            is_triangle: numbers[13].gt(R::zero()),
        };
        Emitters { emission: R::Int::gather(&self.emission, rows), shape, scale: numbers[12] }
    }

    /// The radiance of lights at points of normal `n` along `w`, in the lanes of a mask; zero
    /// elsewhere.
    #[inline(always)]
    pub fn radiance<R: Real>(
        &self,
        scene: &Scene,
        emitters: &Emitters<R>,
        n: Normal3<R>,
        w: Vector3<R>,
        lambda: &SampledWavelengths<R>,
        mask: R::Mask,
    ) -> SampledSpectrum<R> {
        let is_outside = n.dot(w).ge(R::zero());
        let mut radiance = SampledSpectrum::splat(R::zero());
        let mut left = mask;
        while left.any() {
            let id = emitters.emission.to_array()[left.bits().trailing_zeros() as usize % R::LANES];
            let same = left & emitters.emission.eq(R::Int::splat(id));
            left = left & !same;
            let emission = &scene.emissions()[id as usize];
            let emits = if emission.two_sided { same } else { same & is_outside };
            let l = emission.radiance.spectrum.sample(lambda);
            radiance = SampledSpectrum::select(emits, l, radiance);
        }
        radiance * emitters.scale
    }
}
