//! The centres of spheres and the vertices of meshes that may move.

use geometry::{Geometry, GeometryId, World};
use math::Point3;
use rayon::prelude::*;
use scene::MoveError;

use super::error::MovingError;
use super::part::AT_REST;
use crate::device::{Buffer, Device, GpuError};

/// Why a geometry does not move.
type Refusal = fn(GeometryId) -> MovingError;

/// Of geometries that have been asked for.
#[derive(Default)]
pub struct Points {
    sets: Vec<Option<Result<Set, Refusal>>>,
    coordinates: Vec<[f32; 3]>,
}

/// The points of a geometry.
#[derive(Clone, Copy, Debug)]
pub struct Set {
    /// The first of them.
    first: usize,
    len: usize,
    /// How far spheres reach beyond their centres.
    reach: f32,
    /// Whether it is a mesh.
    pub is_mesh: bool,
}

impl Points {
    /// The first point of a geometry; [`AT_REST`] where it does not move.
    pub fn first(&mut self, world: &World, id: GeometryId) -> u32 {
        let index = id.0 as usize;
        self.sets.resize_with(self.sets.len().max(index + 1), || None);
        if self.sets[index].is_none() {
            self.sets[index] = Some(self.add(world.geometry(id)));
        }
        match self.sets[index] {
            Some(Ok(set)) => set.first as u32,
            Some(Err(_)) | None => AT_REST,
        }
    }

    fn add(&mut self, geometry: &Geometry) -> Result<Set, Refusal> {
        let first = self.coordinates.len();
        match geometry {
            Geometry::Spheres(set) => {
                self.coordinates.extend((0..set.len()).map(|sphere| set.center(sphere).to_array()));
                let reach = (0..set.len()).map(|sphere| set.radius(sphere)).fold(0.0, f32::max);
                Ok(Set { first, len: set.len(), reach, is_mesh: false })
            }
            Geometry::Mesh(mesh) if mesh.is_smooth() => Err(|id| MovingError::Move(MoveError::Normals(id))),
            Geometry::Mesh(mesh) => {
                self.coordinates.extend(mesh.positions().iter().map(|point| point.to_array()));
                Ok(Set { first, len: mesh.positions().len(), reach: 0.0, is_mesh: true })
            }
            Geometry::Shapes(_) | Geometry::Curves(_) => Err(no_points),
        }
    }

    /// Takes them to the device.
    pub fn placed(self, device: &Device) -> Result<PlacedPoints, GpuError> {
        let buffer = device.buffer("points of geometries", &self.coordinates)?;
        Ok(PlacedPoints { sets: self.sets, buffer })
    }
}

/// On a device.
pub struct PlacedPoints {
    sets: Vec<Option<Result<Set, Refusal>>>,
    /// Three numbers each.
    pub buffer: Buffer,
}

impl PlacedPoints {
    /// Replaces all points of a geometry. Their set, and the largest coordinate that it reaches.
    pub fn place(
        &self,
        device: &Device,
        id: GeometryId,
        points: &[Point3],
    ) -> Result<(Set, f32), MovingError> {
        let known = self.sets.get(id.0 as usize).copied().flatten();
        let set = known.unwrap_or(Err(no_points)).map_err(|refusal| refusal(id))?;
        let largest = |point: &Point3| point.abs().max_element();
        let is_finite = points.par_iter().all(|point| point.is_finite());
        let reach = points.par_iter().map(largest).reduce(|| 0.0, f32::max) + set.reach;
        if points.len() != set.len || !is_finite || reach > MOST {
            return Err(MovingError::Move(MoveError::Points(id)));
        }
        let numbers: Vec<[f32; 3]> = points.par_iter().map(|point| point.to_array()).collect();
        device.write_at(&self.buffer, 12 * set.first as u64, &numbers)?;
        Ok((set, reach))
    }
}

/// The largest coordinate, so that no size of a box is infinite.
pub const MOST: f32 = f32::MAX / 4.0;

fn no_points(id: GeometryId) -> MovingError {
    MovingError::Move(MoveError::NoPoints(id))
}
