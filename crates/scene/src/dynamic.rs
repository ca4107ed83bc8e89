//! What moves from picture to picture: spheres of sets, vertices of meshes, and instances.

use crate::cache::SceneCache;
use crate::light::Light;
use crate::scene::Scene;
use geometry::{BuildQuality, Geometry, GeometryId, InstanceId, RefitError};
use math::{Point3, Transform};
use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

/// Why something cannot be moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MoveError {
    /// The geometry is neither a set of spheres nor a mesh.
    NoPoints(GeometryId),
    /// The mesh has normals or tangents of its own, which would not follow its vertices.
    Normals(GeometryId),
    /// The geometry shines: the lights of a scene do not move.
    Lights(GeometryId),
    /// There are not as many points as spheres or vertices, or one is not finite.
    Points(GeometryId),
    /// There is no such instance at rest that is not within another one.
    Instance(InstanceId),
    /// A shape in the instance shines.
    LightsWithin(InstanceId),
    /// The transform has no inverse.
    Transform(InstanceId),
}

impl fmt::Display for MoveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPoints(id) => write!(f, "geometry {} is neither a set of spheres nor a mesh", id.0),
            Self::Normals(id) => write!(f, "mesh {} has normals of its own, and cannot be moved", id.0),
            Self::Lights(id) => write!(f, "geometry {} shines, and cannot be moved", id.0),
            Self::Points(id) => write!(f, "the points for geometry {} do not fit", id.0),
            Self::Instance(id) => write!(f, "there is no instance {} that may be moved", id.0),
            Self::LightsWithin(id) => write!(f, "shapes in instance {} shine, and cannot be moved", id.0),
            Self::Transform(id) => write!(f, "the transform for instance {} does not fit", id.0),
        }
    }
}

impl std::error::Error for MoveError {}

impl From<RefitError> for MoveError {
    fn from(error: RefitError) -> Self {
        match error {
            RefitError::Unknown(id) | RefitError::Different(id) => Self::Points(id),
            RefitError::Instance(id) => Self::Instance(id),
            RefitError::Transform(id) => Self::Transform(id),
        }
    }
}

impl Scene {
    /// Moves the spheres of some sets and the vertices of some meshes, each given by its geometry
    /// and all its centres or vertices in render space. Trees are refitted, and built anew where
    /// that pays, so that this takes a fraction of the time of compiling. The bounding
    /// [sphere](Self::sphere) stays. On an error, nothing is changed.
    pub fn move_points(
        &mut self,
        moved: impl IntoIterator<Item = (GeometryId, Arc<[Point3]>)>,
    ) -> Result<(), MoveError> {
        let moved: Result<Vec<_>, MoveError> = moved
            .into_iter()
            .map(|(id, points)| {
                self.may_move_points(id)?;
                let moved = match self.world.geometry(id) {
                    Geometry::Spheres(set) => set.moved(points).map(Geometry::from),
                    Geometry::Mesh(mesh) if points.iter().all(|point| point.is_finite()) => {
                        mesh.moved(points, None).ok().map(Geometry::from)
                    }
                    Geometry::Mesh(_) | Geometry::Shapes(_) | Geometry::Curves(_) => None,
                };
                Ok((id, moved.ok_or(MoveError::Points(id))?))
            })
            .collect();
        self.world.refit_or_rebuild(moved?, BuildQuality::Balanced)?;
        self.cache = SceneCache::default();
        Ok(())
    }

    /// Gives instances that are not within others, and at rest, other transforms from the space of
    /// their objects to render space, as [`World::render_from_instance`](geometry::World) has them;
    /// else as [`move_points`](Self::move_points).
    pub fn move_instances(
        &mut self,
        moved: impl IntoIterator<Item = (InstanceId, Transform)>,
    ) -> Result<(), MoveError> {
        let moved: Vec<_> = moved.into_iter().collect();
        self.may_move_instances(moved.iter().map(|(id, _)| *id))?;
        self.world.place_instances(moved)?;
        self.cache = SceneCache::default();
        Ok(())
    }

    /// Whether a geometry has points that may be moved.
    pub fn may_move_points(&self, id: GeometryId) -> Result<(), MoveError> {
        let entry = self.entries.get(id.0 as usize).ok_or(MoveError::NoPoints(id))?;
        match self.world.geometry(id) {
            _ if entry.first_light.is_some() => Err(MoveError::Lights(id)),
            Geometry::Mesh(mesh) if mesh.is_smooth() => Err(MoveError::Normals(id)),
            Geometry::Mesh(_) | Geometry::Spheres(_) => Ok(()),
            Geometry::Shapes(_) | Geometry::Curves(_) => Err(MoveError::NoPoints(id)),
        }
    }

    /// Whether no shape in any of some instances shines.
    pub fn may_move_instances(&self, ids: impl IntoIterator<Item = InstanceId>) -> Result<(), MoveError> {
        let instance = |light: &Light| {
            let Light::Area(area) = light else { return None };
            area.instance.ids().first().copied()
        };
        let shining: BTreeSet<InstanceId> =
            self.lights().rows().filter_map(|(_, light)| instance(light)).collect();
        let found = ids.into_iter().find(|id| shining.contains(id));
        found.map_or(Ok(()), |id| Err(MoveError::LightsWithin(id)))
    }
}
