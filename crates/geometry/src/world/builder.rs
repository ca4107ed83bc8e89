//! Collects what a world is made of, and builds its trees.

use super::group::Group;
use super::{Geometry, GeometryId, GroupId, Instance, InstanceId, Placed, World};
use crate::bvh::BuildQuality;
use crate::simd::InstructionSet;
use rayon::prelude::*;

/// A world in the making.
#[derive(Clone, Debug)]
pub struct WorldBuilder {
    groups: Vec<Vec<GeometryId>>,
    geometries: Vec<Geometry>,
    instances: Vec<Instance>,
    quality: BuildQuality,
}

impl Default for WorldBuilder {
    /// A world with the top group alone.
    fn default() -> Self {
        Self {
            groups: vec![Vec::new()],
            geometries: Vec::new(),
            instances: Vec::new(),
            quality: BuildQuality::default(),
        }
    }
}

impl WorldBuilder {
    /// Adds an empty group, to be placed by instances.
    pub fn add_group(&mut self) -> GroupId {
        self.groups.push(Vec::new());
        GroupId(self.groups.len() as u32 - 1)
    }

    /// Adds a geometry to a group.
    pub fn add_geometry(&mut self, group: GroupId, geometry: impl Into<Geometry>) -> GeometryId {
        let id = GeometryId(self.geometries.len() as u32);
        self.geometries.push(geometry.into());
        self.groups[group.0 as usize].push(id);
        id
    }

    /// Places a group, other than the top group, in the top group.
    pub fn add_instance(&mut self, instance: Instance) -> InstanceId {
        assert!(instance.group != GroupId::TOP, "the top group is not placed in itself");
        self.instances.push(instance);
        InstanceId(self.instances.len() as u32 - 1)
    }

    /// How much time the trees are worth.
    pub fn quality(mut self, quality: BuildQuality) -> Self {
        self.quality = quality;
        self
    }

    /// Builds all trees, in parallel. The result does not depend on the number of threads.
    pub fn build(self) -> World {
        let Self { groups, geometries, instances, quality } = self;
        let instances: Vec<Placed> = instances.into_iter().map(Placed::new).collect();
        let placed_groups: Vec<Group> =
            groups[1..].par_iter().map(|members| Group::build(members, &geometries, &[], quality)).collect();
        let places: Vec<_> = instances
            .iter()
            .zip(0..)
            .map(|(placed, id)| (InstanceId(id), placed, &placed_groups[placed.group as usize - 1]))
            .collect();
        let top = Group::build(&groups[0], &geometries, &places, quality);
        let mut group_of = vec![GroupId::TOP; geometries.len()];
        for (group, members) in (0..).zip(&groups) {
            members.iter().for_each(|id| group_of[id.0 as usize] = GroupId(group));
        }
        let groups = std::iter::once(top).chain(placed_groups).collect();
        let instruction_set = InstructionSet::detect();
        World { groups, geometries, group_of, instances, instruction_set }
    }
}
