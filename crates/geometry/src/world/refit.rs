//! A world whose geometries move.

use super::{Geometry, GeometryId, World};
use rayon::prelude::*;
use std::fmt;

/// Why a geometry cannot take the place of another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefitError {
    /// The world has no such geometry.
    Unknown(GeometryId),
    /// One is a mesh and the other is not, they differ in the number of primitives or in the
    /// vertices of triangles, or a primitive has an end where its successor has none.
    Different(GeometryId),
}

impl fmt::Display for RefitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(id) => write!(f, "there is no geometry {}", id.0),
            Self::Different(id) => write!(f, "geometry {} has other primitives", id.0),
        }
    }
}

impl std::error::Error for RefitError {}

impl World {
    /// Puts geometries in the place of others that have the same primitives elsewhere, as
    /// [`TriangleMesh::moved`](crate::TriangleMesh::moved) makes them. All trees keep their form,
    /// so that this takes a fraction of the time of building, and rays find what they would in a
    /// new world; but they find it the more slowly the further neighbours have moved apart.
    /// Primitives that were not finite when the world was built stay left out; those that are not
    /// finite now are left out until they are.
    ///
    /// Where there is an error, nothing is changed.
    pub fn refit(
        &mut self,
        moved: impl IntoIterator<Item = (GeometryId, Geometry)>,
    ) -> Result<(), RefitError> {
        let moved: Vec<_> = moved.into_iter().collect();
        for (id, new) in &moved {
            let old = self.geometries.get(id.0 as usize).ok_or(RefitError::Unknown(*id))?;
            if !same_primitives(old, new) {
                return Err(RefitError::Different(*id));
            }
        }
        let mut is_stale = vec![false; self.groups.len()];
        for (id, new) in moved {
            is_stale[self.group_of[id.0 as usize].0 as usize] = true;
            self.geometries[id.0 as usize] = new;
        }
        let Self { groups, geometries, instances, .. } = self;
        let stale = groups.par_iter_mut().zip(&is_stale).filter(|(_, is_stale)| **is_stale);
        stale.for_each(|(group, _)| group.refit_meshes_and_spheres(geometries));
        let Some((top, placed)) = groups.split_first_mut() else { return Ok(()) };
        // A group holds only such as come before it, the top group all.
        for group in 0..placed.len() {
            let (inner, rest) = placed.split_at_mut(group);
            if is_stale[group + 1] || rest[0].has_instances() {
                rest[0].refit_items(geometries, instances, inner);
            }
        }
        top.refit_items(geometries, instances, placed);
        Ok(())
    }
}

fn same_primitives(old: &Geometry, new: &Geometry) -> bool {
    match (old, new) {
        (Geometry::Mesh(old), Geometry::Mesh(new)) => old.has_triangles_of(new),
        (Geometry::Shapes(old), Geometry::Shapes(new)) => {
            let ends =
                |(old, new): (&crate::Shape, &crate::Shape)| old.bounds().is_some() == new.bounds().is_some();
            old.len() == new.len() && old.iter().zip(new.iter()).all(ends)
        }
        (Geometry::Spheres(old), Geometry::Spheres(new)) => old.len() == new.len(),
        (Geometry::Curves(old), Geometry::Curves(new)) => old.len() == new.len(),
        _ => false,
    }
}
