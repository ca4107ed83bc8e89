//! Refitting a world whose geometries move.

use super::World;
use super::facets::Facets;
use super::geometry::{Geometry, GeometryId};
use super::instance::{GroupId, Instance, InstanceId, PreparedInstance};
use super::spheres::Spheres;
use super::tables::Tables;
use crate::bvh::BuildQuality;
use math::Transform;
use rayon::prelude::*;
use std::fmt;

/// Why a geometry cannot replace another one, or an instance cannot be placed elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefitError {
    /// The world has no such geometry.
    Unknown(GeometryId),
    /// They differ in kind, in the number of primitives, in the vertex indices of triangles, or in
    /// whether a primitive is bounded.
    Different(GeometryId),
    /// The top group has no such instance at rest.
    Instance(InstanceId),
    /// The transform for an instance has no inverse.
    Transform(InstanceId),
}

impl fmt::Display for RefitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(id) => write!(f, "there is no geometry {}", id.0),
            Self::Different(id) => write!(f, "geometry {} has other primitives", id.0),
            Self::Instance(id) => write!(f, "the top group has no instance {} at rest", id.0),
            Self::Transform(id) => write!(f, "the transform for instance {} has no inverse", id.0),
        }
    }
}

impl std::error::Error for RefitError {}

impl World {
    /// Replaces geometries by others with the same primitives elsewhere, as
    /// [`TriangleMesh::moved`](crate::TriangleMesh::moved) makes them. The trees keep their
    /// topology, so that this takes a fraction of the build time; rays find the same hits as in a
    /// new world, but more slowly the further neighbours have moved apart. Primitives that were not
    /// finite when the world was built are never hit; those that are not finite now cannot be hit
    /// until they are.
    ///
    /// On an error, nothing is changed.
    pub fn refit(
        &mut self,
        moved: impl IntoIterator<Item = (GeometryId, Geometry)>,
    ) -> Result<(), RefitError> {
        let moved: Vec<_> = moved.into_iter().collect();
        for (id, new) in &moved {
            let old = self.tables.geometries.get(id.0 as usize).ok_or(RefitError::Unknown(*id))?;
            if !same_primitives(old, new) {
                return Err(RefitError::Different(*id));
            }
        }
        let Tables { groups, geometries, group_of, instances, facets, .. } = &mut self.tables;
        let mut is_stale = vec![false; groups.len()];
        for (id, new) in moved {
            is_stale[group_of[id.0 as usize].0 as usize] = true;
            geometries[id.0 as usize] = new;
        }
        let stale = groups.par_iter_mut().zip(&is_stale).filter(|(_, is_stale)| **is_stale);
        stale.for_each(|(group, _)| group.refit_meshes_and_spheres(geometries));
        let Some((top, inner_groups)) = groups.split_first_mut() else { return Ok(()) };
        // Groups are placed in later ones, and all in the top group.
        for group in 0..inner_groups.len() {
            let (inner, rest) = inner_groups.split_at_mut(group);
            if is_stale[group + 1] || rest[0].has_instances() {
                rest[0].refit_items(geometries, instances, inner);
            }
        }
        top.refit_items(geometries, instances, inner_groups);
        *facets = facets.take().and_then(|_| {
            let of_top = (0..).map(GeometryId).zip(&*group_of).filter(|(_, group)| **group == GroupId::TOP);
            Facets::new(&of_top.map(|(id, _)| id).collect::<Vec<_>>(), geometries)
        });
        Ok(())
    }

    /// Gives instances of the top group, which are at rest, other transforms. The tree over them
    /// keeps its topology, as by [`refit`](Self::refit).
    ///
    /// On an error, nothing is changed.
    pub fn place_instances(
        &mut self,
        moved: impl IntoIterator<Item = (InstanceId, Transform)>,
    ) -> Result<(), RefitError> {
        let moved: Vec<_> = moved.into_iter().collect();
        let placed = self.tables.top().instances();
        let Tables { groups, geometries, instances, .. } = &mut self.tables;
        for (id, transform) in &moved {
            if !placed.contains(id) || instances[id.0 as usize].motion.is_moving() {
                return Err(RefitError::Instance(*id));
            }
            if !(transform.matrix().is_finite() && transform.inverse().matrix().is_finite()) {
                return Err(RefitError::Transform(*id));
            }
        }
        for (id, transform) in moved {
            let instance = &mut instances[id.0 as usize];
            let group = GroupId(instance.group);
            *instance = PreparedInstance::new(Instance { group, render_from_instance: transform.into() });
        }
        if let Some((top, inner_groups)) = groups.split_first_mut() {
            top.refit_items(geometries, instances, inner_groups);
        }
        Ok(())
    }
}

/// Trees of spheres are built anew where the boxes of a refitted one have grown by this factor.
const GROWTH: f64 = 1.2;

impl World {
    /// [`World::refit`], after which trees of spheres are built anew whose boxes have become so
    /// large that rays would visit many of them in vain. Says whether one was.
    pub fn refit_or_rebuild(
        &mut self,
        moved: impl IntoIterator<Item = (GeometryId, Geometry)>,
        quality: BuildQuality,
    ) -> Result<bool, RefitError> {
        self.refit(moved)?;
        let Tables { groups, geometries, group_of, .. } = &mut self.tables;
        let mut has_rebuilt = false;
        for (id, group) in (0..).map(GroupId).zip(groups.iter_mut()) {
            if group.spheres.growth() <= GROWTH {
                continue;
            }
            let members = (0..).map(GeometryId).zip(&*group_of).filter(|(_, of)| **of == id);
            let members: Vec<GeometryId> = members.map(|(id, _)| id).collect();
            group.spheres = Spheres::build(&members, geometries, quality);
            has_rebuilt = true;
        }
        Ok(has_rebuilt)
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
