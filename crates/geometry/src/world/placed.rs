//! The primitives of a world without rays: what there is, how often, and its points by their
//! parameters.

use super::{Geometry, GeometryId, GroupId, InstanceId, InstancePath, World};
use crate::surface::SurfacePoint;
use math::{Ray, Vec2, Vec3};

impl World {
    /// Every geometry as often as it can be hit, with the instances that lead to it.
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
        let members = (0..).map(GeometryId).zip(&self.group_of).filter(|(_, of)| **of == group);
        found.extend(members.map(|(id, _)| (id, path)));
        for id in self.groups[group.0 as usize].instances() {
            self.collect_placed(GroupId(self.instances[id.0 as usize].group), path.into(id), found);
        }
    }

    /// What is known of the surface of a primitive where a [`Hit`](super::Hit) has these parameters
    /// (on a sphere of a set: those of the surface), seen from along its normal; `None` where
    /// primitives have no such parameters: planes, formulas, solids and curves.
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
        let anywhere = Ray::new(Vec3::ZERO, Vec3::Z, time);
        let place = |surface: SurfacePoint, id: &InstanceId| {
            let placed = &self.instances[id.0 as usize];
            placed.with_placement(time, |placement| surface.placed(placement, &anywhere))
        };
        let surface = instance.ids().iter().rev().fold(inner, place);
        Some(SurfacePoint { wo: surface.n, ..surface })
    }
}
