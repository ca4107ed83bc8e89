//! Where the models of groups are: a list of all instances, nested ones, too.

use std::collections::BTreeSet;

use geometry::{GeometryId, GroupId, PlainItem, World};
use math::{DMat4, Vec3};

/// A group that is placed.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// The group.
    pub group: u32,
    /// From its space to render space.
    pub render_from_group: DMat4,
    /// The inverse.
    pub group_from_render: DMat4,
}

impl Placement {
    fn new(group: GroupId, render_from_group: DMat4) -> Self {
        Self { group: group.0, render_from_group, group_from_render: render_from_group.inverse() }
    }

    /// A point of its space in render space.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.render_from_group.transform_point3(p.as_dvec3()).as_vec3().into()
    }

    /// A vector of its space in render space.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.render_from_group.transform_vector3(v.as_dvec3()).as_vec3().into()
    }

    /// The most that it stretches lengths.
    pub fn scale(&self) -> f32 {
        let m = self.render_from_group;
        [m.x_axis, m.y_axis, m.z_axis].iter().map(|v| v.truncate().length()).fold(0.0, f64::max) as f32
    }

    /// The rows of its matrix.
    pub fn rows(&self) -> [[f32; 4]; 3] {
        [0, 1, 2].map(|i| self.render_from_group.row(i).as_vec4().to_array())
    }
}

/// All placements at a shutter time; the first is that of the top group.
pub fn placements(world: &World, time: f32) -> Vec<Placement> {
    let mut found = vec![Placement::new(GroupId::TOP, DMat4::IDENTITY)];
    let mut next = 0;
    while let Some(outer) = found.get(next).copied() {
        let (_, items, unbounded) = world.item_tree(GroupId(outer.group));
        for item in items.iter().chain(&unbounded) {
            let PlainItem::Instance(id) = *item else { continue };
            let inner = world.render_from_instance(id).at(time).matrix().as_dmat4();
            found.push(Placement::new(world.group_of_instance(id), outer.render_from_group * inner));
        }
        next += 1;
    }
    found
}

/// The geometries of each group that is placed.
pub fn geometries_of_groups(world: &World) -> Vec<BTreeSet<GeometryId>> {
    let mut groups = vec![BTreeSet::new(); world.groups()];
    for (geometry, path) in world.placed_geometries() {
        let group = path.ids().last().map_or(GroupId::TOP, |id| world.group_of_instance(*id));
        groups[group.0 as usize].insert(geometry);
    }
    groups
}
