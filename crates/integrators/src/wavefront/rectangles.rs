//! The lights that are sampled in lanes: rectangles of one colour.

use geometry::Rectangles;
use lanes::{Int, Mask, Real};
use math::{Vec3, Vector3};
use scene::Scene;
use scene::light::{AreaEmission, EmissionId, Light, LightId};

/// Scenes with more lights sample all of them one by one, so that the table stays small.
const MAX_LIGHTS: usize = 1 << 16;

/// Numbers of a row: corner, sides, normal, scale of the emission.
const NUMBERS: usize = 13;

/// The rectangles among the lights of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct RectangleLights {
    /// The row of each light; [`NONE`](Self::NONE) for those not in the table.
    row: Vec<u32>,
    numbers: Vec<f32>,
    /// The emission of each row.
    emission: Vec<u32>,
}

impl RectangleLights {
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
            let added = table.add(scene, light.id(), light.row());
            table.row.push(if added.is_some() { row } else { Self::NONE });
        }
        table
    }

    fn add(&mut self, scene: &Scene, id: LightId, light: &Light) -> Option<()> {
        let Light::Area(area) = light else { return None };
        let emission = &scene.emissions()[area.emission.0 as usize];
        let is_plain = emission.image.is_none() && !area.invisible && area.alpha.is_none();
        if !is_plain || !area.instance.is_top() {
            return None;
        }
        let primitive = scene.light(id).primitive();
        let patch = scene.world().rectangle(area.geometry, primitive)?;
        let n = patch.sides[0].cross(patch.sides[1]).normalize() * if patch.flips { -1.0 } else { 1.0 };
        let scale = area.scales.as_ref().map_or(emission.radiance.scale, |scales| scales[primitive as usize]);
        for v in [patch.corner, patch.sides[0], patch.sides[1], n] {
            self.numbers.extend(v.to_array());
        }
        self.numbers.push(scale);
        self.emission.push(area.emission.0);
        Some(())
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

    /// The rectangles of these rows, and the scales of their emission.
    #[inline(always)]
    pub fn get<R: Real>(&self, rows: R::Int) -> (Rectangles<R>, R) {
        let corner = self.vector::<R>(rows, 0);
        let sides = [self.vector::<R>(rows, 3), self.vector::<R>(rows, 6)];
        let rectangles = Rectangles { corner, sides, n: self.vector::<R>(rows, 9) };
        (rectangles, self.number::<R>(rows, NUMBERS as u32 - 1))
    }

    #[inline(always)]
    fn number<R: Real>(&self, rows: R::Int, column: u32) -> R {
        let first = rows.wrapping_mul(R::Int::splat(NUMBERS as u32));
        R::gather(&self.numbers, first.wrapping_add(R::Int::splat(column)))
    }

    #[inline(always)]
    fn vector<R: Real>(&self, rows: R::Int, column: u32) -> Vector3<R> {
        Vec3::new(
            self.number::<R>(rows, column),
            self.number::<R>(rows, column + 1),
            self.number::<R>(rows, column + 2),
        )
    }

    /// The emission of each of these rows where all lanes of a mask have the same.
    #[inline(always)]
    pub fn emission<'a, R: Real>(
        &self,
        scene: &'a Scene,
        rows: R::Int,
        mask: R::Mask,
    ) -> Option<&'a AreaEmission> {
        let ids = R::Int::gather(&self.emission, rows);
        let first = ids.to_array()[mask.bits().trailing_zeros() as usize % R::LANES];
        let same = !ids.eq(R::Int::splat(first)) & mask;
        (!same.any()).then(|| &scene.emissions()[EmissionId(first).0 as usize])
    }
}
