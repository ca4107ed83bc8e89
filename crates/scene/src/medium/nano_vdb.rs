//! A medium whose density is given on sparse voxels, as NanoVDB files store it.
//!
//! Voxel values lie at integer points of index space and are interpolated linearly; the medium
//! fills the box of the active voxels. It emits as a blackbody where the file has temperatures.

use super::{Coefficients, MajorantGrid, Majorants, MediumModel, MediumProperties, Placement, Temperature};
use description::VoxelsDesc;
use math::{Bounds3, Point3, Ray, Transform, Vec3, lerp};
use spectrum::SampledWavelengths;

/// A medium of which the density is given on sparse voxels.
#[derive(Clone, Debug)]
pub struct NanoVdbMedium {
    /// Position of the box of active voxels.
    pub placement: Placement,
    /// Absorption and scattering at density 1.
    pub coefficients: Coefficients,
    /// Densities, at least 0.
    pub density: Voxels,
    /// Bounds of the densities.
    pub majorants: MajorantGrid,
    /// Temperatures with their conversion and a factor on the emission.
    pub emission: Option<(Voxels, Temperature, f32)>,
}

/// Sparse voxels and their position.
#[derive(Clone, Debug)]
pub struct Voxels {
    /// The values.
    pub values: VoxelsDesc,
    /// From render space to index coordinates.
    pub index_from_render: Transform,
}

impl Voxels {
    /// The interpolated value at a point in render space.
    fn at(&self, p: Point3) -> f32 {
        let p = self.index_from_render.affine_point(p);
        let low = Vec3::from_array(p.to_array().map(f32::floor));
        let f = p - low;
        let [x, y, z] = low.to_array().map(|low| low as i32);
        let value = |dx, dy, dz| self.values.value([x + dx, y + dy, z + dz]);
        let line = |dy, dz| lerp(f.x, value(0, dy, dz), value(1, dy, dz));
        let plane = |dz| lerp(f.y, line(0, dz), line(1, dz));
        lerp(f.z, plane(0), plane(1))
    }
}

/// Voxels along a side of a brick.
const BRICK: usize = 8;

/// The largest value of each brick, which bounds densities without a look at every voxel.
pub(crate) struct LargestVoxels<'a> {
    voxels: &'a VoxelsDesc,
    of_bricks: Vec<f32>,
}

impl<'a> LargestVoxels<'a> {
    pub fn of(voxels: &'a VoxelsDesc) -> Self {
        let bricks = voxels.values.chunks(BRICK.pow(3));
        let largest = |brick: &[f32]| brick.iter().fold(0f32, |largest, &value| largest.max(value));
        Self { voxels, of_bricks: bricks.map(largest).collect() }
    }

    /// A bound of the values that interpolation within a box of index space uses.
    pub fn within(&self, bounds: Bounds3) -> f32 {
        let VoxelsDesc { origin, bricks, table, .. } = self.voxels;
        // Bricks beside the grid hold the background.
        let mut largest = self.of_bricks[0];
        let range = |axis: usize| {
            // One more voxel on each side, because points are rounded.
            let brick = |index: f32| (f64::from(index) - f64::from(origin[axis])).div_euclid(BRICK as f64);
            let count = f64::from(bricks[axis]);
            let first = brick(bounds.min[axis].floor() - 1.0).clamp(0.0, count) as usize;
            first..(brick(bounds.max[axis].floor() + 2.0) + 1.0).clamp(0.0, count) as usize
        };
        for z in range(2) {
            for y in range(1) {
                let row = (z * bricks[1] as usize + y) * bricks[0] as usize;
                for x in range(0) {
                    largest = largest.max(self.of_bricks[table[row + x] as usize]);
                }
            }
        }
        largest
    }
}

impl MediumModel for NanoVdbMedium {
    fn is_emissive(&self) -> bool {
        self.emission.is_some()
    }

    fn bounds(&self) -> Option<Bounds3> {
        Some(self.placement.bounds())
    }

    fn at(&self, p: Point3, lambda: &SampledWavelengths) -> MediumProperties {
        if self.placement.point(p).is_none() {
            return MediumProperties::default();
        }
        let mut properties = self.coefficients.at(self.density.at(p), lambda);
        if let Some((values, temperature, scale)) = &self.emission {
            properties.le = temperature.le(values.at(p), lambda) * *scale;
        }
        properties
    }

    fn majorants<'a>(&'a self, ray: &Ray, t_max: f32, lambda: &SampledWavelengths) -> Majorants<'a> {
        self.majorants.along(&self.placement, ray, t_max, self.coefficients.at(1.0, lambda).sigma_t())
    }
}
