//! Collects what a world is made of, and builds its trees.

use super::group::Group;
use super::{Geometry, GeometryId, GroupId, Instance, InstanceId, InstancePath, Placed, World};
use crate::bvh::BuildQuality;
use lanes::InstructionSet;
use rayon::prelude::*;

/// A world in the making.
#[derive(Clone, Debug)]
pub struct WorldBuilder {
    groups: Vec<Members>,
    geometries: Vec<Geometry>,
    instances: Vec<Instance>,
    quality: BuildQuality,
    extents: bool,
}

/// What stands in a group.
#[derive(Clone, Debug, Default)]
struct Members {
    geometries: Vec<GeometryId>,
    instances: Vec<InstanceId>,
}

impl Default for WorldBuilder {
    /// A world with the top group alone.
    fn default() -> Self {
        Self {
            groups: vec![Members::default()],
            geometries: Vec::new(),
            instances: Vec::new(),
            quality: BuildQuality::default(),
            extents: true,
        }
    }
}

impl WorldBuilder {
    /// Adds an empty group, to be placed by instances.
    pub fn add_group(&mut self) -> GroupId {
        self.groups.push(Members::default());
        GroupId(self.groups.len() as u32 - 1)
    }

    /// Adds a geometry to a group.
    pub fn add_geometry(&mut self, group: GroupId, geometry: impl Into<Geometry>) -> GeometryId {
        let id = GeometryId(self.geometries.len() as u32);
        self.geometries.push(geometry.into());
        self.groups[group.0 as usize].geometries.push(id);
        id
    }

    /// Places a group, other than the top group, in the top group or in one that was added after
    /// it.
    ///
    /// # Panics
    /// When the group was added after the other one.
    pub fn add_instance(&mut self, group: GroupId, instance: Instance) -> InstanceId {
        let placed = instance.group;
        assert!(placed != GroupId::TOP, "the top group is not placed in any");
        assert!(group == GroupId::TOP || placed < group, "a group is placed in later ones only");
        let id = InstanceId(self.instances.len() as u32);
        self.instances.push(instance);
        self.groups[group.0 as usize].instances.push(id);
        id
    }

    /// How much time the trees are worth.
    pub fn quality(mut self, quality: BuildQuality) -> Self {
        self.quality = quality;
        self
    }

    /// Whether rays are tested against extents (bounding volumes) before what these hold, as by
    /// default, or against every primitive, which finds the same hits.
    pub fn extents(mut self, used: bool) -> Self {
        self.extents = used;
        self
    }

    /// Builds all trees, in parallel. The result does not depend on the number of threads.
    ///
    /// # Panics
    /// When instances lie in each other more than [`InstancePath::MOST`] deep.
    pub fn build(self) -> World {
        let Self { groups: members, geometries, instances, quality, extents } = self;
        let instances: Vec<Placed> = instances.into_iter().map(Placed::new).collect();
        let mut groups: Vec<Option<Group>> = vec![None; members.len()];
        let levels = levels(&members, &instances);
        // What is placed has fewer levels of instances than what it is placed in, and comes first.
        for level in 0..=levels[0] {
            let built: Vec<(usize, Group)> = (0..members.len())
                .into_par_iter()
                .filter(|&i| levels[i] == level)
                .map(|i| {
                    let place = |&id: &InstanceId| {
                        let placed = &instances[id.0 as usize];
                        (id, placed, groups[placed.group as usize].as_ref().expect("invariant: built before"))
                    };
                    let places: Vec<_> = members[i].instances.iter().map(place).collect();
                    (i, Group::build(&members[i].geometries, &geometries, &places, quality))
                })
                .collect();
            for (i, group) in built {
                groups[i] = Some(group);
            }
        }
        let mut group_of = vec![GroupId::TOP; geometries.len()];
        for (group, members) in (0..).zip(&members) {
            members.geometries.iter().for_each(|id| group_of[id.0 as usize] = GroupId(group));
        }
        let groups = groups.into_iter().flatten().collect();
        let instruction_set = InstructionSet::detect();
        World { groups, geometries, group_of, instances, instruction_set, extents }
    }
}

/// How many levels of instances each group has; the top group has as many as there are.
fn levels(members: &[Members], instances: &[Placed]) -> Vec<usize> {
    let mut levels = vec![0; members.len()];
    for i in (1..members.len()).chain([0]) {
        let inner = members[i].instances.iter().map(|id| levels[instances[id.0 as usize].group as usize] + 1);
        levels[i] = inner.max().unwrap_or(0);
        assert!(levels[i] <= InstancePath::MOST, "instances lie too deep in each other");
        levels[0] = levels[0].max(levels[i]);
    }
    levels
}
