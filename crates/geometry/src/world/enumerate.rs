//! Enumerating the geometries of a world with their instances, and evaluating surfaces by their
//! parameters instead of by rays.

use super::World;
use super::geometry::{Geometry, GeometryId};
use super::instance::{GroupId, InstanceId, InstancePath};
use crate::surface::SurfacePoint;
use math::{Ray, Vec2, Vec3};

impl World {
    /// Every geometry once for each path of instances that leads to it.
    pub fn placed_geometries(&self) -> Vec<(GeometryId, InstancePath)> {
        let mut found = Vec::new();
        self.collect_placed(GroupId::TOP, InstancePath::TOP, &mut found);
        found
    }

    fn collect_placed(
        &self,
        group: GroupId,
        path: InstancePath,
        found: &mut Vec<(GeometryId, InstancePath)>,
    ) {
        let members = (0..).map(GeometryId).zip(&self.tables.group_of).filter(|(_, of)| **of == group);
        found.extend(members.map(|(id, _)| (id, path)));
        for id in self.tables.groups[group.0 as usize].instances() {
            let inner = GroupId(self.tables.instances[id.0 as usize].group);
            self.collect_placed(inner, path.into(id), found);
        }
    }

    /// The surface of a primitive at parameters as a [`Hit`](super::Hit) has them (those of the
    /// surface on a sphere of a set), seen along its normal; `None` for primitives without such
    /// parameters: planes, implicit surfaces, solids and curves.
    pub fn surface_at(
        &self,
        geometry: GeometryId,
        primitive: u32,
        instance: InstancePath,
        uv: Vec2,
        time: f32,
    ) -> Option<SurfacePoint> {
        let inner = match self.geometry(geometry) {
            Geometry::Shapes(shapes) => shapes[primitive as usize].surface_at(uv, time)?,
            geometry => geometry.shape(primitive)?.surface_at(uv, time)?,
        };
        let any_ray = Ray::new(Vec3::ZERO, Vec3::Z, time);
        let place = |surface: SurfacePoint, id: &InstanceId| {
            let instance = &self.tables.instances[id.0 as usize];
            instance.with_placement(time, |placement| surface.placed(placement, &any_ray))
        };
        let surface = instance.ids().iter().rev().fold(inner, place);
        Some(SurfacePoint { wo: surface.n, ..surface })
    }
}
